"""What a recorder costs, how fast files are written and read, and how punctual a player is.

`yarpy record` is a program of its own, and so are the senders; what it costs is the processor time
of its process. A disk is compared with what plain `write` calls do in the same folder, in turns.

    python bench/record.py [--folder /dev/shm] [--seconds 10] [--ports 50] [--size 1920x1080]
"""

import argparse
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import yarpy
from yarpy import record
from yarpy.data import codec
from yarpy.kits.record.mcap.reader import McapFile
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.report import report

SENDER = """
import sys, time, numpy, yarpy
count, rate, width, height = map(int, sys.argv[1:])
if width:
    values = [yarpy.Image(numpy.zeros((height, width, 3), "u1"))]
else:
    values = [[1, 2.5, 3.5, 4.5]]
ports = [yarpy.Port(f"/bench/{number}") for number in range(count)]
for port in ports:
    port.wait_for_outputs(timeout=60)
print("ready", flush=True)
n, due = 0, time.perf_counter()
while True:
    for port in ports:
        port.write(values[0], yarpy.Stamp(n, time.time()))
    n, due = n + 1, due + 1 / rate
    time.sleep(max(0.0, due - time.perf_counter()))
"""
LARGE = 6 << 20  # bytes of a large message
WRITTEN = 1 << 30  # bytes that are written and read


def recorded(folder: Path, ports: int, rate: int, size: tuple[int, int], seconds: float) -> str:
    """A row: what a recorder costs that takes these ports for a while."""
    path = folder / f"load{ports}.mcap"
    words = ["record", "-e", "^/bench/", "--json", "-o", str(path)]
    sender = [sys.executable, "-c", SENDER, *map(str, (ports, rate, *size))]
    with _program([sys.executable, "-m", "yarpy", *words]) as recorder, _program(sender) as sends:
        assert sends.stdout is not None
        sends.stdout.readline()
        time.sleep(1.0)
        before, began = _used(recorder.pid), time.perf_counter()
        time.sleep(seconds)
        used = (_used(recorder.pid) - before) / (time.perf_counter() - began)
        recorder.send_signal(signal.SIGINT)
        recorder.wait()
    with record.open(path) as found:
        told = report(found)
    passed = told.end - told.begin
    written = sum(file["bytes"] for file in told.files)
    lost = sum(port.lost for port in told.ports)
    path.unlink()
    return (
        f"| {told.messages / passed:.0f} messages, {written / passed / 1e6:.1f} MB a second "
        f"from {len(told.ports)} ports | {100 * used:.0f} % of a core | {lost} lost |"
    )


def speeds(folder: Path, total: int, rounds: int) -> str:
    """A table: writing and reading large messages, beside plain system calls."""
    payload = os.urandom(LARGE)
    count = max(total // LARGE, 1)
    plain, ours, reading, asking = [], [], [], []
    for _ in range(rounds):
        path = folder / "plain"
        began = time.perf_counter()
        with open(path, "wb", buffering=0) as file:
            for _ in range(count):
                file.write(payload)
            os.fsync(file.fileno())
        plain.append(count * LARGE / (time.perf_counter() - began))
        path.unlink()
        path = folder / "ours.mcap"
        began = time.perf_counter()
        with McapWriter(path) as writer:
            for number in range(count):
                writer.add("/cam", f"{number} 1", time.time_ns(), payload)
        ours.append(count * LARGE / (time.perf_counter() - began))
        began = time.perf_counter()
        with McapFile(path) as found:
            size = sum(len(one.data) for one in found.records())
        reading.append(size / (time.perf_counter() - began))
        began = time.perf_counter()
        with record.open(path) as recording:
            report(recording)
        asking.append(time.perf_counter() - began)
        path.unlink()
    rows = [
        ("plain writes, synced", plain, 1e9, "GB/s"),
        ("a recording, synced", ours, 1e9, "GB/s"),
        ("reading it, checked", reading, 1e9, "GB/s"),
        ("yarpy info of it", asking, 1e-3, "ms"),
    ]
    lines = [
        f"| {name} | {statistics.median(all_) / unit:.2f} {word} |"
        for name, all_, unit, word in rows
    ]
    share = statistics.median(one / other for one, other in zip(ours, plain, strict=True))
    return "\n".join([*lines, f"| of the speed of plain writes | {100 * share:.0f} % |"])


def small(folder: Path, count: int) -> str:
    """Rows: small messages, one by one."""
    payload = b"".join(map(bytes, codec.encode([1, 2.5, 3.5, 4.5])))
    path = folder / "small.mcap"
    began = time.perf_counter()
    with McapWriter(path) as writer:
        for number in range(count):
            writer.add(f"/p{number % 50}", f"{number} 1.5", time.time_ns(), payload)
    writing = time.perf_counter() - began
    began = time.perf_counter()
    with McapFile(path) as found:
        assert sum(1 for _ in found.records()) == count
    reading = time.perf_counter() - began
    path.unlink()
    return (
        f"| a small message written | {writing / count * 1e6:.1f} us |\n"
        f"| a small message read | {reading / count * 1e6:.1f} us |"
    )


def punctual(folder: Path, seconds: float) -> str:
    """A row: how late messages are played, 1000 a second."""
    path = folder / "play.mcap"
    begin = time.time_ns()
    with McapWriter(path) as writer:
        for number in range(round(seconds * 1000)):
            writer.add("/bench/played", f"{number} 1", begin + number * 10**6, b"\0\1\0\0\0\0\0\0")
    times: list[float] = []
    with (
        record.open(path) as recording,
        yarpy.BufferedPort("/bench/reader", callback=lambda m: times.append(time.perf_counter())),
        record.Player(recording) as player,
    ):
        yarpy.connect("/bench/played", "/bench/reader", "tcp")
        began = time.perf_counter()
        player.play()
        time.sleep(0.2)
    path.unlink()
    late = sorted(at - began - number / 1000 for number, at in enumerate(times))
    half, most = (f"{late[int((len(late) - 1) * part)] * 1e3:.2f} ms" for part in (0.5, 0.99))
    return f"| {len(times)} messages played, 1000 a second | late by {half}, p99 {most} |"


@contextmanager
def _program(words: list[str]) -> Iterator["subprocess.Popen[str]"]:
    program = subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=os.environ
    )
    try:
        yield program
    finally:
        program.kill()
        program.communicate()


def _used(process: int) -> float:
    """Seconds of processor time of a program."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    asked = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    asked.add_argument("--folder", type=Path)
    asked.add_argument("--seconds", type=float, default=10.0)
    asked.add_argument("--ports", type=int, default=50)
    asked.add_argument("--size", default="1920x1080")
    asked.add_argument("--bytes", type=int, default=WRITTEN)
    asked.add_argument("--rounds", type=int, default=3)
    options = asked.parse_args()
    width, height = map(int, options.size.split("x"))
    with tempfile.TemporaryDirectory(dir=options.folder) as name, yarpy.NameServer() as server:
        os.environ.update(server.environment)
        folder = Path(name)
        print("| recorded | costs | |\n|---|---|---|")
        print(recorded(folder, options.ports, 100, (0, 0), options.seconds))
        print(recorded(folder, 1, 30, (width, height), options.seconds))
        print("\n| | |\n|---|---|")
        print(speeds(folder, options.bytes, options.rounds))
        print(small(folder, 20_000))
        print(punctual(folder, min(options.seconds, 10.0)))


if __name__ == "__main__":
    main()
