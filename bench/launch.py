"""The cost of `yarpy up`: starting many programs, watching, starting one again; and `yarpy log`.

`yarpy up` is a program of its own, with a name server and a folder of sockets of its own. Its
programs are `sleep`, so that what is measured is not theirs; starting them without it is beside.

    python bench/launch.py [--programs 100 200] [--watch 20] [--kills 10] [--lines 50000]
"""

import argparse
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yarpy
from yarpy.errors import YarpError
from yarpy.kits.launch.console import control
from yarpy.kits.launch.log.collector import LogCollector

SLEEP = ["sleep", "100000"]
SENDER = """
import logging, sys, time, yarpy
rate, seconds = int(sys.argv[1]), float(sys.argv[2])
log = logging.getLogger("bench")
log.setLevel(logging.INFO)
log.propagate = False
log.addHandler(logging.NullHandler())
with yarpy.Port("..."):
    log.info("it connects")
    time.sleep(2)  # ... meanwhile
    begun, used, sent = time.time(), time.process_time(), 0
    while (passed := time.time() - begun) < seconds:
        for sent in range(sent, int(rate * passed)):
            log.info("a small line, number %d", sent)
        sent = max(sent, int(rate * passed))
        time.sleep(0.002)
    print(sent, sent / (time.time() - begun), 1e6 * (time.process_time() - used) / sent)
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=int, nargs="*", default=[100, 200])
    parser.add_argument("--watch", type=float, default=20.0, help="seconds")
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--lines", type=int, default=50_000, help="a second")
    parser.add_argument("--seconds", type=float, default=5.0, help="of lines")
    options = parser.parse_args()
    load = "load {:.1f} {:.1f} {:.1f}".format(*os.getloadavg())
    print(f"{os.cpu_count()} processors, {load}\n")
    print("| | |\n|---|---|")
    with tempfile.TemporaryDirectory(prefix="yarpy-bench-") as place, yarpy.NameServer() as server:
        os.environ.update(server.environment, YARP_RUNTIME_DIR=place)
        for count in options.programs:
            many(Path(place), count, options.watch, options.kills)
        for count in (1, 10):
            print(logged(count, options.lines, options.seconds), flush=True)


def many(place: Path, count: int, seconds: float, kills: int) -> None:
    """Rows: so many programs started, watched, killed and stopped."""
    alone = started_alone(count)
    begun = time.perf_counter()
    with up(place, count, screen=False) as process:
        row(f"{count} programs run", f"{time.perf_counter() - begun:.2f} s; alone {alone:.2f} s")
        row(f"watching {count}, lines", f"{used(process.pid, seconds):.1f} % of a core")
        if kills:
            took = [restarted(f"p{number % count}") for number in range(kills)]
            most = f"median {statistics.median(took):.2f} s, longest {max(took):.2f} s"
            row(f"one of {count} killed {kills} times runs again", most)
        begun = time.perf_counter()
        process.send_signal(signal.SIGINT)
        process.wait()
        row(f"{count} stopped", f"{time.perf_counter() - begun:.2f} s")
    with up(place, count, screen=True) as process:
        row(f"watching {count}, on a screen", f"{used(process.pid, seconds):.1f} % of a core")


def row(name: str, value: str) -> None:
    print(f"| {name} | {value} |", flush=True)


def started_alone(count: int) -> float:
    """Return the seconds that the programs take to start without anybody who watches them."""
    begun = time.perf_counter()
    programs = [subprocess.Popen(SLEEP, start_new_session=True) for _ in range(count)]
    took = time.perf_counter() - begun
    for program in programs:
        program.kill()
    for program in programs:
        program.wait()
    return took


@contextmanager
def up(place: Path, count: int, screen: bool) -> Iterator["subprocess.Popen[bytes]"]:
    """`yarpy up` of so many programs, once all of them run; on a terminal, or with lines."""
    file = place / "many.toml"
    programs = "".join(f"p{number} = '{' '.join(SLEEP)}'\n" for number in range(count))
    file.write_text(f'name = "many"\n[programs]\n{programs}')
    reading, writing = os.openpty() if screen else os.pipe()
    drain = threading.Thread(target=_drain, args=(reading,), daemon=True)
    drain.start()
    words = [sys.executable, "-m", "yarpy", "up", str(file)]
    process = subprocess.Popen(words, stdout=writing, start_new_session=True)
    os.close(writing)
    try:
        while not all(one["state"] == "running" for one in programs_of()):
            if process.poll() is not None:
                raise SystemExit(f"yarpy up has ended with {process.returncode}")
            time.sleep(0.01)
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()
        drain.join()
        os.close(reading)


def _drain(reading: int) -> None:
    try:
        while os.read(reading, 1 << 16):
            pass
    except OSError:
        pass  # a terminal whose last program has ended


def programs_of() -> list[dict[str, Any]]:
    """Return the programs of the application; one that does not run before it can be asked."""
    try:
        found: list[dict[str, Any]] = control.ask("many", do="status")["programs"]
    except YarpError:
        return [{"state": "waiting"}]
    return found


def restarted(name: str) -> float:
    """Return the seconds from SIGKILL of a program until it runs again."""
    before = next(one for one in programs_of() if one["name"] == name)
    begun = time.perf_counter()
    os.kill(before["pid"], signal.SIGKILL)
    while True:
        now = next(one for one in programs_of() if one["name"] == name)
        if now["state"] == "running" and now["pid"] != before["pid"]:
            return time.perf_counter() - begun
        time.sleep(0.02)  # asking costs, too


def used(pid: int, seconds: float) -> float:
    """Return the per cent of a core that a process takes."""
    time.sleep(1.0)
    before, begun = _processor(pid), time.perf_counter()
    time.sleep(seconds)
    return 100 * (_processor(pid) - before) / (time.perf_counter() - begun)


def _processor(pid: int) -> float:
    words = Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def logged(programs: int, rate: int, seconds: float) -> str:
    """A row: lines that programs log, taken and read by the logger."""
    sender = [sys.executable, "-c", SENDER, str(rate // programs), str(seconds)]
    os.environ["YARP_FORWARD_LOG_ENABLE"] = "1"
    collector = LogCollector(lambda hear: yarpy.Port("/yarplogger", callback=hear))
    running = [subprocess.Popen(sender, stdout=subprocess.PIPE, text=True) for _ in range(programs)]
    read = told = 0
    while collector.waiting or any(process.poll() is None for process in running):
        for line, _ in collector.read(0.2):
            gap = line.text.partition(" lines before this one are lost")
            told += int(gap[0]) if gap[1] else 0
            read += line.text.startswith("a small line")
    lost = collector.lost
    collector.close()
    counts = [list(map(float, process.communicate()[0].split())) for process in running]
    sent, came, cost = (sum(column) for column in zip(*counts, strict=True))
    return (
        f"| {programs} log {came:.0f} lines a second, {seconds:g} s, {cost / programs:.0f} us of a "
        f"processor each | {read} read, {told} lost by programs, {lost} by the logger, "
        f"{sent - read - told - lost:.0f} not accounted for |"
    )


if __name__ == "__main__":
    main()
