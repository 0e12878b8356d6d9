"""A call of Thrift beside a bare one: what names, types and checks cost.

Client and server are in one process, over tcp on the loopback; the contenders take turns, so that a
busy machine is as unkind to each, and the median of each round's calls is compared. The bare call
is what a program without Thrift writes: a list, and a handler that looks at its first word.

    python bench/thrift_call.py [--rounds 40]
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from typing import Any

import yarpy
from yarpy.kits.thrift.library import loads

CALLS = 100  # in a row

INTERFACE = """\
struct Pose { 1: double x, 2: double y, 3: string frame }
service Arm {
  bool move(1: i32 joint, 2: double angle);
  Pose locate(1: Pose pose);
  list<double> scale(1: list<double> values);
}
"""


def contenders(names: yarpy.LocalNames, opened: list[Any]) -> dict[str, tuple[Any, Any]]:
    """A call of Thrift and the bare one that carries the same."""
    arm = loads(INTERFACE, "arm")

    class Arm(arm.Arm):  # type: ignore[misc, name-defined]
        def move(self, joint: int, angle: float) -> bool:
            return joint < 4

        def locate(self, pose: Any) -> Any:
            return pose

        def scale(self, values: Any) -> Any:
            return values

    def bare(message: yarpy.Message) -> object:
        request = message.value
        match request[0]:
            case "move":
                return [yarpy.Vocab("ok" if request[1] < 4 else "fail")]
            case "locate":
                return request[1:]
        return [request[1]]

    opened.append(yarpy.RpcServer("/arm", Arm(), names=names))
    opened.append(yarpy.RpcServer("/bare", bare, names=names))
    typed = arm.connect("/arm", names=names)
    client = yarpy.RpcClient("/bare", names=names)
    opened += [typed, client]
    pose = arm.Pose(1.0, 2.0, "base")
    values = [float(number) for number in range(7)]
    return {
        "an int and a float, bool": (
            lambda: typed.move(1, 20.0),
            lambda: client.call("move", 1, 20.0),
        ),
        "a struct of three, back": (
            lambda: typed.locate(pose),
            lambda: client.call("locate", 1.0, 2.0, "base"),
        ),
        "a list of seven, back": (
            lambda: typed.scale(values),
            lambda: client.call("scale", values),
        ),
    }


def took(call: Callable[[], Any]) -> float:
    """Microseconds of one call in the middle."""
    found = []
    for _ in range(CALLS):
        begun = time.perf_counter()
        call()
        found.append(time.perf_counter() - begun)
    return statistics.median(found) * 1e6


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=40)
    rounds = parser.parse_args(arguments).rounds
    opened: list[Any] = []
    try:
        print(f"{'':28}{'Thrift':>10}{'bare':>10}{'ratio':>8}")
        for name, (typed, bare) in contenders(yarpy.LocalNames(), opened).items():
            pairs = [(took(typed), took(bare)) for _ in range(rounds)]
            both = [statistics.median(each) for each in zip(*pairs, strict=True)]
            ratio = statistics.median(first / second for first, second in pairs)
            print(f"{name:28}{both[0]:7.1f} us{both[1]:7.1f} us{ratio:8.2f}")
    finally:
        for each in reversed(opened):
            each.close()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
