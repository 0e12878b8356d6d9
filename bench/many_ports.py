"""Many ports in one program: how long they take to open, and what a port and a connection cost.

    python bench/many_ports.py [--ports 2000] [--cpp-ports 200] [--connections 200] [--rounds 3]

A program opens its ports one after the other, without a name server (`LocalNames`), with `yarpy
server`, and with yarpserver of C++; a program of C++ YARP does the same. They take turns, each time
with a server that was just started, and the middle of the rounds counts. Servers keep their names
in files, as they do for users. Then two programs make connections of one message each, and what
came on top is divided by their number: the writer's end in one, the reader's in the other.

Where C++ YARP cannot be had its rows are left out.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from support.cpp import CppYarp, MissingPeer
from support.port import free_block

# What every measured program begins with. Memory is what the kernel holds for the process.
COMMON = """
import json, os, sys, time
def used():
    with open("/proc/self/status") as lines:
        fields = dict(line.split(":", 1) for line in lines)
    return int(fields["VmRSS"].split()[0]) / 1024, int(fields["Threads"])
def say(**facts):
    print(json.dumps(facts), flush=True)
def difference(before):
    return [after - one for after, one in zip(used(), before)]
"""

OPENING = """
import resource, yarpy
most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
names = yarpy.LocalNames() if sys.argv[2] == "local" else None
yarpy.BufferedPort("/first", names=names).close()
before, start, busy = used(), time.perf_counter(), time.process_time()
ports = [yarpy.BufferedPort(f"/many/{n}", names=names) for n in range(int(sys.argv[1]))]
seconds, busy = time.perf_counter() - start, time.process_time() - busy
memory, threads = difference(before)
start = time.perf_counter()
for port in ports:
    port.close()
closing = time.perf_counter() - start
say(seconds=seconds, busy=busy, memory=memory, threads=threads, closing=closing, total=used()[0])
"""

OPENING_CPP = """
import yarp
yarp.Network.init()
first = yarp.BufferedPortBottle()
first.open("/first")
first.close()
before, start, busy = used(), time.perf_counter(), time.process_time()
ports = [yarp.BufferedPortBottle() for n in range(int(sys.argv[1]))]
for n, port in enumerate(ports):
    assert port.open(f"/many/{n}")
seconds, busy = time.perf_counter() - start, time.process_time() - busy
memory, threads = difference(before)
start = time.perf_counter()
for port in ports:
    port.close()
closing = time.perf_counter() - start
say(seconds=seconds, busy=busy, memory=memory, threads=threads, closing=closing, total=used()[0])
os._exit(0)
"""

READING = """
import yarpy
ports = [yarpy.BufferedPort(f"/reader/{n}", strict=True) for n in range(int(sys.argv[1]))]
before = used()
say(ready=True)
for port in ports:
    port.read()
memory, threads = difference(before)
say(memory=memory, threads=threads)
sys.stdin.read()
"""

WRITING = """
import yarpy
ports = [yarpy.BufferedPort(f"/writer/{n}") for n in range(int(sys.argv[1]))]
before, start = used(), time.perf_counter()
for n, port in enumerate(ports):
    yarpy.connect(port.name, f"/reader/{n}", sys.argv[2])
seconds = time.perf_counter() - start
for port in ports:
    port.write([1, "message"])
memory, threads = difference(before)
say(seconds=seconds, memory=memory, threads=threads)
sys.stdin.read()
"""

Environment = dict[str, str]


@contextlib.contextmanager
def program(code: str, *arguments: object, env: Environment, python: str) -> Iterator[Any]:
    """A program that says facts, line by line."""
    command = [python, "-c", COMMON + code, *map(str, arguments)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen(command, env=env, text=True, **pipes) as process:

        def fact() -> dict[str, float]:
            for line in process.stdout:
                if line.startswith("{"):  # C++ YARP logs there, too
                    return json.loads(line)
            raise AssertionError("a measured program ended without a word")

        yield fact
        process.stdin.close()


@contextlib.contextmanager
def yarpy_server(cpp: CppYarp | None) -> Iterator[tuple[Environment, Environment | None]]:
    """`yarpy server`, and what programs of both kinds need to use it."""
    with tempfile.TemporaryDirectory(prefix="yarpy-many-") as home, contextlib.ExitStack() as stack:
        number = free_block(100)
        own = {
            **os.environ,
            "YARP_CONFIG_HOME": home,
            "YARP_DATA_HOME": home,
            "YARP_PORT_RANGE": str(number),
            "YARPY_SERVER": f"127.0.0.1:{number}",
        }
        files = [word for name in ("portdb", "subdb") for word in (f"--{name}", f"{home}/{name}")]
        where = ["--ip", "127.0.0.1", "--socket", str(number)]
        server = subprocess.Popen(
            [sys.executable, "-m", "yarpy", "server", *where, *files],
            env=own,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        stack.callback(server.wait)
        stack.callback(server.terminate)
        ask = [sys.executable, "-m", "yarpy", "where"]
        while subprocess.run(ask, env=own, capture_output=True, check=False).returncode:
            assert server.poll() is None, "the name server ended"
        other = stack.enter_context(cpp.at("127.0.0.1", number)).environment if cpp else None
        yield own, other


@contextlib.contextmanager
def cpp_server(cpp: CppYarp) -> Iterator[tuple[Environment, Environment]]:
    """The same with a name server of C++."""
    with cpp.server() as server:
        own = {**os.environ, "YARP_CONFIG_HOME": server.environment["YARP_CONFIG_HOME"]}
        own["YARPY_SERVER"] = f"{server.host}:{server.port}"
        yield own, server.environment


def opening(options: argparse.Namespace, cpp: CppYarp | None) -> dict[str, dict[str, float]]:
    """One round: who opened what, and what it took for each port."""
    found: dict[str, dict[str, float]] = {}

    def measure(who: str, code: str, count: int, where: str, env: Environment, python: str) -> None:
        with program(code, count, where, env=env, python=python) as fact:
            found[who] = {**fact(), "ports": count}

    def yarpy_opens(who: str, where: str, env: Environment, count: int = options.ports) -> None:
        measure(who, OPENING, count, where, env, sys.executable)

    def cpp_opens(who: str, env: Environment) -> None:
        assert cpp is not None
        measure(who, OPENING_CPP, options.cpp_ports, "", env, str(cpp.interpreter))

    yarpy_opens("yarpy, no server", "local", dict(os.environ))
    with yarpy_server(None) as (own, _):
        yarpy_opens("yarpy, yarpy server", "server", own)
    if cpp is not None:
        with yarpy_server(cpp) as (_, other):
            assert other is not None
            cpp_opens("C++, yarpy server", other)
        with cpp_server(cpp) as (own, _):
            yarpy_opens("yarpy, yarpserver", "server", own, options.cpp_ports)
        with cpp_server(cpp) as (_, other):
            cpp_opens("C++, yarpserver", other)
    return found


def connecting(options: argparse.Namespace) -> dict[str, dict[str, float]]:
    """What the two ends of a connection cost, by carrier."""
    found = {}
    for carrier in ("tcp", "fast_tcp"):
        with (
            yarpy_server(None) as (own, _),
            program(READING, options.connections, env=own, python=sys.executable) as reader,
        ):
            reader()
            arguments = options.connections, carrier
            with program(WRITING, *arguments, env=own, python=sys.executable) as writer:
                found[carrier, "writer"], found[carrier, "reader"] = writer(), reader()
    return found


def row(who: str, rounds: list[dict[str, dict[str, float]]]) -> str:
    """The middle of the rounds, for one kind of program."""

    def middle(of: Callable[[dict[str, float]], float]) -> float:
        return statistics.median(of(one[who]) for one in rounds)

    count = rounds[0][who]["ports"]
    each = middle(lambda one: one["seconds"] / count * 1e3)
    cells = [
        f"{who} | {count:.0f}",
        f"{middle(lambda one: one['seconds']):.2f}",
        f"{each:.2f}",
        f"{middle(lambda one: one['busy'] / count * 1e3):.2f}",
        f"{middle(lambda one: one['closing'] / count * 1e3):.2f}",
        f"{middle(lambda one: one['memory'] / count * 1024):.0f}",
        f"{middle(lambda one: one['threads'] / count):.1f}",
        f"{middle(lambda one: one['total']):.0f}",
    ]
    if "C++, yarpserver" in rounds[0]:
        best = rounds[0]["C++, yarpserver"]["ports"]
        ratios = [
            one[who]["seconds"] / count / (one["C++, yarpserver"]["seconds"] / best)
            for one in rounds
        ]
        cells.append(f"{statistics.median(ratios):.2f}")
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--ports", type=int, default=2000)
    parser.add_argument("--cpp-ports", type=int, default=200)
    parser.add_argument("--connections", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="yarpy-many-") as home:
        try:
            cpp: CppYarp | None = CppYarp.prepare(Path(home))
        except MissingPeer as error:
            cpp = None
            print(f"without C++ YARP: {error}")
        rounds = [opening(options, cpp) for _ in range(options.rounds)]
        heading = ["who, with", "ports", "s", "ms each", "busy ms each", "closing ms each"]
        heading += ["KiB each", "threads each", "MiB in all", *["/ C++"] * (cpp is not None)]
        print("| " + " | ".join(heading) + " |")
        print("|---" + "|--:" * (len(heading) - 1) + "|")
        for who in rounds[0]:
            print(row(who, rounds))
    if not options.connections:
        return
    print("\n| a connection | end | KiB | threads |")
    print("|---|---|--:|--:|")
    for (carrier, end), fact in connecting(options).items():
        memory, threads = (fact[key] / options.connections for key in ("memory", "threads"))
        print(f"| {carrier} | {end} | {1024 * memory:.0f} | {threads:.1f} |")


if __name__ == "__main__":
    main()
