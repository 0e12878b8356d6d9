"""Player: sends a recording again, from ports with the names that it was recorded from.

    with record.open("walk.mcap") as recording, record.Player(recording) as player:
        player.play()

Rules: each message is sent when it is due by the clock, not so long after the one before it, so
lateness never adds up; what is late is sent at once. Payloads and envelopes are those that were
recorded, to the byte. A reader that does not take what it gets is waited for once, and then not
any more: what it misses is counted in `dropped`. No name that lives is taken.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Mapping
from contextlib import ExitStack, suppress
from typing import Any, Final, Self

from yarpy.clock import spelled
from yarpy.errors import AddressError, DecodeError, LocalProtocolError, PortClosed, UnknownName
from yarpy.kits.record.bag.foreign import ForeignMessage, with_foreign
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.playback.read_ahead import ReadAhead
from yarpy.kits.record.playback.timeline import Timeline
from yarpy.kits.record.playback.topic import open_topic
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.kits.record.recording import Recording
from yarpy.names.base import NameClient
from yarpy.port.port import Port
from yarpy.scope import Waiter

READER_TIMEOUT: Final = 0.5  # seconds that a reader may keep a message waiting, once
RATES: Final = (0.001, 1000.0)  # the slowest and the fastest
_WAIT: Final = 0.05  # seconds between looks for readers
TICK: Final = 0.01  # seconds from one message of the clock to the next


class Player:
    """The ports of a recording, open.

    ports: which of them, None for all. rate: 2 plays twice as fast. loop: begin again at the end.
    start: seconds of the recording that are left out; duration: how many are played, None for all.
    rename: other names for ports; prefix: what is put before those that are not renamed.
    node: a node whose topics the ports are, by the names that they have then: `/player` of ROS 1,
    `ros2://player` or `ros2+dds://player` of ROS 2; "" for none.
    clock: a port that sends the time of the recording, for programs with YARP_CLOCK; "" for none.
    taken: called with a port of the recording whose name lives, and why: it is played to nobody;
    None: that is an error. `loop`, `muted` (ports that are not sent) and `reader_timeout` may be
    changed. Raises UnknownName for a port that is not in the recording, AddressError for a name
    that lives, LocalProtocolError for what cannot be played and for a start behind the end,
    NoNameServer.
    """

    def __init__(
        self,
        recording: Recording,
        ports: Collection[str] | None = None,
        *,
        rate: float = 1.0,
        loop: bool = False,
        start: float = 0.0,
        duration: float | None = None,
        rename: Mapping[str, str] | None = None,
        prefix: str = "",
        node: str = "",
        clock: str = "",
        names: NameClient | None = None,
        taken: Callable[[str, AddressError], object] | None = None,
    ) -> None:
        self._recording = recording = with_foreign(recording)
        self._names = names
        self._node = node
        self.loop = loop
        self.muted: set[str] = set()
        self.reader_timeout = READER_TIMEOUT
        self.begin = min((one.begin for one in recording.storages if one.end), default=0)
        self.begin += round(start * SECOND)
        last = max((one.end for one in recording.storages), default=0)
        self.end = last if duration is None else min(last, self.begin + round(duration * SECOND))
        if start and self.begin > last:
            length = max(0.0, start - (self.begin - last) / SECOND)
            raise LocalProtocolError(
                f"nothing was recorded after {start:g} s: the recording lasts {length:.1f} s"
            )
        self._timeline = Timeline(self.begin, _checked(rate))
        self._stack = ExitStack()
        self._ports: dict[str, Port] = {}
        self._slow: set[str] = set()
        self._passed: dict[str, int] = {}  # the last message of each port since the last jump
        self._stopped = False
        self._steps = 0  # messages that are to be sent while time stands still
        self._jumped = False
        self._target = self.begin  # where to go on from
        self._range: tuple[int, int] | None = None  # what is played again and again
        self._changed = Waiter()
        self._closed = threading.Event()
        self._lock = threading.Lock()  # of the time line, which other threads change
        self.played = 0
        self.dropped = 0
        self.latest = 0.0  # seconds that a message was late, at most
        self._facts = recording.ports
        self._chosen = _chosen(self._facts, ports, rename or ())
        with ExitStack() as stack:
            stack.callback(self._close_ports)
            for name in self._chosen:
                new = (rename or {}).get(name, f"{prefix}{name}")
                try:
                    self._ports[name] = open_topic(new, node, self._facts[name], names)
                except AddressError as error:
                    if taken is not None:
                        taken(name, error)
                        continue
                    raise AddressError(
                        f"{error}; a recording is played beside what lives with --prefix /replay "
                        f"or --rename {name}=/other"
                    ) from error
            if clock:
                port = stack.enter_context(open_topic(clock, "", PortFacts(clock), names))
                ticking = threading.Thread(
                    target=self._tick, args=(port,), name="yarpy play clock", daemon=True
                )
                ticking.start()
                stack.callback(ticking.join)
            self._stack = stack.pop_all()

    @property
    def ports(self) -> dict[str, str]:
        """Return the names of the ports, by those of the recording."""
        return {name: port.name for name, port in self._ports.items()}

    def rename(self, port: str, new: str) -> None:
        """Send what is of that port of the recording from a port with another name. Raises
        UnknownName, AddressError, NoNameServer; the port that there was stays then."""
        if port not in self._chosen:
            raise UnknownName(f'"{port}" is not played: there are {" ".join(self._chosen)}')
        opened = open_topic(new, self._node, self._facts[port], self._names)
        before = self._ports.get(port)
        self._ports[port] = opened
        if before is not None:
            before.close()

    def _close_ports(self) -> None:
        for port in self._ports.values():
            port.close()

    def next_moment(self, port: str) -> int:
        """Return the time from which on messages of that port are still to be sent, in
        nanoseconds since 1970."""
        with self._lock:
            last = self._passed.get(port)
            return self._target if last is None else last + 1

    @property
    def position(self) -> float:
        """Return how far it is, in seconds from the beginning of what is played."""
        return (self._moment() - self.begin) / SECOND

    def _moment(self) -> int:
        with self._lock:
            moment = self._timeline.moment(time.monotonic())
        return min(max(moment, self.begin), self.end)

    def _tick(self, port: Port) -> None:
        """Send the time of the recording, while it stands still, too: programs may come later."""
        while not self._closed.wait(TICK):
            with suppress(PortClosed):
                port.write(spelled(self._moment() / SECOND), timeout=TICK)

    @property
    def length(self) -> float:
        """Return how long it takes at rate 1, in seconds."""
        return max(0, self.end - self.begin) / SECOND

    @property
    def rate(self) -> float:
        """Return how many seconds of the recording pass in a second."""
        return self._timeline.rate

    @rate.setter
    def rate(self, rate: float) -> None:
        with self._lock:
            self._timeline.pace(_checked(rate), time.monotonic())
        self._changed.wake()

    @property
    def paused(self) -> bool:
        """Return whether time stands still."""
        return not self._timeline.running

    def pause(self) -> None:
        """Let time stand still, until `resume`."""
        with self._lock:
            self._timeline.stop(time.monotonic())
        self._changed.wake()

    def resume(self) -> None:
        """Go on."""
        with self._lock:
            self._steps = 0
            self._timeline.start(time.monotonic())
        self._changed.wake()

    def seek(self, position: float) -> None:
        """Go on from there, in seconds from the beginning of what is played."""
        moment = self.begin + round(min(max(position, 0.0), self.length) * SECOND)
        with self._lock:
            self._timeline.jump(moment, time.monotonic())
            self._target, self._jumped, self._passed = moment, True, {}
        self._changed.wake()

    def seek_mark(self, text: str) -> None:
        """Go on from the moment that was marked with that text. Raises UnknownName."""
        first = min((one.begin for one in self._recording.storages if one.end), default=0)
        self.seek(self._recording.mark(text) - (self.begin - first) / SECOND)

    @property
    def range(self) -> tuple[float, float] | None:
        """Return what is played again and again, in seconds from the beginning of what is played;
        None if there is no such range."""
        found = self._range
        if found is None:
            return None
        return (found[0] - self.begin) / SECOND, (found[1] - self.begin) / SECOND

    def loop_range(self, begin: float, end: float) -> None:
        """Play what lies between these seconds again and again, until `end_range`. Raises
        LocalProtocolError if nothing does."""
        first, last = (
            self.begin + round(min(max(one, 0.0), self.length) * SECOND) for one in (begin, end)
        )
        if first >= last:
            raise LocalProtocolError(f"nothing lies between {begin} and {end} s")
        self._range = first, last
        self.seek((first - self.begin) / SECOND)

    def end_range(self) -> None:
        """Go on behind the end of a range."""
        chosen = self.range
        if chosen is not None:
            self._range = None
            self.seek(min(self.position, chosen[1]))  # time may be ahead of what is late

    def step(self) -> None:
        """Send the next message, and let time stand still there."""
        with self._lock:
            self._timeline.stop(time.monotonic())
            self._steps += 1
        self._changed.wake()

    def stop(self) -> None:
        """Let `play` return. Any thread may call it."""
        self._stopped = True
        self._changed.wake()

    def wait_for_readers(self) -> bool:
        """Wait until each port is connected; return False if `stop` comes first."""
        while not self._stopped:
            if all(port.outputs for port in self._ports.values()):
                return True
            self._changed.wait(_WAIT)
        return False

    def play(self, paused: bool = False) -> bool:
        """Play until the end; return whether it was reached, and nobody has called `stop`.

        paused: begin with time standing still. Raises as reading does.
        """
        if not paused:
            self.resume()
        while not self._stopped:
            with self._lock:
                moment, self._jumped = self._target, False
                chosen = self._range
                first, last = chosen or (self.begin, self.end)
            ended = self._play_from(moment, last)
            if self._stopped:
                return False
            with self._lock:
                if not ended or self._jumped:
                    continue
                if chosen is None and (not self.loop or self.end <= self.begin):
                    return True
                # The next round begins where this one ends, by the clock, however late it was.
                going = self._timeline.running and moment < last
                over = self._timeline.due(last) if going else time.monotonic()
                self._timeline.jump(first, over)
                self._target, self._passed = first, {}
        return False

    def _play_from(self, moment: int, last: int) -> bool:
        """Play from a moment until the last one; return False if somebody wants another one."""
        until = last + 1 if last < FOREVER else FOREVER
        messages = ReadAhead(self._recording.between(self._chosen, moment, until))
        try:
            for recorded in messages:
                if not self._wait_until(recorded.received_ns):
                    return False
                self._send(recorded)
        finally:
            messages.close()
        return self._wait_until(last)

    def _wait_until(self, moment: int) -> bool:
        """Wait until a message is due; return False if it is not wanted any more."""
        while True:
            with self._lock:
                if self._stopped or self._jumped:
                    return False
                left = None
                if self._steps and not self._timeline.running:
                    self._steps -= 1
                    self._timeline.jump(moment, time.monotonic())
                    return True
                if self._timeline.running:
                    left = self._timeline.due(moment) - time.monotonic()
            if left is not None and left <= 0:
                self.latest = max(self.latest, -left)
                return True
            self._changed.wait(left)

    def _value(self, recorded: Recorded) -> Any:
        """Return what is written: for a topic of ROS the object, which says the type; else its
        bytes. Raises DecodeError."""
        if not self._node:
            return Payload(recorded.parts)
        return recorded.foreign if isinstance(recorded, ForeignMessage) else recorded.value

    def _send(self, recorded: Recorded) -> None:
        with self._lock:
            if not self._jumped:
                self._passed[recorded.port] = recorded.received_ns
        port = self._ports.get(recorded.port)
        readers = 0 if port is None or recorded.port in self.muted else len(port.outputs)
        if port is None or recorded.port in self.muted or not (readers or self._node):
            self.played += 1
            return
        reader_timeout = 0 if recorded.port in self._slow else self.reader_timeout
        try:
            value = self._value(recorded)
        except DecodeError:
            took = 0
        else:
            took = port.write(value, recorded.envelope or None, timeout=reader_timeout)
        if took < readers:
            self._slow.add(recorded.port)
            self.dropped += readers - took
        else:
            self._slow.discard(recorded.port)
        self.played += 1

    def close(self) -> None:
        """Close the ports."""
        self.stop()
        self._closed.set()
        self._stack.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


class Payload:
    """The payload of a message, byte for byte."""

    __slots__ = ("_parts",)

    def __init__(self, parts: tuple[bytes | memoryview, ...]) -> None:
        self._parts = parts

    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        return self._parts


def _checked(rate: float) -> float:
    if not RATES[0] <= rate <= RATES[1]:
        raise LocalProtocolError(f"a rate of {rate}: it is from {RATES[0]} to {RATES[1]:.0f}")
    return rate


def _chosen(
    known: Mapping[str, PortFacts], ports: Collection[str] | None, renamed: Collection[str]
) -> list[str]:
    chosen = [name for name in known if known[name].playable] if ports is None else list(ports)
    for name in (*chosen, *renamed):
        if name not in known:
            raise UnknownName(f'"{name}" was not recorded: there are {" ".join(known)}')
    for name in chosen:
        if not known[name].playable:
            raise LocalProtocolError(f'"{name}" is {known[name].kinds[0]}, not of YARP')
    if not chosen:
        raise LocalProtocolError("nothing was recorded that could be played")
    return chosen
