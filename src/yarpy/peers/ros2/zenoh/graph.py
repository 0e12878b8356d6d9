"""The graph of ROS 2 as we see it: which nodes there are, and what they publish, hear and serve.

Rules: one per session and domain, fed by the tokens of all nodes, our own too. What is no token is
ignored, and there is a limit to how many are kept: anybody may declare some. Who watches is called
in a thread of Zenoh, so it does something short and waits for nothing.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.log import logger
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.token import SPACE, Token, parse_token

log = logger("yarpy.ros2")

MOST: Final = 100_000  # tokens
MOST_LETTERS: Final = 32 << 20  # of all of them
SETTLED: Final = 1.0  # seconds for a router to tell of what was there before

Watcher = Callable[[Token, bool], None]  # a token, and whether it has come


class Graph:
    """The tokens of a domain. `watch` and `unwatch` are called by whoever wants to hear of more."""

    def __init__(self, domain: int) -> None:
        self.domain = domain
        self._tokens: dict[str, Token] = {}
        self._named: dict[str, dict[str, Token]] = {}  # those of each topic or service
        self._letters = 0
        self._watchers: tuple[Watcher, ...] = ()
        self._changed = threading.Condition()
        self._full = False

    def begin(self, session: Any) -> Any:
        """Hear of all tokens there are, and will be; what ends that."""
        from zenoh.handlers import Callback

        space = f"{SPACE}/{self.domain}/**"
        hear = Callback(self._heard, indirect=False)
        hearing = session.liveliness().declare_subscriber(space, hear, history=True)
        # What was there before comes by the same way as the end of a question that is asked now;
        # its answers are of no use, since Zenoh loses some.
        settled = threading.Event()
        ignore: Any = Callback(lambda reply: None, settled.set, indirect=False)
        session.liveliness().get(space, ignore, timeout=SETTLED)
        settled.wait(SETTLED)
        return hearing

    def _heard(self, sample: Any) -> None:
        from zenoh import SampleKind

        self.take(str(sample.key_expr), sample.kind == SampleKind.PUT)

    def take(self, text: str, come: bool) -> None:
        """A token has come, or gone."""
        try:
            token = parse_token(text)
        except DecodeError as error:
            log.debug("ignored: %s", error)
            return
        with self._changed:
            if (text in self._tokens) == come:
                return  # some are told twice
            if come and not self._has_room(text):
                return
            self._keep(text, token) if come else self._drop(text)
            self._changed.notify_all()
            watchers = self._watchers
        for watcher in watchers:
            watcher(token, come)

    def _has_room(self, text: str) -> bool:
        room = len(self._tokens) < MOST and self._letters + len(text) <= MOST_LETTERS
        if not room and not self._full:
            self._full = True
            log.warning(
                "more than %s tokens of ROS 2, or %s letters of them: others are not seen",
                MOST,
                MOST_LETTERS,
            )
        return room

    def _keep(self, text: str, token: Token) -> None:
        self._tokens[text] = token
        self._letters += len(text)
        if token.key is not None:
            self._named.setdefault(token.key.name, {})[text] = token

    def _drop(self, text: str) -> None:
        token = self._tokens.pop(text)
        self._letters -= len(text)
        if token.key is not None:
            others = self._named[token.key.name]
            del others[text]
            if not others:
                del self._named[token.key.name]

    @property
    def tokens(self) -> list[Token]:
        """All of now."""
        with self._changed:
            return [*self._tokens.values()]

    def endpoints(self, name: str, *kinds: str) -> list[Token]:
        """Those of a topic or service."""
        with self._changed:
            named = self._named.get(name, {})
            return [token for token in named.values() if token.kind in kinds]

    def nodes(self, node: Node) -> set[tuple[str, int]]:
        """All nodes of a name; there should be one."""
        return {token.whose for token in self.tokens if token.node == node}

    def watch(self, watcher: Watcher) -> list[Token]:
        """Call it for what comes and goes from now on; what there is now."""
        with self._changed:
            self._watchers = (*self._watchers, watcher)
            return [*self._tokens.values()]

    def unwatch(self, watcher: Watcher) -> None:
        """Do not call it any more."""
        with self._changed:
            self._watchers = tuple(item for item in self._watchers if item != watcher)

    def wait_change(self, timeout: float) -> None:
        """Wait until a token comes or goes, or time is over."""
        with self._changed:
            self._changed.wait(timeout)

    def wait(self, name: str, *kinds: str, timeout: float) -> list[Token]:
        """The endpoints of a name, as soon as there are any; [] if time is over."""
        deadline = time.monotonic() + timeout
        while True:
            found = self.endpoints(name, *kinds)
            if found:
                return found
            with self._changed:
                left = deadline - time.monotonic()
                if left <= 0 or not self._changed.wait(left):
                    return self.endpoints(name, *kinds)
