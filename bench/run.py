"""Measure yarpy beside its peers:  python bench/run.py [--quick] [--peers ...] [--workloads ...]

Every measurement is a server and a client process on the loopback, each on a processor core of its
own or both on one. The peers take turns within a
round and the order changes from round to round, so that a disturbance of the machine does not fall
on one of them alone. Prints a table with ratios and the goals, and writes bench/results/TIME.json.

Rules: no time is ever asserted; a peer that cannot run is named with the reason and left out.
"""

import argparse
import contextlib
import importlib.metadata
import json
import os
import platform
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import report
from workload import WORKLOADS, Workload

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests"))

from support.cpp import CppYarp, MissingPeer  # noqa: E402
from support.process import Process  # noqa: E402

THROUGH = ("stream", "rpc", "large", "flood")
EVERYTHING = ("stream", "rpc", "large", "flood", "fan")


@dataclass(frozen=True)
class Peer:
    """A program of this directory with its options, and what it can be asked."""

    name: str
    script: str
    needs: str = ""
    """Module without which it cannot run; "cpp" for the C++ peer. `yarp` is compat's, and uses the
    same name server as that peer."""
    options: tuple[str, ...] = ()
    functions: Sequence[str] = EVERYTHING
    needs_core: bool = False
    """It spins: two of it on one core would wait for the scheduler, not for each other."""

    def can(self, workload: Workload) -> bool:
        return workload.function in self.functions and workload.cores > self.needs_core


PEERS = (
    Peer("raw", "peer_raw.py"),
    Peer("zmq", "peer_zmq.py", "zmq"),
    Peer("zenoh", "peer_zenoh.py", "zenoh"),
    Peer("zenoh-router", "peer_zenoh.py", "zenoh", ("--router",), THROUGH),
    Peer("cpp-tcp", "peer_cpp.py", "cpp", ("--carrier", "tcp")),
    Peer("cpp-fast_tcp", "peer_cpp.py", "cpp", ("--carrier", "fast_tcp")),
    # The same program as for C++, with yarpy-compat as its `yarp`.
    Peer("compat-tcp", "peer_cpp.py", "yarp", ("--carrier", "tcp")),
    Peer("compat-fast_tcp", "peer_cpp.py", "yarp", ("--carrier", "fast_tcp")),
    Peer("cpp-latency-test", "peer_latency_test.py", "cpp", (), ("stream", "rpc")),
    Peer("yarpy-tcp", "peer_yarpy.py", "yarpy", ("--carrier", "tcp")),
    Peer("yarpy-fast_tcp", "peer_yarpy.py", "yarpy", ("--carrier", "fast_tcp")),
    Peer("yarpy-memory", "peer_yarpy.py", "yarpy", ("--carrier", "memory")),
    Peer(
        "yarpy-memory-spin",
        "peer_yarpy.py",
        "yarpy",
        ("--carrier", "memory", "--spin"),
        ("stream",),
        needs_core=True,
    ),
    # The same, where the client fills memory that `port.prepare` gives.
    Peer(
        "yarpy-prepare", "peer_yarpy.py", "yarpy", ("--carrier", "memory", "--prepare"), ("large",)
    ),
    Peer(
        "yarpy-tls",
        "peer_yarpy.py",
        "cryptography",
        ("--carrier", "tls"),
        ("stream", "rpc", "large", "flood"),
    ),
    Peer(
        "yarpy-zmq",
        "peer_yarpy.py",
        "yarpy",
        ("--carrier", "zmq+push"),
        ("stream", "flood"),
    ),
    Peer("yarpy-zenoh", "peer_yarpy.py", "zenoh", ("--router",), THROUGH),
    Peer("yarpy-spin", "peer_yarpy.py", "yarpy", ("--spin",), ("stream",), needs_core=True),
)


@dataclass
class Bench:
    """What the measurements share: interpreters, environments, and the C++ name server."""

    cores: Sequence[int]
    """Two processor cores for client and server; the same one twice if there is only one, and
    none where the system cannot bind a process to a core."""
    cpp: CppYarp | None = None
    problems: dict[str, str] = field(default_factory=dict)

    def measure(self, peer: Peer, workload: Workload) -> report.Measurement:
        """One server and one client; what the client measured."""
        with self.start(peer, "server", workload, 1) as server:
            at = server.wait_line(r"^\{.*\}$", timeout=40, stream="out")[0]
            counts = ("--warmup", str(workload.warmup), "--count", str(workload.count))
            rest = ("--pause", str(workload.pause), "--server", str(server.pid))
            rest += ("--side", str(workload.side))
            with self.start(peer, "client", workload, 0, "--at", at, *counts, *rest) as client:
                answer = client.wait_line(r"^\{.*\}$", timeout=60, stream="out")[0]
        return report.Measurement(**json.loads(answer))

    def start(self, peer: Peer, side: str, workload: Workload, core: int, *more: str) -> Process:
        python, environment = sys.executable, dict(os.environ)
        if peer.needs == "cpp":
            assert self.cpp is not None
            environment = {**self.cpp.environment, "YARP_PROGRAM": str(self.cpp.program())}
            environment["YARP_QUIET"] = "1"
            python = str(self.cpp.interpreter)
        elif peer.needs == "yarp":
            assert self.cpp is not None
            environment["YARP_CONFIG_HOME"] = self.cpp.environment["YARP_CONFIG_HOME"]
        command = [python, str(HERE / peer.script), side, workload.function, *peer.options, *more]
        if self.cores:
            command += ["--core", str(self.cores[core if workload.cores == 2 else 0])]
        return Process(command, env=environment)


def two_cores() -> list[int]:
    """Two processor cores that are not one core under two numbers, if there are such."""
    if not hasattr(os, "sched_getaffinity"):
        return []
    first, *others = sorted(os.sched_getaffinity(0))
    twins = ""
    with contextlib.suppress(OSError):
        path = f"/sys/devices/system/cpu/cpu{first}/topology/thread_siblings_list"
        twins = Path(path).read_text(encoding="utf-8").strip()
    apart = [core for core in others if str(core) not in twins.replace("-", ",").split(",")]
    return [first, next(iter(apart or others), first)]


def choose(wanted: Sequence[str], bench: Bench) -> Iterator[Peer]:
    """The peers to measure; those that cannot run are noted in `bench.problems`."""
    for peer in PEERS:
        if wanted and not any(peer.name.startswith(one) for one in wanted):
            continue
        if peer.needs in ("cpp", "yarp") and bench.cpp is None:
            continue
        if peer.needs not in ("", "cpp"):
            try:
                importlib.import_module(peer.needs)
            except ImportError as error:
                bench.problems[peer.name] = f"{error}; install the extra `bench`"
                continue
        yield peer


def run(
    peers: Sequence[Peer],
    workloads: dict[str, Workload],
    rounds: int,
    measure: Callable[[Peer, Workload], report.Measurement],
    problems: dict[str, str],
) -> dict[str, dict[str, list[report.Measurement]]]:
    """Measurements by workload, peer and round, made in turns."""
    results: dict[str, dict[str, list[report.Measurement]]] = {}
    for name, workload in workloads.items():
        able = [peer for peer in peers if peer.can(workload)]
        collected: dict[str, list[report.Measurement]] = {peer.name: [] for peer in able}
        for number in range(rounds):
            turn = number % len(able) if able else 0
            for peer in [*able[turn:], *able[:turn]]:
                problem = f"{peer.name} {name}"
                if problem in problems:
                    continue
                progress(f"{name}, round {number + 1} of {rounds}: {peer.name}")
                try:
                    collected[peer.name].append(measure(peer, workload))
                except AssertionError as error:
                    problems[problem] = str(error)
        results[name] = {peer: made for peer, made in collected.items() if made}
    progress("")
    return results


def progress(text: str) -> None:
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def machine() -> dict[str, object]:
    """The facts without which the numbers mean nothing."""
    model = platform.processor() or "unknown"
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                model = line.partition(":")[2].strip()
                break
    versions = {}
    for package in ("yarpy", "pyzmq", "eclipse-zenoh", "numpy"):
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            versions[package] = importlib.metadata.version(package)
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()}",
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "load_before": os.getloadavg(),
        "versions": versions,
        "import_yarpy_ms": import_ms(),
    }


def import_ms(module: str = "yarpy", runs: int = 9) -> float:
    """How long a fresh interpreter imports a module: the best run, in milliseconds."""
    code = f"import time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
    command = [sys.executable, "-c", code]
    return round(min(float(subprocess.check_output(command)) for _ in range(runs)) * 1e3, 1)


def main() -> int:
    # A terminated run still ends what it started (the exit handlers run).
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few rounds, few samples")
    parser.add_argument("--rounds", type=int, help="how often every peer has its turn")
    parser.add_argument(
        "--peers", nargs="+", default=[], metavar="NAME", help="beginnings of names"
    )
    parser.add_argument("--workloads", nargs="+", default=[*WORKLOADS], choices=[*WORKLOADS])
    parser.add_argument("--output", type=Path, default=HERE / "results", help="directory for JSON")
    options = parser.parse_args()

    rounds = options.rounds or (3 if options.quick else 7)
    workloads = {
        name: WORKLOADS[name].quick() if options.quick else WORKLOADS[name]
        for name in options.workloads
    }
    facts = machine()
    bench = Bench(two_cores())
    with contextlib.ExitStack() as stack:
        with contextlib.suppress(ImportError):  # the peer that needs it is named with the reason
            from yarpy.config.authority import make

            folder = stack.enter_context(tempfile.TemporaryDirectory())
            make(Path(folder), ["127.0.0.1", "localhost"])
            os.environ["YARPY_TLS_DIR"] = folder
        if not options.peers or any(one[:3] in ("cpp", "com") for one in options.peers):
            try:
                home = stack.enter_context(tempfile.TemporaryDirectory())
                bench.cpp = stack.enter_context(CppYarp.prepare(Path(home)).server())
                facts["cpp_yarp"] = bench.cpp.run("version").stdout.strip()
            except (MissingPeer, AssertionError) as error:
                bench.problems["cpp"] = str(error)
        peers = list(choose(options.peers, bench))
        results = run(peers, workloads, rounds, bench.measure, bench.problems)

    print(", ".join(f"{key}: {value}" for key, value in facts.items()))
    for line in report.table(results):
        print(line)
    for name, problem in bench.problems.items():
        print(f"\nnot measured: {name}: {problem}")
    options.output.mkdir(parents=True, exist_ok=True)
    path = options.output / time.strftime("%Y-%m-%dT%H%M%SZ.json", time.gmtime())
    path.write_text(json.dumps(document(facts, workloads, results, bench.problems), indent=1))
    print(f"\nwritten: {path}")
    return 0


def document(
    facts: dict[str, object],
    workloads: dict[str, Workload],
    results: report.Results,
    problems: dict[str, str],
) -> dict[str, object]:
    """What the JSON file holds."""
    return {
        "machine": facts,
        "workloads": {
            name: {
                "title": workload.title,
                "unit": workload.unit,
                "peers": {
                    peer: {
                        **report.summary(measured, workload),
                        "medians_of_rounds": report.medians(measured),
                    }
                    for peer, measured in results[name].items()
                },
            }
            for name, workload in workloads.items()
        },
        "goals": [
            {
                "workload": outcome.workload,
                "ratio_of": outcome.goal.title,
                "goal": outcome.goal.factor,
                "measured": outcome.measured,
                "reached": outcome.reached,
            }
            for outcome in report.outcomes(results)
        ],
        "problems": problems,
    }


if __name__ == "__main__":
    sys.exit(main())
