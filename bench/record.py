"""What a recorder costs, how fast files are written and read, and how punctual a player is.

`yarpy record` is a program of its own, and so are the senders; what it costs is the processor time
of its process. Each figure stands beside what can be had on the same machine in the same run:
`yarpdatadumper` of C++ where it is installed, plain system calls, the library `mcap`.

    python bench/record.py [--folder /dev/shm] [--seconds 10] [--ports 50] [--size 1920x1080]
"""

import argparse
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from record_files import GREAT, asking, large, small
from record_play import memory, punctual
from support.cpp import CppYarp, MissingPeer

import yarpy
from yarpy import record
from yarpy.kits.record.report import Report, report

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
WRITTEN = 1 << 30  # bytes that are written and read
RATE = 100  # small messages that each port sends a second
PICTURES = 30  # a second
PARTS = ("recorder", "files", "player")
RECORDER = [sys.executable, "-m", "yarpy", "record", "-e", "^/bench/", "--json", "-o"]


def ports(folder: Path, count: int, seconds: float, cpp: CppYarp | str) -> str:
    """Return a row: what it costs to record small messages of many ports, here and in C++."""
    path = folder / "ports.mcap"
    told, share = _recorded(path, [count, RATE, 0, 0], seconds)
    theirs = cpp
    if isinstance(cpp, CppYarp):
        ratio = _dumped(count, seconds, cpp) * _rate(told) / share
        theirs = f"1/{ratio:.1f} of C++ yarpdatadumper, a message"
    return f"| {_traffic(told)} | {share:.0%} of a core | {theirs} | {_lost(told)} lost |"


def camera(folder: Path, size: tuple[int, int], seconds: float) -> str:
    """Return a row: what it costs to record a camera, beside writing as many bytes."""
    path = folder / "camera.mcap"
    told, share = _recorded(path, [1, PICTURES, *size], seconds)
    payload, pieces = bytes(size[0] * size[1] * 3), max(round(PICTURES * seconds), 1)
    before = _own()
    with open(path, "wb", buffering=0) as file:
        for _ in range(pieces):
            file.write(payload)
    plain = (_own() - before) / seconds
    path.unlink()
    beside = f"{share / max(plain, 1e-3):.1f} x plain writes"
    return f"| {_traffic(told)} | {share:.0%} of a core | {beside} | {_lost(told)} lost |"


def killed(folder: Path, count: int, seconds: float) -> str:
    """Return a row: how much of the end is missing in a file whose recorder was killed."""
    path = folder / "killed.mcap"
    with _program([*RECORDER, str(path)]) as recorder, _sending([count, RATE, 0, 0]):
        time.sleep(1.0 + seconds)
        recorder.kill()
        end = time.time()
        recorder.wait()
    with record.open(path) as found:
        missing = end - found.end
    path.unlink()
    return (
        f"| killed by `kill -9` | the last {missing:.2f} s are missing | {missing:.2f} of 1 s | |"
    )


def _recorded(path: Path, words: list[int], seconds: float) -> tuple[Report, float]:
    """Return what is in a file that was recorded for a while, and the share of a core."""
    with _program([*RECORDER, str(path)]) as recorder, _sending(words):
        share = _share([recorder.pid], seconds)
        recorder.send_signal(signal.SIGINT)
        recorder.wait()
    with record.open(path) as found:
        told = report(found)
    path.unlink()
    return told, share


def _dumped(count: int, seconds: float, cpp: CppYarp) -> float:
    """Return the seconds of a core that a message costs in dumpers of C++, one for each port."""
    with ExitStack() as stack:
        server = stack.enter_context(cpp.at(*_address()))
        dumpers = []
        for number in range(count):
            name = f"/dump/{number}"
            words = ["--name", name, "--dir", f"d{number}", "--connect", f"/bench/{number}"]
            dumpers.append(stack.enter_context(server.popen(*words, program="yarpdatadumper")))
            yarpy.wait_for(name, timeout=60)
        sender = stack.enter_context(_program(_sender([count, RATE, 0, 0])))
        for number in range(count):  # their own attempt came before there was a sender
            yarpy.wait_for(f"/bench/{number}", timeout=60)
            yarpy.connect(f"/bench/{number}", f"/dump/{number}", "tcp")
        assert sender.stdout is not None
        sender.stdout.readline()
        share = _share([dumper.pid for dumper in dumpers], seconds)
        for dumper in dumpers:
            dumper.signal(signal.SIGINT)
        for dumper in dumpers:
            dumper.wait(60)
        rates = []
        for path in server.home.glob("d*/data.log"):
            lines = path.read_text().splitlines()
            first, last = (float(line.split()[1]) for line in (lines[0], lines[-1]))
            rates.append((len(lines) - 1) / (last - first))
        return share / sum(rates)


def _address() -> tuple[str, int]:
    host, _, port = os.environ["YARPY_SERVER"].rpartition(":")
    return host, int(port)


def _share(programs: list[int], seconds: float) -> float:
    """Return how much of a core these programs use from a second later on."""
    time.sleep(1.0)
    before, began = sum(map(_used, programs)), time.perf_counter()
    time.sleep(seconds)
    return (sum(map(_used, programs)) - before) / (time.perf_counter() - began)


def _traffic(told: Report) -> str:
    passed = told.end - told.begin
    written = sum(file["bytes"] for file in told.files)
    return (
        f"{_rate(told):.0f} messages, {written / passed / 1e6:.1f} MB a second "
        f"from {len(told.ports)} ports"
    )


def _rate(told: Report) -> float:
    """Return the messages a second."""
    return told.messages / (told.end - told.begin)


def _lost(told: Report) -> int:
    return sum(port.lost for port in told.ports)


def _sender(words: list[int]) -> list[str]:
    return [sys.executable, "-c", SENDER, *map(str, words)]


@contextmanager
def _sending(words: list[int]) -> Iterator[None]:
    """A program that sends, as soon as somebody hears it."""
    with _program(_sender(words)) as sender:
        assert sender.stdout is not None
        sender.stdout.readline()
        yield


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


def _own() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def _cpp(folder: Path) -> CppYarp | str:
    try:
        return CppYarp.prepare(folder / "cpp")
    except MissingPeer as error:
        return f"no C++ YARP: {str(error).splitlines()[0]}"


def main() -> None:
    asked = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    asked.add_argument("--folder", type=Path)
    asked.add_argument("--seconds", type=float, default=10.0)
    asked.add_argument("--ports", type=int, default=50)
    asked.add_argument("--size", default="1920x1080")
    asked.add_argument("--bytes", type=int, default=WRITTEN)
    asked.add_argument("--rounds", type=int, default=3)
    asked.add_argument("--info", type=int, default=GREAT, help="bytes of a file that info reads")
    asked.add_argument("--no-cpp", action="store_true", help="leave out C++ YARP")
    asked.add_argument("--parts", nargs="*", choices=PARTS, default=PARTS)
    options = asked.parse_args()
    width, height = map(int, options.size.split("x"))
    seconds, rounds = options.seconds, options.rounds
    with tempfile.TemporaryDirectory(dir=options.folder) as name, yarpy.NameServer() as server:
        os.environ.update(server.environment)
        folder = Path(name)
        cpp = "C++ YARP is left out" if options.no_cpp else _cpp(folder)
        if "recorder" in options.parts:
            print("| recorded | costs | beside | |\n|---|---|---|---|", flush=True)
            print(ports(folder, options.ports, seconds, cpp), flush=True)
            print(camera(folder, (width, height), seconds), flush=True)
            print(killed(folder, options.ports, min(seconds, 3.0)), flush=True)
        print("\n| files and players | | beside |\n|---|---|---|", flush=True)
        if "files" in options.parts:
            print("\n".join(large(folder, options.bytes, rounds)), flush=True)
            print("\n".join(small(folder, min(20_000, options.bytes // 1000), rounds)), flush=True)
            print(asking(folder, options.info, rounds), flush=True)
        if "player" in options.parts:
            print(punctual(folder, min(seconds, 10.0)), flush=True)
            print(memory(folder, options.bytes))


if __name__ == "__main__":
    main()
