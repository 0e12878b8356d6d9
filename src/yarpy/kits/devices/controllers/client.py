"""ControllerClient: what the clients of the Cartesian and of the gaze controller have in common.

Rules: a question is answered by `[ack]` and values, or by `[nack]`, which is a LocalProtocolError
that repeats the question. Contexts that a client has stored are deleted when it closes. Callbacks
for events come from a thread of the port.

Source: ClientCartesianController and ClientGazeController of icub-main, both of version 2.0.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from typing import Any, ClassVar, Final, NamedTuple

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, RemoteProtocolError, YarpError
from yarpy.kits.devices.closeable import Closeable, local_prefix, prefix
from yarpy.kits.devices.kind import word
from yarpy.kits.devices.latest_message import LatestMessage
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcClient
from yarpy.wire.message import Message

#: Seconds to wait for an answer.
TIMEOUT: Final = 10.0
#: The protocol that both ends speak.
VERSION: Final = "2.0"


class Event(NamedTuple):
    """Something that a controller tells. `kind`: `motion-onset`, `motion-done`, `motion-ongoing`
    ...; `time`: the controller's; `share`: how much of the time is over, from 0 to 1, while it goes
    on."""

    kind: str
    time: float
    share: float | None


class ControllerClient(Closeable):
    """Asks and commands the controller whose ports begin with `remote`."""

    #: its port for questions; those that take commands; those that tell numbers; the event that a
    #: share of the way is asked for with
    RPC: ClassVar[str]
    COMMANDS: ClassVar[Sequence[str]]
    STATES: ClassVar[Sequence[str]]
    ONGOING: ClassVar[tuple[Sequence[Any], Sequence[Any]]]

    def __init__(
        self,
        remote: str,
        local: str = "",
        *,
        carrier: str = "tcp",
        timeout: float = 0.5,
        names: NameClient | None = None,
    ) -> None:
        self.remote = remote = prefix(remote)
        local = local_prefix(local, remote)
        self._contexts: set[int] = set()
        self._heard: dict[tuple[str, float | None], Callable[[Event], object]] = {}
        with ExitStack() as resources:
            enter = resources.enter_context
            self._rpc = enter(
                RpcClient(
                    f"{remote}/{self.RPC}", name=f"{local}/rpc:o", names=names, timeout=TIMEOUT
                )
            )
            self._check_version()
            self._out = {}
            for name in self.COMMANDS:
                self._out[name] = out = enter(Port(f"{local}/{name}:o", names=names))
                out.connect(f"{remote}/{name}:i", carrier)
            self._states = {
                name: enter(
                    LatestMessage(
                        f"{remote}/{name}:o", f"{local}/{name}:i", carrier, timeout, names, _numbers
                    )
                )
                for name in self.STATES
            }
            events = enter(BufferedPort(f"{local}/events:i", callback=self._event, names=names))
            events.read_strictly()
            events.listen_to(f"{remote}/events:o", carrier)
            resources.callback(self._forget)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.remote}>"

    def _check_version(self) -> None:
        version = self.info().get("server_version", VERSION)
        if str(version) != VERSION:
            raise RemoteProtocolError(
                f'"{self.remote}" speaks version {version}, not {VERSION}: update icub-main there'
            )

    # -- questions ----------------------------------------------------------------------------

    def ask(self, *words: Any) -> list[Any]:
        """Return what is behind `[ack]`. Raises LocalProtocolError (refused), Timeout."""
        answer = self._rpc.ask(Bottle(words), TIMEOUT)
        found = [] if answer is None else [*answer.as_(Bottle)]
        if not found or word(found[0]) != "ack":
            raise LocalProtocolError(f'"{self.remote}" refuses {Bottle(words).to_text()}')
        return found[1:]

    def ask_number(self, *words: Any) -> float:
        """Return the one number of an answer."""
        found = self.ask(*words)
        try:
            return float(found[0])
        except (IndexError, TypeError, ValueError):
            raise self._strange(words, found) from None

    def ask_numbers(self, *words: Any, least: int = 0) -> tuple[float, ...]:
        """Return the numbers of a list, at least so many."""
        found = self.ask(*words)
        try:
            values = tuple(map(float, found[0]))
            if len(values) >= least:
                return values
        except (IndexError, TypeError, ValueError):
            pass
        raise self._strange(words, found)

    def _strange(self, words: Sequence[Any], found: Any) -> RemoteProtocolError:
        said = Bottle(found).to_text()
        return RemoteProtocolError(f'"{self.remote}" answers {Bottle(words).to_text()} by {said}')

    def info(self) -> dict[str, Any]:
        """Return what the controller says of itself, by name."""
        found = self.ask(*self._words("get", "info"))
        pairs = found[0] if found and isinstance(found[0], Bottle) else Bottle()
        return {
            str(pair[0]): pair[1] if len(pair) == 2 else Bottle(pair[1:])
            for pair in pairs
            if isinstance(pair, Bottle) and len(pair) > 1
        }

    def tweaks(self) -> Bottle:
        """Return the settings of the controller that have no method."""
        found = self.ask(*self._words("get", self._tweak))
        return found[0] if found and isinstance(found[0], Bottle) else Bottle()

    def tweak(self, options: Bottle) -> None:
        """Change such settings: a list of `(name value)`."""
        self.ask(*self._words("set", self._tweak), options)

    _tweak: ClassVar[str]

    @staticmethod
    def _words(*words: str) -> list[Any]:
        """The words as this controller is asked: vocabs, or strings."""
        return [*map(Vocab, words)]

    # -- motion -------------------------------------------------------------------------------

    def motion_done(self) -> bool:
        """Return whether it has arrived."""
        raise NotImplementedError

    def wait_motion_done(self, period: float = 0.1, timeout: float = 0.0) -> bool:
        """Wait until it has arrived; False if that takes more than `timeout` seconds (0: for ever).
        `period`: seconds between two questions."""
        return wait_until_done(self.motion_done, period, timeout)

    def stop(self) -> None:
        """Stop moving."""
        self.ask(*self._words("stop"))

    # -- contexts -----------------------------------------------------------------------------

    def store_context(self) -> int:
        """Keep all settings under a number."""
        number = int(self.ask_number(*self._words("stor")))
        self._contexts.add(number)
        return number

    def restore_context(self, number: int) -> None:
        """Take settings back that were kept; 0 are those of the beginning."""
        self.ask(*self._words("rest"), number)

    def delete_context(self, *numbers: int) -> None:
        """Forget settings."""
        self.ask(*self._words("del"), Bottle(numbers))
        self._contexts -= {*numbers}

    def _forget(self) -> None:
        if self._contexts:
            with suppress(YarpError):
                self.delete_context(*self._contexts)

    # -- events -------------------------------------------------------------------------------

    def on_event(
        self, kind: str, callback: Callable[[Event], object], share: float | None = None
    ) -> None:
        """Call `callback` with each event of a kind, `*`: of any. For `motion-ongoing`, `share`
        says how much of the way has to be done, from 0 to 1."""
        if kind == "motion-ongoing" and share is not None:
            self.ask(*self.ONGOING[0], float(share))
        self._heard[kind, share] = callback

    def off_event(self, kind: str, share: float | None = None) -> None:
        """Call nobody with these events any more."""
        if self._heard.pop((kind, share), None) is not None and share is not None:
            self.ask(*self.ONGOING[1], float(share))

    def _event(self, message: Message) -> None:
        found = [*message.as_(Bottle)]
        if not found:
            return
        kind = str(found[0])
        share = float(found[2]) if kind == "motion-ongoing" and len(found) > 2 else None
        event = Event(kind, float(found[1]) if len(found) > 1 else clock.now(), share)
        for key in (("*", None), (kind, share)):
            callback = self._heard.get(key)
            if callback is not None:
                callback(event)


def wait_until_done(done: Callable[[], bool], period: float, timeout: float) -> bool:
    """Ask again and again; False if that takes more than `timeout` seconds (0: for ever)."""
    until = time.monotonic() + timeout
    while not done():
        if timeout > 0 and time.monotonic() > until:
            return False
        time.sleep(period)
    return True


def numbers(values: Sequence[float], count: int, what: str) -> list[float]:
    """Return so many numbers as a list of floats. Raises ValueError for another count."""
    found = [float(value) for value in values]
    if len(found) != count:
        raise ValueError(f"{what} has {count} numbers, not {len(found)}")
    return found


def _numbers(message: Message) -> tuple[float, ...]:
    return tuple(map(float, message.as_(Vector)))
