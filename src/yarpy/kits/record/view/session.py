"""A client of the page: what it listens to, and where in time it is.

Rules: one thread sends, and pulls what it sends from the source when it is due: so a slow client
waits for itself alone, and misses what came meanwhile. Of pictures the newest is sent, of the rest
at most AT_ONCE messages of a port a time. Each client has a time of its own; while it follows what
is live, that is now.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any, Final

from yarpy.errors import DecodeError, YarpError
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.playback.timeline import Timeline
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.view import foxglove
from yarpy.kits.record.view.foxglove import Channel, State
from yarpy.kits.record.view.source import Source
from yarpy.kits.record.view.spelling import PICTURE, channel_of, spelled
from yarpy.limit import VIEW_SUBSCRIPTIONS

TICK: Final = 1 / 30  # seconds
REST: Final = 1.0  # seconds between looks for new ports, and of a time that stands still
AT_ONCE: Final = 50  # messages of a port in one tick
FASTEST: Final = 1000.0


class Session:
    """Serves a client until `close`. send: sends an object as JSON, and bytes as they are; raises
    OSError when the client has gone."""

    def __init__(self, source: Source, send: Callable[[bytes | dict[str, Any]], None]) -> None:
        self._source = source
        self._send = send
        self._channels: dict[str, Channel] = {}
        self._wanted: dict[int, str] = {}  # ports by subscriptions
        self._fresh: set[str] = set()  # ports that were never sent
        self._timeline = Timeline(source.begin)
        self._following = source.live
        self._jumped = source.live
        self._target = source.end  # where to
        self._requests: list[str] = []
        self._told: tuple[State, float] | None = None
        self._past = source.begin  # everything until then was sent
        self._renew = False  # other ports are to be read
        self._messages: Iterator[Recorded] | None = None
        self._next: Recorded | None = None
        self._looked = 0.0
        self._lock = threading.Lock()  # of what the client wants
        self._changed = threading.Event()
        self._closed = False

    def close(self) -> None:
        """Let `run` return."""
        self._closed = True
        self._changed.set()

    # -- what the client says ---------------------------------------------------------------------

    def hear_text(self, text: str) -> dict[str, Any] | None:
        """Take a text of the client; return what is to be said to it. Raises DecodeError."""
        word, order = foxglove.order_of(text)
        with self._lock:
            if word == "subscribe":
                ports = {channel.id: port for port, channel in self._channels.items()}
                for number, channel in foxglove.subscriptions_of(order):
                    if channel not in ports:
                        return foxglove.status(f"there is no channel {channel}", 2)
                    if len(self._wanted) >= VIEW_SUBSCRIPTIONS:
                        return foxglove.status("these are too many subscriptions", 2)
                    self._wanted[number] = ports[channel]
                    self._fresh.add(ports[channel])
                    self._renew = True
            elif word == "unsubscribe":
                for number in foxglove.numbers_of(order, "subscriptionIds"):
                    self._wanted.pop(number, None)
                self._renew = True
            else:
                return foxglove.status(f"nothing is done for {word[:100]!r} here", 1)
        self._changed.set()
        return None

    def hear_bytes(self, data: bytes) -> dict[str, Any] | None:
        """Take a binary message of the client; return what is to be said to it. Raises
        DecodeError."""
        wish = foxglove.control_of(data)
        if wish is None:
            return foxglove.status("nobody may write here", 2)
        now = time.monotonic()
        with self._lock:
            self._timeline.pace(min(max(wish.speed, 1 / FASTEST), FASTEST), now)
            if wish.seek is not None:
                moment = min(max(wish.seek, self._source.begin), self._source.end)
                self._following = self._source.live and not wish.paused and wish.seek >= moment
                self._timeline.jump(moment, now)
                self._jumped, self._target = True, moment
            elif wish.paused and self._following:
                self._timeline.jump(self._source.end, now)
            if wish.paused:
                self._following = False
                self._timeline.stop(now)
            else:
                if not self._source.live and self._timeline.moment(now) >= self._source.end:
                    self._timeline.jump(self._source.begin, now)
                    self._jumped, self._target = True, self._source.begin
                self._timeline.start(now)
            if len(self._requests) < AT_ONCE:
                self._requests.append(wish.request)
            self._told = None
        self._changed.set()
        return None

    # -- what it is sent --------------------------------------------------------------------------

    def run(self) -> None:
        """Send until `close`. Raises OSError when the client has gone; as reading does."""
        begin, end = self._source.begin, self._source.end
        self._send(foxglove.server_info("yarpy", f"{time.time():.6f}", begin, end))
        with self._source.open() as recording:
            while not self._closed:
                started = time.monotonic()
                self._look()
                try:
                    moves = self._tick(recording)
                except (DecodeError, YarpError) as error:
                    self._send(foxglove.status(str(error), 2))
                    moves = False
                left = TICK - (time.monotonic() - started) if moves else REST
                if left > 0 and self._changed.wait(left):
                    self._changed.clear()

    def _look(self) -> None:
        """Tell the client of ports that it does not know."""
        now = time.monotonic()
        if self._channels and now - self._looked < REST:
            return
        self._looked = now
        new = [
            channel_of(len(self._channels) + number, port, kind)
            for number, (port, kind) in enumerate(
                one for one in self._source.kinds.items() if one[0] not in self._channels
            )
        ]
        if new:
            with self._lock:
                self._channels.update({one.topic: one for one in new})
            self._send(foxglove.advertise(new))

    def _tick(self, recording: Recording) -> bool:
        """Send what is due; return whether time goes on."""
        with self._lock:
            now = time.monotonic()
            source = self._source
            end = source.end
            if self._following:
                self._timeline.jump(end, now)
                self._timeline.start(now)
            moment = self._timeline.moment(now)
            if moment >= end and source.live and self._timeline.running:
                self._following, moment = True, end
            over = moment >= end and not source.live
            if over and self._timeline.running:
                self._timeline.jump(end, now)
                self._timeline.stop(now)
            moment = min(moment, end)
            running, speed = self._timeline.running, self._timeline.rate
            jumped, self._jumped = self._jumped, False
            # What comes after a jump is played, however late it is.
            known = min(self._target, moment) if jumped else moment
            ports = {*self._wanted.values()}
            fresh = ports if jumped else self._fresh & ports
            self._fresh = set()
            renew, self._renew = jumped or self._renew, False
            requests, self._requests = self._requests, []
            state: State = "playing" if running else "ended" if over else "paused"
            tell = jumped or requests or self._told != (state, speed)
            self._told = state, speed
        if renew:
            self._messages, self._next = None, None
        if jumped:
            self._past = known
        told = [
            foxglove.playback_state(state, known, speed, jumped, request)
            for request in (requests or [""] if tell else [])
        ]
        # A jump is told first: what was shown before it is of another time.
        if jumped or not over:
            self._send_all(told)
        if fresh:
            for recorded in source.before(recording, sorted(fresh), known):
                self._send_message(recorded)
        if ports and moment > self._past:
            left_out = set() if jumped else fresh
            self._send_until(recording, sorted(ports), moment, left_out)
        self._past = max(self._past, moment)
        if over and not jumped:  # who is told of the end has got everything
            self._send_all(told)
        self._send(foxglove.time_data(moment))
        return running

    def _send_all(self, told: list[bytes]) -> None:
        for one in told:
            self._send(one)

    def _send_until(
        self, recording: Recording, ports: list[str], moment: int, left_out: set[str]
    ) -> None:
        """Send what came since `_past`, but for ports whose last message was sent already."""
        if self._messages is None:
            self._messages = recording.between(ports, self._past + 1, FOREVER)
            self._next = None
        due: dict[str, list[Recorded]] = {}
        while True:
            found = self._next or next(self._messages, None)
            self._next = None
            if found is None:
                if self._source.live:
                    self._messages = None  # there will be more
                break
            if found.received_ns > moment:
                self._next = found
                break
            if found.port in left_out:
                continue
            some = due.setdefault(found.port, [])
            some.append(found)
            most = 1 if self._source.kinds.get(found.port) == PICTURE else AT_ONCE
            if len(some) > most:
                del some[0]
        for some in due.values():
            for recorded in some:
                self._send_message(recorded)

    def _send_message(self, recorded: Recorded) -> None:
        payload = spelled(recorded, self._source.kinds.get(recorded.port, ""))
        with self._lock:
            numbers = [number for number, port in self._wanted.items() if port == recorded.port]
        for number in numbers:
            self._send(foxglove.message_data(number, max(0, recorded.received_ns), payload))
