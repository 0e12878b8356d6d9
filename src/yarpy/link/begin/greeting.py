"""Greeting: the beginning of a connection, which may end on another transport than it began on.

Rules: what a protocol asks for besides bytes and rights is done here, and nowhere later: another
way to the same peer (`Open`), the move there (`Switch`), a multicast group. Each transport has a
driver of its own; what is known of the peer goes along.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, Final, TypeVar

from yarpy import registry
from yarpy.errors import LocalProtocolError, RemoteProtocolError, Timeout, UnknownPlugin
from yarpy.link.byte_driver import ByteDriver
from yarpy.link.combine import combine
from yarpy.link.driver import Driver, sooner
from yarpy.link.object_driver import ObjectDriver
from yarpy.transports.base import ObjectTransport, Transport
from yarpy.transports.opener import CONNECT_TIMEOUT, MeetingPlace
from yarpy.wire.effects import Group, Open, Switch, Within
from yarpy.wire.framing import refused
from yarpy.wire.lending_stream import LendingStream
from yarpy.wire.steps import Steps
from yarpy.wire.stream import DEFAULT_LIMIT, ByteStream, ObjectStream

T = TypeVar("T")

#: Of a sending port: its multicast group, as `(address, port)`.
GroupOf = Callable[[], tuple[str, int]]

# C++ hangs up before it comes to the meeting place of the two ends.
LATE: Final = 0.5  # seconds for it to come after that


def driver_of(
    transport: Transport, limit: int = DEFAULT_LIMIT, stream: ByteStream | None = None
) -> Driver:
    """Return a driver for a transport. `limit`: the largest message in bytes, where there is no
    stream yet."""
    if isinstance(transport, ObjectTransport):
        items = stream if isinstance(stream, ObjectStream) else ObjectStream()
        return ObjectDriver(transport, items)
    if stream is None and transport.lends:
        stream = LendingStream(transport.borrow, limit)
    return ByteDriver(transport, ByteStream(limit) if stream is None else stream)


class Greeting:
    """Runs what two ends say first. `driver`: of the transport that the connection is on now.
    `group`: who knows the multicast group of the port that dials."""

    def __init__(self, driver: Driver, group: GroupOf | None = None) -> None:
        self.driver = driver
        self._group = group

    def run(self, steps: Steps[T], deadline: float | None = None) -> T:
        """Run `steps` to its end, as a driver does, wherever it moves to."""
        while True:
            value = self.driver.run(self._until_it_moves(steps, deadline), deadline)
            if not isinstance(value, Switch):
                return value
            self._move(value)

    def _until_it_moves(self, steps: Steps[T], deadline: float | None) -> Steps[T | Switch]:
        """Run `steps` as far as its driver does not change; return where it goes from there, or
        its value."""
        answer: Any = None
        while True:
            try:
                effect = steps.send(answer)
            except StopIteration as stop:
                ended: T = stop.value
                return ended
            if isinstance(effect, Switch):
                return effect
            try:
                if isinstance(effect, Open):
                    answer = _open(effect, self.driver.transport, deadline)
                elif isinstance(effect, Group):
                    answer = self._find_group()
                else:
                    if isinstance(effect, Within):
                        deadline = sooner(deadline, effect.seconds)
                    answer = yield effect
            except (LocalProtocolError, Timeout) as error:
                try:
                    steps.throw(error)  # a protocol may tell its peer before it fails itself
                except StopIteration as stop:
                    if isinstance(error, LocalProtocolError):
                        ended = stop.value
                        return ended
                raise

    def _find_group(self) -> tuple[str, int]:
        if self._group is None:
            raise LocalProtocolError("this connection cannot choose a multicast group")
        return self._group()

    def _move(self, move: Switch) -> None:
        """Go on over another transport, or through another stream."""
        old, handle = self.driver, move.handle
        if handle is None:
            self.driver = driver_of(old.transport, stream=move.stream)
            self.driver.bytes_in, self.driver.bytes_out = old.bytes_in, old.bytes_out
        else:
            try:
                handle.ready(_watch(old))
            except BaseException:
                handle.close()
                raise
            old.transport.close()
            self.driver = driver_of(handle, stream=move.stream)
        self.driver.admission = old.admission
        self.driver.silence, self.driver.room = old.silence, old.room
        self.driver.rival = old.rival


def _open(effect: Open, through: Transport, deadline: float | None) -> Any:
    """Return the handle of another way to the peer of the connection `through`."""
    kind = effect.kind or through.scheme
    try:
        base = registry.transports.facts(through.scheme)
        refused = combine(kind, kind, base, through.secure) if effect.kind else ""
        opener = registry.transports.load(kind)
    except UnknownPlugin as error:
        raise LocalProtocolError(str(error)) from error
    if refused:
        raise LocalProtocolError(refused)
    left = CONNECT_TIMEOUT if deadline is None else max(deadline - time.monotonic(), 0.001)
    return opener.meet(MeetingPlace(through, effect.listen, effect.port, effect.group, left))


def _watch(driver: Driver) -> Callable[[], None]:
    """Return a function to call while the two ends look for each other elsewhere. It raises
    RemoteProtocolError once the peer refuses over the connection on which they have met."""
    stream, hung_up = driver.stream, 0.0

    def look() -> None:
        nonlocal hung_up
        if not hung_up and driver.try_fill():
            if stream.waiting:
                line = _first_line(stream)
                error = RemoteProtocolError(f'the peer answers "{line[:80]}"')
                raise refused(line.encode()) or error
            hung_up = time.monotonic()
        if hung_up and time.monotonic() - hung_up > LATE:
            raise RemoteProtocolError("the peer hung up; it does not take this carrier")

    return look


def _first_line(stream: ByteStream) -> str:
    """Return the first line that a peer has sent, for people."""
    start = bytes(stream.buffer[stream.head : stream.head + 1000])
    text = start.partition(b"\n")[0].decode("utf-8", "replace")
    return "".join(c for c in text if c.isprintable())
