"""Decorated methods beside what they stand for: a plain call, a bare `port.write`, a bare question,
Wrapyfi's JSON.

The reader is a program of its own; the contenders take turns, so that a busy machine is as unkind
to each. A ratio compares medians of the same round, and the middle one of these counts. A decorated
method stamps what it sends, so a bare write with a stamp is beside it, too. `paced` waits 2 ms
before each, as a control loop does; the others follow each other. Questions are of one number, to
an `RpcServer`, to a method that `wrap` serves, and to one of a program for Wrapyfi. What receiving
takes is counted in processor time, since the sender decides when something comes.

    python bench/wrap.py [--rounds 30]
"""

from __future__ import annotations

import argparse
import itertools
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.value.frame import Frame, from_parts, to_parts
from yarpy.kits.wrap.value.tree import from_text, to_text

SMALL = {"joint": 3, "angle": 45.0}
PICTURE = np.random.default_rng(1).integers(0, 255, (480, 640, 3), "u1")
VALUES = {"small": SMALL, "picture": PICTURE}

READER = """
import sys, yarpy
ports = [yarpy.BufferedPort(f"/reader{n}", callback=lambda message: None) for n in range(2)]
for port, source in zip(ports, ("/decorated", "/bare")):
    yarpy.connect(source, port.name)
print("ready", flush=True)
sys.stdin.read()
for port in ports:
    port.close()
"""


DROP_IN = str(Path(__file__).resolve().parent.parent / "compat" / "wrapyfi" / "src")
ADDERS = f"""
import contextlib, sys
sys.path.insert(0, {DROP_IN!r})
import yarpy
from wrapyfi.connect.wrapper import MiddlewareCommunicator
from yarpy.kits import wrap

class Kit:
    @wrap.on("/kit")
    def add(self, number: float) -> float:
        return number + 1

class DropIn(MiddlewareCommunicator):
    @MiddlewareCommunicator.register("NativeObject", "yarp", "DropIn", "/dropin", carrier="tcp")
    def add(self, number):
        return (number + 1,)
"""
SERVER = f"""{ADDERS}
import threading

def serve(method):
    with contextlib.suppress(yarpy.PortClosed):
        while True:
            method(0.0)

kit, drop_in = Kit(), DropIn()
drop_in.activate_communication("add", "reply")
with yarpy.RpcServer("/native", lambda message: message.value[0] + 1), wrap.serve(kit.add):
    threading.Thread(target=serve, args=(drop_in.add,), daemon=True).start()
    print("ready", flush=True)
    sys.stdin.read()
    drop_in.close()
"""


WRITER = f"""
import sys, time
sys.path.insert(0, {str(Path(__file__).resolve().parent)!r})
from wrap import VALUES, Arm, wrap, yarpy
arm = Arm(VALUES[sys.argv[1]])
method = getattr(arm, sys.argv[1])
with yarpy.BufferedPort("/bare", strict=True) as bare, wrap.publish(method):
    print("ready", flush=True)
    for line in sys.stdin:
        who, count = line.split()
        for _ in range(int(count)):
            time.sleep(0.001)
            method() if who == "listen" else bare.write(arm.value)
"""


class Arm:
    """One method for each value."""

    def __init__(self, value: Any) -> None:
        self.value = value

    def plain(self) -> Any:
        return self.value

    @wrap.on("/decorated", keep="all")
    def small(self) -> dict:
        return self.value

    @wrap.on("/decorated", keep="all")
    def picture(self) -> np.ndarray:
        return self.value


def timed(act: Callable[[], object], count: int, pause: float = 0.0) -> float:
    """Microseconds of one call."""
    if pause:
        found = []
        for _ in range(count):
            time.sleep(pause)
            begun = time.perf_counter()
            act()
            found.append(time.perf_counter() - begun)
        return statistics.median(found) * 1e6
    begun = time.perf_counter()
    for _ in range(count):
        act()
    return (time.perf_counter() - begun) / count * 1e6


def medians(
    acts: dict[str, Callable[[], object]], count: int, rounds: int, pause: float = 0.0
) -> dict[str, float]:
    """The median of each over the rounds, in microseconds, and of the ratios of the others to the
    first."""
    times: dict[str, list[float]] = {name: [] for name in acts}
    for _ in range(rounds):
        for name, act in acts.items():
            times[name].append(timed(act, count, pause))
    found = {name: statistics.median(one) for name, one in times.items()}
    first, *others = times
    for name in others:
        pairs = zip(times[name], times[first], strict=True)
        found[f"{name} / {first}"] = statistics.median(one / base for one, base in pairs)
    return found


@contextmanager
def read(method: Any) -> Iterator[yarpy.BufferedPort]:
    """The decorated method publishes, a bare port is open, and another program reads both."""
    with (
        yarpy.NameServer() as server,
        wrap.publish(method),
        yarpy.BufferedPort("/bare", strict=True) as bare,
    ):
        reader = subprocess.Popen(
            [sys.executable, "-c", READER],
            env=server.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        assert reader.stdin is not None and reader.stdout is not None
        reader.stdout.readline()
        yield bare
        reader.communicate()


def stamped(port: yarpy.BufferedPort, value: Any) -> Callable[[], object]:
    """A write with the next stamp."""
    count = itertools.count()
    return lambda: port.write(value, yarpy.Stamp(next(count), time.time()))


def asking(rounds: int) -> dict[str, float]:
    """Questions to another program."""
    parts: dict[str, Any] = {}
    exec(ADDERS, parts)  # the same classes here
    with yarpy.NameServer() as server:
        pipe = subprocess.PIPE
        with subprocess.Popen(
            [sys.executable, "-c", SERVER], env=server.environment, stdin=pipe, stdout=pipe
        ) as process:
            assert process.stdin is not None and process.stdout is not None
            process.stdout.readline()
            kit, drop_in = parts["Kit"](), parts["DropIn"]()
            drop_in.activate_communication("add", "request")
            with yarpy.RpcClient("/native") as client, wrap.call(kit.add):
                acts: dict[str, Callable[[], object]] = {
                    "ask native": lambda: client.call(3.0),
                    "ask by wrap.call": lambda: kit.add(3.0),
                    "ask as Wrapyfi": lambda: drop_in.add(3.0),
                }
                for act in acts.values():
                    act()  # connects
                found = medians(acts, 100, rounds)
            drop_in.close()
            process.stdin.close()
    return found


def receiving(name: str, rounds: int) -> dict[str, float]:
    """What another program writes, every millisecond, to a port and to a method that listens."""
    method = getattr(Arm(None), name)
    reads: dict[str, Callable[[Any], object]] = {
        "small": lambda message: message.as_(dict),
        "picture": lambda message: message.value.array.copy(),  # which may be changed then
    }
    pipe, read, count = subprocess.PIPE, reads[name], 100
    with (
        yarpy.NameServer() as server,
        subprocess.Popen(
            [sys.executable, "-c", WRITER, name], env=server.environment, stdin=pipe, stdout=pipe
        ) as process,
    ):
        assert process.stdin is not None and process.stdout is not None
        process.stdout.readline()
        with yarpy.BufferedPort("", strict=True) as bare, wrap.listen(method) as handle:
            bare.listen_to("/bare")
            while not handle.stats[0]["inputs"]:
                time.sleep(0.01)
            acts = {"read": lambda: read(bare.read()), "listen": method}
            times: dict[str, list[float]] = {who: [] for who in acts}
            for _ in range(rounds):
                for who, act in acts.items():
                    process.stdin.write(f"{who} {count}\n".encode())
                    process.stdin.flush()
                    begun = time.process_time()
                    for _ in range(count):
                        act()
                    times[who].append((time.process_time() - begun) / count * 1e6)
        process.stdin.close()
    pairs = [one / base for one, base in zip(times["listen"], times["read"], strict=True)]
    found = {f"{who} {name}, processor": statistics.median(one) for who, one in times.items()}
    return {**found, f"listen {name} / read {name}, processor": statistics.median(pairs)}


def measure(rounds: int) -> dict[str, float]:
    """Every number: microseconds, and ratios."""
    found = asking(rounds) | receiving("small", rounds) | receiving("picture", rounds)
    arm = Arm(SMALL)
    calls = {"call plain": arm.plain, "call decorated, no mode": arm.small}
    found |= medians(calls, 20_000, rounds)
    pace = 0.002
    for name, value, count, pause in (
        *(("small", SMALL, 500, 0.0), ("small", SMALL, 50, pace)),
        *(("picture", PICTURE, 20, 0.0), ("picture", PICTURE, 20, pace)),
    ):
        arm = Arm(value)
        method = getattr(arm, name)
        with read(method) as bare:
            paced = ", paced" if pause else ""
            publishing = {
                f"write {name}{paced}": lambda bare=bare, value=value: bare.write(value),
                f"write {name}, stamped{paced}": stamped(bare, value),
                f"publish {name}{paced}": method,
            }
            found |= medians(publishing, count, rounds, pause)
    encoding = {
        "frame of a picture": lambda: from_parts(to_parts(Frame(PICTURE, 1, 2.0))),
        "Wrapyfi's text of a picture": lambda: from_text(to_text(PICTURE)),
    }
    found |= medians(encoding, 3, rounds)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=30)
    for name, value in measure(parser.parse_args().rounds).items():
        print(f"{name:60} {value:10.2f} {'' if '/' in name else 'us'}")


if __name__ == "__main__":
    main()
