"""Interrupt `read()` at random moments and read on: what is lost, and does the connection live?

    python tests/life/interrupting.py [INTERRUPTS [CARRIER [READER [SIZE [RATE]]]]]

A writer in another process sends numbered messages; a timer of this process (SIGALRM) raises in the
reader at random moments. A message is lost if its number never comes and nobody counts it. Each
combination prints one line; without arguments all of them share 10 000 interrupts.
"""

from __future__ import annotations

import contextlib
import random
import signal
import subprocess
import sys
import time
import weakref
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

from support.wait import HANG

from yarpy.errors import Timeout
from yarpy.link.receive.inbound import Inbound
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import BufferedPort, MessagePort, Port

CARRIERS = ("tcp", "fast_tcp", "memory", "unix_stream", "udp")
READERS = ("strict", "plain", "buffered")
SIZES = (100, 100_000)
RATES = ("flood", "2000", "100")
READ = MessagePort.read.__code__
#: What Python runs when it collects what a set or a dictionary refers to weakly.
WEAK = {weakref.__file__, weakref.WeakSet.__init__.__code__.co_filename}
DROPS = {"__del__", "gc_callback"}  # the latter is Hypothesis', which counts time of collections
SILENT = 30.0  # seconds without a message after which a connection is wedged, on any machine


class Interrupted(TimeoutError):
    """What the signal raises: of the errors that handlers raise, the one that is most easily taken
    for another."""


@dataclass
class Outcome:
    """What became of one run. `gaps`: numbers that never came; `swallowed`: interrupts that did not
    come out of `read`; `ended`: connections that were made again."""

    interrupts: int = 0
    messages: int = 0
    twice: int = 0
    gaps: int = 0
    wedged: int = 0
    swallowed: int = 0
    ended: int = 0

    def __str__(self) -> str:
        return "  ".join(f"{value} {name}" for name, value in vars(self).items())


class Alarm:
    """A timer whose signal raises Interrupted once, wherever `read` is, while `armed`. Where Python
    drops what is raised, when it collects garbage just then, the signal comes again."""

    def __init__(self) -> None:
        self.armed = False
        self.raised = 0
        self._before = signal.signal(signal.SIGALRM, self._ring)

    def _ring(self, number: int, frame: FrameType | None) -> None:
        dropped = False
        while frame is not None and frame.f_code is not READ:
            code = frame.f_code
            dropped = dropped or code.co_name in DROPS or code.co_filename in WEAK
            frame = frame.f_back
        if frame is None or dropped:
            self.set(1e-4)
        elif self.armed:
            self.armed = False
            self.raised += 1
            raise Interrupted

    def set(self, seconds: float) -> None:
        signal.setitimer(signal.ITIMER_REAL, seconds)

    def close(self) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, self._before)


class Source:
    """A writer in a process of its own."""

    def __init__(self, *words: str) -> None:
        path = Path(__file__).with_name("writing.py")
        self._process = subprocess.Popen([sys.executable, str(path), *words], stdin=subprocess.PIPE)

    def close(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        try:
            self._process.wait(3)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def interrupt_reader(
    carrier: str, reader: str, size: int, rate: str, interrupts: int, seed: int = 1
) -> Outcome:
    """Interrupt a reader so often."""
    outcome, chance, alarm, names = Outcome(), random.Random(seed), Alarm(), LocalNames()
    try:
        while alarm.raised < interrupts:  # again when a connection is wedged
            with (
                make(reader, names) as in_,
                contextlib.closing(Source(in_.address, carrier, str(size), rate)),
            ):
                _read_on(in_, alarm, outcome, interrupts, chance, reader != "buffered")
    finally:
        alarm.close()
    outcome.interrupts = alarm.raised
    outcome.swallowed += alarm.raised
    return outcome


def make(reader: str, names: LocalNames) -> Port | BufferedPort:
    """A port of that kind."""
    if reader == "plain":
        return Port("/in", names=names)
    return BufferedPort("/in", names=names, strict=reader == "strict")


def source_of(port: Port | BufferedPort) -> Inbound | None:
    """The connection that brings the messages."""
    found = [link for link in port._hub.inputs.links if link.route.source != "admin"]
    return found[0] if found else None


def _read_on(
    in_: Port | BufferedPort,
    alarm: Alarm,
    outcome: Outcome,
    interrupts: int,
    chance: random.Random,
    complete: bool,
) -> None:
    """Read until there were enough interrupts, or nothing comes any more."""
    in_.wait_for_inputs(timeout=HANG)
    link, last = source_of(in_), -1
    while alarm.raised < interrupts:
        try:
            message = in_.read(timeout=None if alarm.armed else SILENT)
        except Interrupted:
            outcome.swallowed -= 1
            continue
        except Timeout:
            outcome.wedged += 1
            return
        if not alarm.armed:  # it lives; again, from once in a while to each read
            alarm.armed = True
            alarm.set(chance.choice((1e-4, 1e-3, 5e-3)) * chance.uniform(0.1, 1.0))
        now = source_of(in_)
        if now is not None and now is not link:
            link, last = now, -1
            outcome.ended += 1
        number = message.value[0]
        outcome.messages += 1
        if last >= 0:
            outcome.twice += number <= last
            outcome.gaps += complete * max(0, number - last - 1)
        last = number


def main() -> None:
    words = sys.argv[1:]
    total = int(words[0]) if words else 10_000
    runs = [
        (carrier, reader, size, rate)
        for carrier in (words[1:2] or CARRIERS)
        for reader in (words[2:3] or READERS)
        for size in ([int(words[3])] if words[3:4] else SIZES)
        for rate in (words[4:5] or RATES)
    ]
    each = -(-total // len(runs))
    whole = Outcome()
    for run in runs:
        started = time.monotonic()
        outcome = interrupt_reader(*run, each, seed=hash(run) & 0xFFFF)
        print(*run, f"{time.monotonic() - started:.0f} s:", outcome, flush=True)
        for name, value in vars(outcome).items():
            setattr(whole, name, getattr(whole, name) + value)
    print("all:", whole)


if __name__ == "__main__":
    main()
