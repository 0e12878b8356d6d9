"""The time that a program lives by: the computer's, or that of a simulation or a recording.

    yarpy.clock.now()       seconds since 1970, or since a simulation began
    yarpy.clock.sleep(0.1)  as long by the same clock

With YARP_CLOCK=/clock in the environment it is what the port /clock sends: a simulator, `yarpy play
--clock`, `yarpy clock`. `use` changes it while the program runs.

Rules: a clock of the network says what it heard last, and nothing in between. It is heard through a
persistent connection, so that either side may start first. Whoever waits for a clock is let go when
it is closed; when it jumps back, all who sleep go on sleeping as long as they had left.
"""

from __future__ import annotations

import os
import socket
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Final, Protocol, Self

from yarpy import fork
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError, LocalProtocolError, PortClosed, Timeout, YarpError
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.network.asking import ask_server
from yarpy.network.remote import connect
from yarpy.platform.waiting import happens
from yarpy.port.port import BufferedPort
from yarpy.wire.message import Message

__all__ = ["Clock", "NetworkClock", "SystemClock", "current", "now", "sleep", "spelled", "use"]

log = logger("yarpy.clock")

SETTING: Final = "YARP_CLOCK"
NAME: Final = "/clock"  # of the port that most simulators send it from
_SLICE: Final = 0.05  # seconds after which an event that ends a wait is seen
_SILENCE: Final = 2.0  # seconds after which it is said that nothing was heard


class Clock(Protocol):
    """Something that tells the time."""

    def now(self) -> float:
        """Return the time in seconds."""

    def monotonic(self) -> float:
        """Return seconds since some moment, for differences. It waits for nothing."""

    def wait(self, event: threading.Event, seconds: float) -> bool:
        """Wait until `event` is set or so many seconds have passed; return whether it is set."""


class SystemClock:
    """The computer's: seconds since 1970. It is never set back for those who wait."""

    def now(self) -> float:
        """Return the time in seconds since 1970."""
        return time.time()

    def monotonic(self) -> float:
        """Return seconds since some moment."""
        return time.monotonic()

    def wait(self, event: threading.Event, seconds: float) -> bool:
        """Wait until `event` is set or so many seconds have passed; return whether it is set."""
        return happens(event, seconds)


class NetworkClock:
    """The time that a port of the network sends: Bottles of seconds and nanoseconds.

    source: that port. name: of the own port that hears it. names: a name client, None for the
    default. Raises NoNameServer, AddressError.
    """

    def __init__(
        self, source: str = NAME, *, name: str = "", names: NameClient | None = None
    ) -> None:
        self.source = source
        self._names = names
        self._time: float | None = None
        self._ticked = threading.Condition(threading.Lock())
        self._closed = False
        self._port = BufferedPort(name or _own_name(), callback=self._take, names=names)
        try:
            self._subscribe(names)
        except BaseException:
            self._port.close()
            raise

    def _subscribe(self, names: NameClient | None) -> None:
        try:
            ask_server(names, ["subscribe", self.source, self._port.name, "to"])
        except LocalProtocolError:
            # Without a server to remember it, the clock has to be there already.
            connect(self.source, self._port.name, names=names)

    @property
    def valid(self) -> bool:
        """Return whether anything was heard."""
        return self._time is not None

    def wait_until_valid(self, timeout: float | None = None) -> None:
        """Wait for the first message. Raises Timeout, PortClosed."""
        deadline = None if timeout is None else time.monotonic() + timeout
        told = time.monotonic() + _SILENCE
        while self._time is None:
            if self._closed:
                raise PortClosed(f"the clock {self.source} was closed")
            now = time.monotonic()
            if deadline is not None and now >= deadline:
                raise Timeout(
                    f"the clock {self.source} sends nothing: start it, or unset {SETTING}"
                )
            if now >= told:
                told = float("inf")
                log.warning("waiting for the clock %s, which YARP_CLOCK names", self.source)
            with self._ticked:
                if self._time is None:
                    self._ticked.wait(_SLICE)

    def now(self) -> float:
        """Return what was heard last, in seconds; wait for the first message. Raises PortClosed."""
        found = self._time
        if found is None:
            self.wait_until_valid()
            found = self._time
            assert found is not None
        return found

    def monotonic(self) -> float:
        """Return what was heard last, 0 before."""
        return self._time or 0.0

    def wait(self, event: threading.Event, seconds: float) -> bool:
        """Wait until `event` is set or so many seconds have passed by this clock; return whether
        it is set. A clock that was closed is not waited for."""
        left, before = seconds, self._time
        while left > 0 and not event.is_set() and not self._closed:
            with self._ticked:
                if self._time == before:
                    self._ticked.wait(_SLICE)
            found = self._time
            if before is not None and found is not None and found > before:
                left -= found - before
            before = found
        return event.is_set()

    def _take(self, message: Message) -> None:
        try:
            seconds, nanoseconds = message.as_(Bottle)
            heard = float(seconds) + float(nanoseconds) * 1e-9
        except (DecodeError, TypeError, ValueError) as error:
            log.warning("%s sends no time: %s", message.source, error)
            return
        with self._ticked:
            self._time = heard
            self._ticked.notify_all()

    def close(self) -> None:
        """Hear no more, and let go whoever waits."""
        self._closed = True
        with suppress(YarpError):
            ask_server(self._names, ["unsubscribe", self.source, self._port.name])
        self._port.close()
        with self._ticked:
            self._ticked.notify_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def _own_name() -> str:
    program = Path(sys.argv[0] if sys.argv else "").name or "python"
    return f"/{socket.gethostname()}/{program}/{os.getpid()}/clock:i"


def spelled(seconds: float) -> list[int]:
    """Return a time as a clock sends it: seconds and nanoseconds."""
    whole, rest = divmod(round(seconds * 1e9), 1_000_000_000)
    return [whole, rest]


# -- the program's ---------------------------------------------------------------------------------

_SYSTEM: Final = SystemClock()
_NEVER: Final = threading.Event()
_current: Clock | None = None  # None: nobody has asked yet
_lock = fork.lock()


def current() -> Clock:
    """Return the clock of this program: what was given to `use`, else what YARP_CLOCK names, else
    the computer's. Raises NoNameServer, AddressError where YARP_CLOCK names one."""
    global _current
    if (found := _current) is not None:
        return found
    with _lock:
        if _current is None:
            source = os.environ.get(SETTING, "")
            if source:
                fork.after_in_child(_forget)
            _current = NetworkClock(source) if source else _SYSTEM
        return _current


def use(clock: Clock | None) -> None:
    """Let this program live by `clock`; None is the computer's. The one before is not closed."""
    global _current
    with _lock:
        _current = clock or _SYSTEM


def now() -> float:
    """Return the time in seconds; wait for a clock of the network that has not sent any yet."""
    return current().now()


def monotonic() -> float:
    """Return seconds since some moment, for differences; wait for a clock of the network that has
    not sent any yet."""
    found = current()
    if isinstance(found, NetworkClock) and not found.valid:
        found.wait_until_valid()
    return found.monotonic()


def sleep(seconds: float) -> None:
    """Wait for so many seconds by the clock of this program."""
    current().wait(_NEVER, seconds)


def _forget() -> None:
    """A forked child has no connections: it asks again."""
    global _current
    if isinstance(_current, NetworkClock):
        _current = None
