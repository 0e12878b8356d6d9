"""Files of recordings beside what the machine has: plain system calls, and the library `mcap`.

Rules: all sides of a ratio take turns in one folder, with the same bytes. Part of `record.py`.
"""

import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from yarpy import record
from yarpy.data import codec
from yarpy.kits.record.mcap.reader import McapFile
from yarpy.kits.record.mcap.writer import CHUNK_SIZE, McapWriter
from yarpy.kits.record.report import report

LARGE = 6 << 20  # bytes of a large message
GREAT = 100 << 30  # bytes of a file of which `yarpy info` is asked


def large(folder: Path, total: int, rounds: int) -> list[str]:
    """Return rows: large messages written and read."""
    payload = os.urandom(LARGE)
    count = max(total // LARGE, 1)
    plain, ours, theirs = (folder / name for name in ("plain", "ours", "theirs"))

    def write_plain() -> None:
        with open(plain, "wb", buffering=0) as file:
            for _ in range(count):
                file.write(payload)
            os.fsync(file.fileno())

    def write_ours() -> None:
        ours.unlink(missing_ok=True)
        with McapWriter(ours) as writer:
            for number in range(count):
                writer.add("/cam", f"{number} 1", time.time_ns(), payload)

    def read_plain() -> None:
        buffer = bytearray(LARGE)
        with open(plain, "rb", buffering=0) as file:
            while file.readinto(buffer):
                pass

    written = _turns(rounds, write_plain, write_ours, lambda: _write(theirs, count, payload))
    read = _turns(rounds, read_plain, lambda: _read(ours, count), lambda: _read_mcap(ours, count))
    for path in (plain, ours, theirs):
        path.unlink()
    return [
        _large("large messages written, synced", count * LARGE, written, "plain writes"),
        _large("reading them, checked", count * LARGE, read, "plain reads without a check"),
    ]


def small(folder: Path, count: int, rounds: int) -> list[str]:
    """Return rows: small messages, one by one."""
    payload = b"".join(map(bytes, codec.encode([1, 2.5, 3.5, 4.5])))
    ours, theirs = folder / "ours", folder / "theirs"

    def write_ours() -> None:
        ours.unlink(missing_ok=True)
        with McapWriter(ours) as writer:
            for number in range(count):
                writer.add(f"/p{number % 50}", f"{number} 1.5", time.time_ns(), payload)

    written = _turns(rounds, write_ours, lambda: _write(theirs, count, payload, 50))
    read = _turns(rounds, lambda: _read(ours, count), lambda: _read_mcap(ours, count))
    for path in (ours, theirs):
        path.unlink()
    return [
        f"| a small message {word} | {statistics.median(times[0]) / count * 1e6:.1f} us "
        f"| {_ratio(times[1], times[0]):.2f} x as fast as the library mcap |"
        for word, times in (("written", written), ("read", read))
    ]


def asking(folder: Path, size: int, rounds: int) -> str:
    """Return a row: `yarpy info` of a file with as many chunks as one of `size` bytes has."""
    path = folder / "chunks"
    payload = b"".join(map(bytes, codec.encode([1, 2.5])))
    with McapWriter(path) as writer:
        for number in range(max(size // CHUNK_SIZE, 1)):
            writer.add("/state:o", f"{number} 1.5", time.time_ns(), payload)
            writer.flush()

    def ask() -> None:
        with record.open(path) as recording:
            report(recording)

    def ask_mcap() -> None:
        with path.open("rb") as file:
            make_reader(file).get_summary()

    ours, theirs = _turns(rounds, ask, ask_mcap)
    path.unlink()
    return (
        f"| `info`, with the chunks of {size / 2**30:.0f} GB | {statistics.median(ours):.2f} s "
        f"| {_ratio(theirs, ours):.2f} x as fast as the library mcap |"
    )


def _write(path: Path, count: int, payload: bytes, topics: int = 1) -> None:
    """Write with the library."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start()
        channels = [writer.register_channel(f"/p{one}", "yarp", 0) for one in range(topics)]
        for number in range(count):
            now = time.time_ns()
            writer.add_message(channels[number % topics], now, payload, now, number)
        writer.finish()
        file.flush()
        os.fsync(file.fileno())


def _read(path: Path, count: int) -> None:
    with McapFile(path) as found:
        assert sum(1 for _ in found.records()) == count


def _read_mcap(path: Path, count: int) -> None:
    """Read with the library, which has checked nothing unless it is asked to."""
    with path.open("rb") as file:
        assert sum(1 for _ in make_reader(file, validate_crcs=True).iter_messages()) == count


def _turns(rounds: int, *sides: Callable[[], object]) -> list[list[float]]:
    """Return the seconds of each side in each round."""
    times: list[list[float]] = [[] for _ in sides]
    for _ in range(rounds):
        for side, all_ in zip(sides, times, strict=True):
            began = time.perf_counter()
            side()
            all_.append(time.perf_counter() - began)
    return times


def _ratio(others: list[float], ours: list[float]) -> float:
    """Return how many times as fast as others we are, of turns that belong together."""
    return statistics.median(one / our for one, our in zip(others, ours, strict=True))


def _large(name: str, size: int, times: list[list[float]], plain: str) -> str:
    first, ours, theirs = times
    return (
        f"| {name} | {size / statistics.median(ours) / 1e9:.2f} GB/s "
        f"| {_ratio(first, ours):.0%} of {plain}, {_ratio(theirs, ours):.1f} x the library mcap |"
    )
