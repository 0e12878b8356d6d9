"""The last minutes of ports in memory: what a page shows that looks at what is live.

Rules: what is older than `keep` seconds goes, and what is more than `memory` bytes. The threads of
connections put, and wait for nobody; those who read take a few messages at a time. A port that is
not there yet is connected when it comes.
"""

from __future__ import annotations

import threading
import time
from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, Final, Self

from yarpy.errors import YarpError
from yarpy.kits.record.capture.opening import open_port
from yarpy.kits.record.capture.queue import MEMORY, OVERHEAD, own
from yarpy.kits.record.capture.subscriptions import PortSelection, Subscriptions
from yarpy.kits.record.envelope import fields_of
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.view.overview import SECOND, Overview
from yarpy.kits.record.view.source import timeline
from yarpy.names.base import NameClient
from yarpy.port.connection import ConnectionEvent
from yarpy.wire.message import UNSENDABLE, Message

KEEP: Final = 300.0  # seconds
NOTES: Final = 1000
_AT_ONCE: Final = 256  # messages that are taken under the lock
_SLACK: Final = 4096  # messages that went before the list is made shorter
_BACK: Final = 20_000  # messages that are looked through for the last one of a port


class Ring:
    """A Storage of what came lately. keep: seconds. memory: bytes."""

    def __init__(self, keep: float = KEEP, memory: int = MEMORY) -> None:
        self.path = Path("live")
        self.damages: list[Damaged] = []
        self.complete = True
        self.facts: dict[str, str] = {}
        self.lost = 0  # messages that could not be kept
        self._keep = round(keep * SECOND)
        self._memory = memory
        self._lock = threading.Lock()
        self._times = array("q")  # of all in `_held`
        self._held: list[Recorded | None] = []
        self._gone = 0  # at the beginning of both lists
        self._dropped = 0  # that are in the lists no more
        self._facts: dict[str, PortFacts] = {}
        self._noted: list[dict[str, Any]] = []
        self.begun = time.time_ns()
        self.size = 0

    def put(self, message: Message) -> None:
        """Keep a message. Called in the thread of its connection."""
        try:
            payload = own(message)
        except (YarpError, *UNSENDABLE):
            self.lost += 1
            return
        with self._lock:
            now = max(time.time_ns(), self._times[-1] if self._times else 0)
            _, _, sent = fields_of(message.envelope, now, 0)
            self._times.append(now)
            self._held.append(Recorded(message.source, now, sent, message.envelope, payload))
            self.size += len(payload) + OVERHEAD
            known = self._facts.get(message.source)
            if known is None:
                known = PortFacts(message.source, [kind_of(payload)])
                self._facts[message.source] = known
            known.messages += 1
            self._forget(now)

    def _forget(self, now: int) -> None:
        while self._gone < len(self._held) - 1 and (
            self._times[self._gone] < now - self._keep or self.size > self._memory
        ):
            old = self._held[self._gone]
            assert old is not None
            self._held[self._gone] = None
            self.size -= len(old.payload) + OVERHEAD
            self._gone += 1
        if self._gone > _SLACK and self._gone > len(self._held) // 2:
            del self._held[: self._gone], self._times[: self._gone]
            self._dropped += self._gone
            self._gone = 0

    def note(self, what: str, **facts: Any) -> None:
        """Note something about this moment."""
        with self._lock:
            self._noted.append({"what": what, **facts, "time_ns": time.time_ns()})
            del self._noted[:-NOTES]

    @property
    def begin(self) -> int:
        """Return when the oldest message came that is kept."""
        with self._lock:
            return self._times[self._gone] if self._held else self.begun

    @property
    def end(self) -> int:
        """Return when the last message came."""
        with self._lock:
            return self._times[-1] if self._held else self.begun

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return the ports that something came from."""
        with self._lock:
            return dict(self._facts)

    def messages(
        self, ports: Collection[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these ports (None: all) from `begin` until before `end`, as long as
        they are kept."""
        with self._lock:
            begin, end = min(begin, 1 << 62), min(end, 1 << 62)
            at = self._dropped + bisect_left(self._times, begin, self._gone)
        while True:
            with self._lock:
                start = max(at - self._dropped, self._gone)
                some = self._held[start : start + _AT_ONCE]
                at = self._dropped + start + len(some)
            if not some:
                return
            for recorded in some:
                if recorded is None or recorded.received_ns >= end:
                    return
                if ports is None or recorded.port in ports:
                    yield recorded

    def last(self, ports: Collection[str], moment: int) -> list[Recorded]:
        """Return the last message of each port that is not after that time."""
        found: dict[str, Recorded] = {}
        with self._lock:
            at = bisect_right(self._times, moment, self._gone)
            some = self._held[max(self._gone, at - _BACK) : at]
        for recorded in reversed(some):
            if recorded is not None and recorded.port in ports:
                found.setdefault(recorded.port, recorded)
                if len(found) == len(ports):
                    break
        return [*found.values()]

    def moments(self) -> tuple[list[str], array[int]]:
        """Return the ports and the times of all messages."""
        with self._lock:
            some = self._held[self._gone :]
            times = self._times[self._gone :]
        return [one.port for one in some if one is not None], times

    def notes(self) -> list[dict[str, Any]]:
        """Return what was noted."""
        with self._lock:
            return list(self._noted)

    def close(self) -> None:
        """Nothing is open."""


class LiveSource:
    """The last `keep` seconds of the ports that are `wanted`, until `close`. Raises AddressError,
    NoNameServer."""

    live = True

    def __init__(
        self,
        wanted: PortSelection,
        keep: float = KEEP,
        *,
        memory: int = MEMORY,
        carrier: str = "",
        names: NameClient | None = None,
        tell: Callable[[str], object] = lambda line: None,
    ) -> None:
        self._keep = round(keep * SECOND)
        self._ring = Ring(keep, memory)
        self._recording = Recording([self._ring])
        self._port = open_port("", self._ring.put, self._connection, names, "/view")
        self._subscriptions = Subscriptions(self._port, wanted, carrier, names, tell)

    def _connection(self, event: ConnectionEvent) -> None:
        if event.incoming:
            word = "connected" if event.created else "disconnected"
            self._ring.note(word, port=event.source)

    def at(self, offset: float) -> Self:
        """Return it: nothing stands beside it."""
        return self

    @property
    def title(self) -> str:
        """Return what people call it."""
        return f"the last {self._keep / SECOND:g} s"

    @property
    def begin(self) -> int:
        """Return when it begins."""
        return self._ring.begin

    @property
    def end(self) -> int:
        """Return when it ends, so far."""
        return self._ring.end

    @property
    def kinds(self) -> dict[str, str]:
        """Return the ports that something came from."""
        return {name: facts.kinds[0] for name, facts in self._ring.ports.items()}

    def open(self) -> Recording:
        """Return the messages."""
        return self._recording

    def before(self, recording: Recording, ports: Collection[str], time: int) -> list[Recorded]:
        """Return the last message of each port that is not after that time."""
        return self._ring.last(ports, time)

    def attachment(self, name: str) -> bytes:
        """Raise KeyError: what is live was given no files."""
        raise KeyError(name)

    def told(self) -> dict[str, Any]:
        """Return what the time line of a page shows."""
        ports, times = self._ring.moments()
        overview = Overview(times[0] if times else self._ring.begun, times[-1] if times else 0)
        for port, moment in zip(ports, times, strict=True):
            overview.add(port, moment)
        counts = {name: row.messages for name, row in overview.rows.items()}
        notes = [note for note in self._ring.notes() if int(note["time_ns"]) >= overview.begin]
        found = timeline(self, overview, counts, notes)
        lost = self._ring.lost
        problem = f"{lost} messages could not be kept" if lost else ""
        return {**found, "seen": 1.0, "problem": problem}

    def close(self) -> None:
        """Close the port."""
        self._subscriptions.close()
        self._port.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()
