"""The contract of monitors: attached to a connection or a port, one sees every message.

A monitor is any object with some of these methods; those it lacks cost nothing:

    accept(message) -> bool            False: the message is dropped, and counted
    update(message) -> object          what replaces it: a value, a Message, or DROP;
                                       None: the message unchanged
    update_reply(message) -> object    the same for the reply to a call, at the caller's side
    trigger()                          another monitor at the same port has let a message pass
    configure(parameters)              new parameters (a Property) while the connection runs
    parameters() -> dict               their values now
    state() -> dict                    its status, for people: numbers and words
    close()                            the connection ends

One at the sender's end may also learn how its messages fare (congestion control needs that):

    watch(under_way)                   `under_way()` tells how many messages that it let pass are
                                       not confirmed yet: one may be leaving, and one wait for that
    confirmed(taken)                   the receiver has taken a message (see Taken)

The connection then sends from a thread of its own, one message at a time, and waits for what
confirms it; a carrier that confirms nothing is refused.

The class, or any function that returns such an object, is called with its `Place` and is found by
name (entry point group `yarpy.monitors`). If its parameters are wrong it raises one of yarpy's
errors, and the connection is refused with that text.

Rules: messages come one at a time, at the sender's end those of all writers, at the receiver's end
those of one connection. `trigger`, `configure`, `parameters` and `state` are called from any thread
at any time, `confirmed` from that of the connection. If a method raises, the message is dropped and
counted, and the error logged.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError
from yarpy.wire.stream import DEFAULT_LIMIT


class _Drop:
    """The type of DROP: this message goes no further."""

    def __repr__(self) -> str:
        return "DROP"


DROP: Final = _Drop()

FAILURES: Final = (Exception, SystemExit)
"""A monitor may raise these without ending the program or one of our threads."""


class Group:
    """The monitors at the receiving ends of one port's connections, which decide together.

    `members` is replaced, never changed in place. `shared` holds common state by monitor class, and
    `lock` guards it; hold it briefly, and never while a monitor's `trigger` runs.
    """

    def __init__(self) -> None:
        self.members: tuple[Any, ...] = ()
        self.shared: dict[type, Any] = {}
        self.lock = threading.RLock()
        self._triggered: tuple[Any, ...] = ()

    def add(self, monitor: object) -> None:
        """A connection was made."""
        with self.lock:
            self._set((*self.members, monitor))

    def remove(self, monitor: object) -> None:
        """A connection has ended."""
        with self.lock:
            self._set(tuple(one for one in self.members if one is not monitor))

    def _set(self, members: tuple[Any, ...]) -> None:
        self.members = members
        self._triggered = tuple(one for one in members if hasattr(one, "trigger"))

    def trigger(self, by: object) -> None:
        """Tell the others that `by` has let a message pass."""
        for monitor in self._triggered:
            if monitor is not by:
                monitor.trigger()


def _here(name: str, contexts: Sequence[str]) -> Iterable[Path]:
    return [Path(name)]


@dataclass(frozen=True, slots=True)
class Place:
    """The place where a monitor is attached: messages from `source` to `target`, at one end of the
    connection.

    `carrier` is the whole carrier string. For a port's own monitor, the peer's name and the carrier
    are empty. `tokens` are the monitor's own parameters, `shared` all of the connection's. `limit`
    is the port's largest message in bytes, which also holds for a monitor's results. `names` is the
    port's name client, to find other ports. `look` returns where a file may be, by its name and the
    contexts of robot and program. `foreign`: the monitor was requested over the network, not by the
    program that owns the port. `scripts`: who requested it may name scripts of a context.
    """

    source: str
    target: str
    carrier: str = ""
    sending: bool = False
    tokens: tuple[str, ...] = ()
    shared: tuple[str, ...] = ()
    group: Group = field(default_factory=Group)
    limit: int = DEFAULT_LIMIT
    names: Any = None
    look: Callable[[str, Sequence[str]], Iterable[Path]] = _here
    foreign: bool = False
    scripts: bool = False

    def __str__(self) -> str:
        if not self.carrier:
            return f"output of {self.source}" if self.sending else f"input of {self.target}"
        return f"{self.source} -> {self.target}"

    def find(self, key: str) -> str | Bottle | None:
        """The parameter `key`: text, a Bottle for `+(key ...)`, "" for a bare word, or None.

        The monitor's own parameters come before the connection's others, mixed as in C++; of equal
        names the last counts.
        """
        for tokens in (self.tokens, self.shared):
            for token in reversed(tokens):
                name, value = read_token(token)
                if name == key:
                    return value
        return None

    def text(self, key: str, default: str = "") -> str:
        """A parameter as text."""
        value = self.find(key)
        return default if value is None else value.to_text() if isinstance(value, Bottle) else value

    def flag(self, key: str) -> bool:
        """Return whether a word is present and not switched off (`+key`, `+key.1`; not
        `+key.0`)."""
        value = self.find(key)
        return value is not None and value not in ("0", "off", "false")

    def number(
        self, key: str, default: float, least: float = float("-inf"), most: float = float("inf")
    ) -> float:
        """A parameter as a number. LocalProtocolError if it is not one, or out of range."""
        value = self.find(key)
        if value is None:
            return default
        try:
            number = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            number = float("nan")
        if not least <= number <= most:
            limits = f" from {least:g} to {most:g}" if (least, most) != (-_INF, _INF) else ""
            raise LocalProtocolError(f'"{key}" takes a number{limits}, not "{self.text(key)}"')
        return number


_INF = float("inf")


@dataclass(frozen=True, slots=True)
class Taken:
    """A message of `size` bytes on the wire that was confirmed `seconds` after it began to leave:
    by the receiving port where the carrier has acknowledgements, else by its system."""

    size: int
    seconds: float


def read_token(token: str) -> tuple[str, str | Bottle]:
    """A parameter of a carrier string as key and value.

    >>> read_token("file.my.lua"), read_token("virtual")
    (('file', 'my.lua'), ('virtual', ''))
    >>> read_token("(ex (/a -10))")[0]
    'ex'
    """
    if token.startswith("("):
        inner = Bottle.from_text(token)
        while len(inner) == 1 and isinstance(inner[0], Bottle):
            inner = inner[0]  # the parentheses are doubled on their way through C++
        return (str(inner[0]) if inner else ""), Bottle(inner[1:])
    name, _, value = token.partition(".")
    return name, value
