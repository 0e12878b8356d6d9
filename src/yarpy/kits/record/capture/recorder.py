"""Recorder: a port that takes what others send, and a thread that writes it into files.

    with record.Recorder("/icub/cam/left", "/icub/head/state:o", path="walk") as recorder:
        time.sleep(60)
    print(recorder.files, recorder.lost)

Rules: nothing that a disk does reaches the ports: what does not fit into the memory is lost and
counted. What came is in the system's hands half a second later, and on the disk after another one,
so a kill or a power cut costs no more than a second or so. Whatever is odd is noted in the file.
"""

from __future__ import annotations

import json
import math
import platform
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final, Self

from yarpy import __version__, linger
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.capture.batch import Batch
from yarpy.kits.record.capture.clock_step import SystemClock
from yarpy.kits.record.capture.disk_space import DiskSpace, Split, size_text
from yarpy.kits.record.capture.loss import Losses
from yarpy.kits.record.capture.notes import Notes
from yarpy.kits.record.capture.opening import open_port, without_ending
from yarpy.kits.record.capture.output import Output, contents
from yarpy.kits.record.capture.queue import MEMORY, Count, MessageQueue
from yarpy.kits.record.capture.ring_buffer import RingBuffer
from yarpy.kits.record.capture.subscriptions import PortSelection, Subscriptions
from yarpy.kits.record.sink import Format, Opener
from yarpy.link.begin.handshake import find_carrier
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.connection import ConnectionEvent
from yarpy.route import parse_carrier
from yarpy.scope import Flag

log = logger("yarpy.record")

PERIOD: Final = 0.05  # seconds between looks at what has come
SYNC: Final = 0.5  # seconds between the ends of waiting for the disk


class Recorder:
    """Records from the moment it is made until it is closed.

    ports: names, recorded as soon as they are there.
    every, pattern, exclude: which other ports are recorded; regular expressions that are searched
    for in names. Ports of rpc are left out, but for those that are named.
    path: where to, without an ending; by default the date. The file is `path`.mcap.
    format: "mcap", "dumper" for the folders of C++ yarpdatadumper in `path`, "both"; or a function
    that begins a file or folder of another kind at a path, see `SingleFolder`.
    compression: "none", "lz4", "zstd".
    split, most: when a new file begins (`Split(bytes=10**9)`), and how many are kept, 0 for all.
    memory: bytes of messages that may wait for the disk.
    rates: the largest number of messages a second, by patterns of names: `{"/cam/*": 10}`.
    newest: patterns of ports of which older messages make way for newer ones where memory is full.
    snapshot: write nothing but the last so many seconds, when `snapshot` is called; `memory` bounds
    them, too. triggers: regular expressions by ports, which are recorded, too: a match calls it.
    paused: take nothing before `resume`, with which the recording begins.
    attach: files that are kept within each MCAP file: the application, definitions of types.
    carrier: how the ports are connected, else as `yarpy.connect` does.
    name: of its own port. names: a name client, None for the default.
    tell: called with a line for people when something is to be known.
    room: the disk, for tests. now: the clock of all times in the files, in nanoseconds.
    Raises FileExistsError, OSError; UnknownPlugin for a carrier that nobody has, and without the
    library `mcap`; LocalProtocolError, AddressError, NoNameServer.
    """

    def __init__(
        self,
        *ports: str,
        every: bool = False,
        pattern: str = "",
        exclude: str = "",
        path: str | Path | None = None,
        format: Format | Opener = "mcap",
        compression: str = "none",
        split: Split | None = None,
        most: int = 0,
        memory: int = MEMORY,
        rates: Mapping[str, float] | None = None,
        newest: Sequence[str] = (),
        snapshot: float = 0.0,
        triggers: Mapping[str, str] | None = None,
        paused: bool = False,
        attach: Sequence[str | Path] = (),
        carrier: str = "",
        name: str = "",
        names: NameClient | None = None,
        tell: Callable[[str], object] = log.warning,
        room: DiskSpace | None = None,
        now: Callable[[], int] = time.time_ns,
    ) -> None:
        find_carrier(parse_carrier(carrier))
        named = tuple(dict.fromkeys((*ports, *(triggers or ()))))
        wanted = PortSelection(named, every, pattern, exclude)
        self._now = now
        self.memory = memory  # bytes of messages, at most
        self._ring = None
        if snapshot:
            self._ring = RingBuffer(snapshot, memory - memory // 4, triggers or {})
            memory //= 4
        elif triggers:
            raise LocalProtocolError("triggers are for snapshots: say how many seconds")
        attached = contents(attach)
        self._queue = MessageQueue(memory, rates, now, newest)
        self._queue.paused = paused
        self._tell = tell
        self._facts = {
            "host": platform.node(),
            "system": platform.platform(),
            "yarpy": __version__,
            "clock": "system" if now is time.time_ns else "network",
            "wanted": json.dumps({"ports": ports, "every": every, "pattern": pattern}),
        }
        self._notes = Notes(now, begun=not paused)
        self._losses = Losses(self._queue.counts)
        self._wishes: deque[Callable[[], None]] = deque()
        self._closing = threading.Event()
        self.ended = Flag()
        self.failure = ""
        where = without_ending(path)
        self._disk = room or DiskSpace(where.parent)
        self._port = open_port(name, self._queue.put, self._connection, names)
        try:
            self._output = Output(
                where, compression, split, most, lambda: self._facts, self._losses.of_file,
                format, self._ring is not None, attached,
            )  # fmt: skip
        except BaseException:
            self._port.close()
            raise
        self._writing = threading.Thread(target=self._write, name="yarpy record", daemon=True)
        self._syncing = threading.Thread(target=self._sync, name="yarpy sync", daemon=True)
        self._writing.start()
        self._syncing.start()
        self._subscriptions = Subscriptions(self._port, wanted, carrier, names, tell)
        linger.add(self, self.close)

    # -- what people want to know ------------------------------------------------------------------

    @property
    def name(self) -> str:
        """Return the name of its port: what is connected to it is recorded."""
        return self._port.name

    @property
    def files(self) -> list[Path]:
        """Return the files that were written and are kept."""
        return [*self._output.files]

    @property
    def size(self) -> int:
        """Return how many bytes were written."""
        return self._output.size

    @property
    def held(self) -> int:
        """Return how many bytes are in memory."""
        return self._queue.held + (self._ring.held if self._ring else 0)

    @property
    def free(self) -> int:
        """Return how many bytes are free on the disk, as of the last second."""
        return self._disk.free

    @property
    def counts(self) -> dict[str, Count]:
        """Return what came from each port, and what did not."""
        return dict(self._queue.counts)

    @property
    def messages(self) -> int:
        """Return how many messages were taken."""
        return sum(count.messages for count in self.counts.values())

    @property
    def lost(self) -> int:
        """Return how many messages came and could not be kept."""
        return sum(count.lost for count in self.counts.values())

    @property
    def state(self) -> str:
        """Return recording, paused, or keeping: in memory, for snapshots."""
        if self.paused:
            return "paused"
        return "recording" if self._ring is None else "keeping"

    @property
    def snapshots(self) -> bool:
        """Return whether nothing is written but when `snapshot` is called."""
        return self._ring is not None

    @property
    def connected(self) -> set[str]:
        """Return the ports that are connected."""
        return {link.source for link in self._port.inputs}

    @property
    def waiting(self) -> list[str]:
        """Return the named ports that are not connected."""
        return self._subscriptions.waiting

    @property
    def paused(self) -> bool:
        """Return whether messages are ignored."""
        return self._queue.paused

    # -- what people want --------------------------------------------------------------------------

    def pause(self) -> None:
        """Ignore what comes, until `resume`."""
        if not self.paused:
            self._queue.paused = True
            self._notes.add("pause")

    def resume(self) -> None:
        """Take messages again."""
        if self.paused:
            self._notes.add("resume")
            self._notes.begin()
            self._queue.paused = False

    def mark(self, text: str = "", ago: float = 0.0) -> None:
        """Note something about this moment, or one that was so many seconds ago."""
        self._notes.add("mark", round(ago * 1e9), text=text[:10_000])

    def split(self) -> None:
        """Go on in a new file. Raises LocalProtocolError where only snapshots are written."""
        if self._ring is not None:
            raise LocalProtocolError("only snapshots are written: snapshot begins a file")
        self._wishes.append(self._output.split)
        self._queue.wake()

    def snapshot(self, why: str = "asked for") -> None:
        """Write the last seconds into a new file. Raises LocalProtocolError if all is recorded."""
        ring = self._ring
        if ring is None:
            raise LocalProtocolError("everything is recorded: snapshots take --snapshot SECONDS")
        self._notes.add("snapshot", why=why)
        self._wishes.append(lambda: ring.save(self._output, self._queue))
        self._queue.wake()

    # -- what comes --------------------------------------------------------------------------------

    def _connection(self, event: ConnectionEvent) -> None:
        if event.incoming and event.created:
            self._queue.forget(event.source)
        if event.incoming and not self._closing.is_set():
            self._notes.add(
                "connected" if event.created else "disconnected",
                port=event.source,
                carrier=event.carrier,
                **({"reason": event.reason} if event.reason else {}),
            )

    # -- the thread that writes --------------------------------------------------------------------

    def _write(self) -> None:
        try:
            self._write_on()
        except OSError as error:
            self._end(f"{self._output.path} cannot be written: {error.strerror or error}")
        except Exception as error:
            log.exception("the recorder fails on a defect")
            self._end(f"{type(error).__name__}: {error}")
        finally:
            try:
                self._output.close()
            except OSError as error:
                self._end(f"{self._output.path} cannot be finished: {error.strerror or error}")
            self.ended.set()

    def _end(self, why: str) -> None:
        """Stop by ourselves."""
        if not self.failure:
            self.failure = why
            self._queue.paused = True
            self._tell(why)

    def _write_on(self) -> None:
        queue, batch = self._queue, Batch(self._queue, self._output)
        looked, written, clock = 0.0, 0, SystemClock()
        self._disk.look()
        try:
            while not self.failure:
                queue.wait(PERIOD)
                if last := self._closing.is_set():
                    self._notes.begin()
                self._gather(batch)
                if last or batch.due:
                    batch.flush()
                while self._wishes:
                    self._gather(batch)  # what came before it was asked for
                    batch.flush()
                    self._wishes.popleft()()
                now = time.monotonic()
                # A disk that may be full before a second is over is looked at sooner.
                if now - looked >= 1.0 or self._output.size - written > self._disk.free // 4:
                    looked, written = now, self._output.size
                    self._look_around(clock, batch)
                if last:
                    self._losses.tell(self._output.note, self._tell, self._now())
                    return
            batch.flush()  # a disk that is nearly full takes what was on its way
        finally:
            batch.lose()
            # What comes between the failure and the end is not written either.
            for queued in queue.end():
                queue.lose(queued)
                queue.free(queued.size)

    def _gather(self, batch: Batch) -> None:
        """Take what has come. Raises OSError."""
        queue, ring = self._queue, self._ring
        waiting = deque(queue.take())
        while waiting:
            queued = waiting.popleft()
            if ring is None:
                try:
                    batch.add(queued)
                except OSError:
                    for rest in waiting:
                        queue.lose(rest)
                        queue.free(rest.size)
                    raise
                continue
            batch.count_missed(queued)
            queue.free(queued.size)
            if ring.add(queued):
                self._tell(f"a message of {queued.port} is written, with what was before it")
                self.snapshot(f"a message of {queued.port}")
        for note in self._notes.take():
            if ring is None:
                self._output.note(*note)
                batch.begin()
            else:
                ring.note(*note)

    def _look_around(self, clock: SystemClock, batch: Batch) -> None:
        """Look once a second at the disk, the folder, the clock, and what was lost."""
        self._losses.tell(self._output.note, self._tell, self._now())
        before, state = self._disk.state, self._disk.look()
        if state == "full":
            self._end(f"the disk is full but for {size_text(self._disk.free)}: recording stops")
        elif state and state != before:
            self._notes.add("disk low", free=self._disk.free)
            self._tell(f"{size_text(self._disk.free)} are left on the disk")
        if self._output.gone:
            gone = self._output.path
            self._output.leave()
            batch.again()
            self._notes.add("file gone", file=str(gone))
            self._tell(f"{gone} was taken away with all in it: the rest is in {self._output.path}")
        if seconds := clock.look():
            self._notes.add("clock set", seconds=seconds)
            self._tell(f"the clock was set by {seconds:+.1f} s")

    def _sync(self) -> None:
        while not self.ended.wait(SYNC):
            with suppress(OSError):  # the thread that writes meets it, too
                self._output.sync()

    # -- the end -----------------------------------------------------------------------------------

    def close(self, timeout: float | None = None) -> None:
        """Write what has come, and finish the file. What could not be written is in `failure`.

        timeout: seconds that all of it may take, None: as many as the disk needs. It may be called
        again, and goes on where Ctrl-C has cut it short.
        """
        until = math.inf if timeout is None else time.monotonic() + timeout
        if not self._closing.is_set():
            self._subscriptions.close(_left(until, 1 / 4))
            self._port.close(_left(until, 1 / 2))
            self._closing.set()
        self._queue.wake()
        for thread in (self._writing, self._syncing):
            thread.join(_left(until))
        if self._writing.is_alive():
            self._end(f"{self._output.path} is not finished: the disk takes too long")
        linger.remove(self)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def _left(until: float, share: float = 1.0) -> float | None:
    """Return that share of the seconds until a moment of `time.monotonic()`; None without one."""
    return None if until == math.inf else max(0.0, until - time.monotonic()) * share
