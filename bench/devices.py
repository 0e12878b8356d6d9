"""Devices over the network: what they take of a processor, and how late they are.

state    a control board of 50 joints tells its state 1000 times a second: share of a core that
         server and client take, and how far the times between messages are from a millisecond
rpc      `encoders` asked of a control board by rpc, beside an rpc that carries the same and does
         nothing
rgbd     a camera with distances, 640 x 480 pictures 30 times a second over memory: share of a core

    python bench/devices.py [--seconds 5] [--joints 50] [--rate 1000] [--calls 3000]
"""

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Sequence

import numpy as np

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices import ControlBoardServer, DepthCamera, SimulatedJoints

BOARD = """
import sys, yarpy
from yarpy.kits.devices import ControlBoardServer, SimulatedJoints
count, period = int(sys.argv[1]), float(sys.argv[2])
joints = SimulatedJoints([f"j{number}" for number in range(count)])
server = ControlBoardServer("/bench/board", joints, period)
print("open", flush=True)
sys.stdin.read()
"""
CAMERA = """
import sys
import numpy as np
import yarpy
from yarpy.kits.devices import DepthCamera
class Eye:
    def __init__(self):
        self._colour = yarpy.Image(np.zeros((480, 640, 3), "u1"))
        self._depth = yarpy.Image(np.ones((480, 640), "f4"))
    def colour(self): return self._colour
    def depth(self): return self._depth
server = DepthCamera.serve("/bench/eye", Eye(), 1 / 30)
print("open", flush=True)
sys.stdin.read()
"""


class Program:
    """A program that serves a device while this is open."""

    def __init__(self, code: str, *arguments: object) -> None:
        command = [sys.executable, "-c", code, *map(str, arguments)]
        self._program = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def __enter__(self) -> "Program":
        assert self._program.stdout is not None
        self._program.stdout.readline()
        return self

    def __exit__(self, *details: object) -> None:
        self._program.communicate()

    @property
    def used(self) -> float:
        """Seconds of a processor so far."""
        with open(f"/proc/{self._program.pid}/stat", encoding="utf-8") as file:
            user, system = file.read().rpartition(")")[2].split()[11:13]
        return (int(user) + int(system)) / 100


def state(joints: int, rate: float, seconds: float) -> str:
    """The row of the state's stream."""
    arrivals: list[float] = []
    with (
        Program(BOARD, joints, 1 / rate) as board,
        yarpy.BufferedPort(
            "/bench/state", callback=lambda m: arrivals.append(time.monotonic())
        ) as p,
    ):
        p.listen_to("/bench/board/stateExt:o")
        while len(arrivals) < 50:
            time.sleep(0.01)
        arrivals.clear()
        there, here, start = board.used, time.process_time(), time.monotonic()
        time.sleep(seconds)
        took = time.monotonic() - start
        there, here = board.used - there, time.process_time() - here
    late = np.abs(np.diff(arrivals) - 1 / rate) * 1000
    return (
        f"| state, {joints} joints | {len(arrivals) / took:.0f} Hz | {100 * there / took:.1f} % | "
        f"{100 * here / took:.1f} % | p50 {np.percentile(late, 50):.2f} ms, "
        f"p99 {np.percentile(late, 99):.2f} ms |"
    )


def rpc(joints: int, calls: int) -> str:
    """The row of `encoders` beside a bare rpc."""
    answer = Bottle([Vocab("is"), Vocab("encs"), Bottle([0.0] * joints), Vocab("ok")])
    question = Bottle([Vocab("get"), Vocab("encs")])
    device = SimulatedJoints([f"j{number}" for number in range(joints)])
    with (
        ControlBoardServer("/bench/board", device, 1.0),
        yarpy.RpcServer("/bench/bare", lambda message: answer),
        yarpy.RpcClient("/bench/bare") as bare,
        yarpy.RpcClient("/bench/board/rpc:i") as asking,
    ):
        found: dict[str, list[float]] = {"bare": [], "board": []}
        for _ in range(5):  # in turns, and the best counts
            for name, client in (("bare", bare), ("board", asking)):
                start = time.perf_counter()
                for _ in range(calls // 5):
                    client.call(question)
                found[name].append((time.perf_counter() - start) / (calls // 5))
    plain, board = min(found["bare"]) * 1e6, min(found["board"]) * 1e6
    ratio = f"{board / plain:.2f} of a bare rpc, {plain:.0f} us"
    return f"| encoders of {joints} joints | | {board:.0f} us | {ratio} | |"


def rgbd(seconds: float) -> str:
    """The row of a camera with distances."""
    with (
        Program(CAMERA) as camera,
        DepthCamera.connect("/bench/eye", carrier="memory", timeout=10.0) as client,
    ):
        client.colour()
        there, here, start, count = camera.used, time.process_time(), time.monotonic(), 0
        while time.monotonic() - start < seconds:
            client.colour().array[::64, ::64].sum()
            client.depth().array[::64, ::64].sum()
            count += 1
            time.sleep(1 / 30)
        took = time.monotonic() - start
        there, here = camera.used - there, time.process_time() - here
    return (
        f"| RGBD 640 x 480 | {count / took:.0f} Hz | {100 * there / took:.1f} % | "
        f"{100 * here / took:.1f} % | |"
    )


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Devices over the network.")
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--joints", type=int, default=50)
    parser.add_argument("--rate", type=float, default=1000.0)
    parser.add_argument("--calls", type=int, default=3000)
    options = parser.parse_args(arguments)
    with yarpy.NameServer() as server:
        os.environ.update(server.environment)
        print("| | | server | client | jitter |\n|---|---|---|---|---|")
        print(state(options.joints, options.rate, options.seconds))
        print(rpc(options.joints, options.calls))
        print(rgbd(options.seconds))


if __name__ == "__main__":
    main()
