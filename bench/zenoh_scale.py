"""Names on Zenoh at scale, on one computer:  sudo .venv/bin/python bench/zenoh_scale.py

Three routers in a chain, each a process, and PROGRAMS programs with NAMES names altogether, spread
over the three. The programs are simulated: WORKERS processes have a session of their own for each,
and register names for which nobody listens. What is sent is counted by the kernel: packets and
bytes on the loopback of a network namespace in which nothing else runs. Measured are

    joining     all programs within 10 s: messages, and how long until all see all names
    look-ups    names chosen by chance, asked at all three routers, one after the other
    outage      the middle router killed and started again: until names are back on both sides, and
                until messages arrive again over a connection from one end of the chain to the other

With `--bare` the programs are sessions of eclipse-zenoh alone, which declare what names need at
least: a queryable and a liveliness token for each. What that takes nobody undercuts who has such
names.

Needs root and iproute2. Everything runs on the processors of one computer, so routers, programs and
who measures take time from each other; there is no network delay.
"""

import argparse
import json
import multiprocessing
import os
import random
import statistics
import subprocess
import sys
import time
from pathlib import Path

import zenoh

from yarpy.peers.zenoh import reachability as direct
from yarpy.peers.zenoh.names import ZenohNames

WORKERS = 4
FIRST = 7450  # port number of the first router
WITHIN = 10.0  # seconds in which all programs join
SAMPLE = 60  # names that are looked for during the outage
MARK = "--inside"


def router(number: int) -> subprocess.Popen:
    where = f"tcp/0.0.0.0:{FIRST + number}"
    joined = ["--connect", f"tcp/127.0.0.1:{FIRST + number - 1}"] if number else []
    command = [sys.executable, "-m", "yarpy", "router", where, *joined]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert where in process.stdout.readline()
    return process


def place(program: int) -> str:
    """Where a program goes. Another address of the loopback for each: one more session."""
    return f"tcp/127.1.{program // 200}.{program % 200 + 1}:{FIRST + program % 3}"


def work(worker: int, options: argparse.Namespace, start: float, ready, stop) -> None:
    """Programs of one process: each joins at a time of its own."""
    numbers = range(worker, options.programs, WORKERS)
    each = options.names // options.programs
    opened = []
    for number in numbers:
        time.sleep(max(0.0, start + WITHIN * number / options.programs - time.time()))
        names = (BareNames if options.bare else ZenohNames)(place(number))
        opened.append(names)
        for index in range(each):
            names.register(f"/p{number}/port{index}", "tcp", "127.0.0.1", 10000 + index)
    ready.put(time.time())
    stop.wait()
    os._exit(0)  # as if the computer were switched off: closing is not measured


class BareNames:
    """The least that can be done for names, with eclipse-zenoh alone."""

    def __init__(self, where: str) -> None:
        said = {
            "mode": "client",
            "connect": {"endpoints": [where]},
            "scouting": {"multicast": {"enabled": False}},
        }
        self.session = zenoh.open(zenoh.Config.from_json5(json.dumps(said)))
        self.declared = []

    def register(self, name: str, *where) -> None:
        key, text = f"bare/name{name}", f"{name} {where}"
        answer = zenoh.handlers.Callback(lambda query: query.reply(key, text), indirect=False)
        self.declared.append(self.session.declare_queryable(key, answer))
        token = f"bare/port/{self.session.zid()}{name}"
        self.declared.append(self.session.liveliness().declare_token(token))

    def entry(self, name: str):
        return next((one for one in self.asked(f"bare/name{name}")), None)

    def list(self) -> list:
        return [*self.asked("bare/name/**")]

    def asked(self, key: str):
        replies = self.session.get(
            key,
            zenoh.handlers.FifoChannel(100_000),
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=3.0,
        )
        return (reply.ok.payload.to_bytes() for reply in replies if reply.ok is not None)


def traffic() -> tuple[int, int]:
    """Packets and bytes on the loopback so far."""
    for line in Path("/proc/self/net/dev").read_text(encoding="utf-8").splitlines():
        if line.strip().startswith("lo:"):
            words = line.split()
            return int(words[2]), int(words[1])
    raise OSError("no loopback")


def processor(processes) -> float:
    """Seconds for which they have run so far."""
    ticks = 0
    for each in processes:
        words = (
            Path(f"/proc/{each.pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        )
        ticks += int(words[11]) + int(words[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def found(names: ZenohNames, sample: list[str]) -> int:
    return sum(names.entry(name) is not None for name in sample)


def until(condition, limit: float = 60.0) -> float:
    """Seconds until it holds."""
    begin = time.perf_counter()
    while not condition():
        if time.perf_counter() - begin > limit:
            return float("inf")
        time.sleep(0.01)
    return time.perf_counter() - begin


def joining(options, observers, routers, workers: list) -> dict:
    context = multiprocessing.get_context("spawn")
    ready, stop = context.Queue(), context.Event()
    before, start, ran = traffic(), time.time() + 3.0, processor(routers)
    workers += [
        context.Process(target=work, args=(n, options, start, ready, stop), daemon=True)
        for n in range(WORKERS)
    ]
    for worker in workers:
        worker.start()
    last = max(ready.get(timeout=120) for _ in workers)
    worked = processor(workers)
    each = options.names // options.programs
    everything = each * options.programs
    seen = until(lambda: all(len(names.list()) == everything for names in observers))
    after = traffic()
    return {
        "names": everything,
        "programs": options.programs,
        "seconds until the last had joined": round(last - start, 2),
        "seconds until all were seen at all routers": round(time.time() - start, 2),
        "of them behind the last": round(seen, 2),
        "packets": after[0] - before[0],
        "bytes": after[1] - before[1],
        "seconds of a processor, programs until then": round(worked, 1),
        "seconds of a processor, routers altogether": round(processor(routers) - ran, 1),
        "packets for each name": round((after[0] - before[0]) / everything, 2),
    }


def lookups(options, observers) -> dict:
    each = options.names // options.programs
    chance = random.Random(1)
    times, missing = [], 0
    for index in range(options.lookups):
        name = f"/p{chance.randrange(options.programs)}/port{chance.randrange(each)}"
        begin = time.perf_counter()
        entry = observers[index % 3].entry(name)
        times.append(time.perf_counter() - begin)
        missing += entry is None
    begin = time.perf_counter()
    listed = len(observers[0].list())
    took = time.perf_counter() - begin
    times.sort()
    part = statistics.quantiles(times, n=100)
    return {
        "look-ups": len(times),
        "missing": missing,
        "median ms": round(part[49] * 1000, 3),
        "99 % ms": round(part[98] * 1000, 3),
        "longest ms": round(times[-1] * 1000, 3),
        f"seconds for a list of all {listed}": round(took, 3),
    }


def outage(options, observers, routers) -> dict:
    import yarpy

    direct.Reachability.to = lambda self, entry: entry.through  # one end cannot dial the other
    each = options.names // options.programs
    programs = range(0, options.programs, 3)  # of the first router
    sample = [f"/p{n}/port{n % each}" for n in programs][:SAMPLE]
    back = [f"/p{n + 2}/port{n % each}" for n in programs if n + 2 < options.programs][:SAMPLE]
    first, _, third = observers
    with (
        yarpy.Port("/scale/out", names=first) as out,
        yarpy.BufferedPort("/scale/in", names=third, strict=True) as in_,
    ):
        until(lambda: first.entry("/scale/in"))
        out.connect("/scale/in")
        sent = taken = 0

        def stream() -> None:
            nonlocal sent, taken
            sent += 1
            taken += out.write([sent])

        def came() -> int:
            count = 0
            while in_.poll() is not None:
                count += 1
            return count

        got = 0
        for _ in range(100):
            stream()
            time.sleep(0.01)
        got += came()
        routers[1].kill()
        routers[1].wait()

        def names_gone() -> bool:
            stream()
            return found(third, sample[:3]) == 0

        gone = until(names_gone)
        for _ in range(100):
            stream()
            time.sleep(0.01)
        got += came()
        routers[1] = router(1)
        begin = time.perf_counter()
        times = {"names": 0.0, "stream": 0.0}

        def returned() -> bool:
            nonlocal got
            stream()
            now = time.perf_counter() - begin
            fresh = came()
            got += fresh
            if fresh and not times["stream"]:
                times["stream"] = now
            if not times["names"] and (
                found(third, sample) == len(sample) and found(first, back) == len(back)
            ):
                times["names"] = time.perf_counter() - begin
            return all(times.values())

        until(returned)
        out.flush(5)
        time.sleep(0.5)
        got += came()
        past = out.stats.past.outputs
        dropped = past.drops + sum(one.drops for one in out.stats.outputs)
        return {
            "seconds until names of the other side were gone": round(gone, 3),
            "seconds from the start of the router until names were back": round(times["names"], 2),
            "... until messages arrived": round(times["stream"], 2),
            "written": sent,
            "nobody connected": out.stats.unconnected,
            "dropped": dropped,
            "unconfirmed": past.unconfirmed,
            "arrived": got,
            "lost without being counted": max(
                0, sent - out.stats.unconnected - dropped - past.unconfirmed - got
            ),
        }


def measure(options: argparse.Namespace) -> None:
    routers = [router(number) for number in range(3)]
    kind = BareNames if options.bare else ZenohNames
    observers = [kind(f"tcp/127.0.0.1:{FIRST + number}") for number in range(3)]
    workers: list = []
    try:
        print(
            json.dumps({"joining": joining(options, observers, routers, workers)}, indent=1),
            flush=True,
        )
        print(json.dumps({"look-ups": lookups(options, observers)}, indent=1), flush=True)
        if not (options.bare or options.no_outage):
            print(json.dumps({"outage": outage(options, observers, routers)}, indent=1), flush=True)
    finally:
        for each in (*routers, *workers):
            each.kill()
        os._exit(0)  # nothing here is worth a goodbye to 200 sessions


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--names", type=int, default=10_000)
    parser.add_argument("--programs", type=int, default=200)
    parser.add_argument("--lookups", type=int, default=3000)
    parser.add_argument("--bare", action="store_true", help="with eclipse-zenoh alone")
    parser.add_argument("--no-outage", action="store_true", help="leave the outage out")
    parser.add_argument(MARK, action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.inside:
        measure(options)
        return
    space = f"yarpy{os.getpid()}"
    subprocess.run(["ip", "netns", "add", space], check=True)
    try:
        subprocess.run(["ip", "-n", space, "link", "set", "lo", "up"], check=True)
        again = [sys.executable, *sys.argv, MARK]
        subprocess.run(["ip", "netns", "exec", space, *again], check=True)
    finally:
        subprocess.run(["ip", "netns", "del", space], check=True)


if __name__ == "__main__":
    main()
