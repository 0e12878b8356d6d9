"""A server of Thrift: examples/arm.thrift, with a method for every type.

    yarpy server                        # in one terminal
    python examples/thrift_server.py    # in another
    python examples/thrift_client.py    # in a third, or: yarpy rpc /arm/rpc, and then: help move

The page of its port (at the address that it prints) has a form for each method. Ctrl-C ends it.
"""

import threading
from collections import Counter
from contextlib import suppress
from pathlib import Path

import yarpy
from yarpy import idl

arm = idl.load(Path(__file__).with_name("arm.thrift"))


class Arm(arm.Arm):
    state = arm.Status(angles=[0.0] * arm.JOINTS)

    def move(self, joint, angle, speed):
        if joint in range(arm.JOINTS):
            self.state.angles[joint] = angle
        return joint in range(arm.JOINTS)

    def path(self, begin, end, steps):
        if steps < 2:
            raise yarpy.YarpError("a path has at least two steps")
        parts = [n / (steps - 1) for n in range(steps)]
        return [arm.Pose(begin.x + (end.x - begin.x) * part, begin.y) for part in parts]

    # fmt: off
    def stop(self): print("stopped", flush=True)
    def rest(self): self.state.angles[:] = 0
    def count_joints(self): return arm.JOINTS
    def small(self, value): return value
    def short_number(self, value): return value
    def large(self, value): return value
    def unsigned_number(self, value): return value
    def single(self, value): return value
    def say(self, text, times): return " ".join([text] * times)
    def word(self, value): return value
    def reverse(self, data): return data[::-1]
    def set_mode(self, mode): self.state.mode = mode; return mode  # noqa: E702
    def scale(self, values, factor): return values * factor
    def unique(self, values): return set(values)
    def letters(self, text): return Counter(text)
    def grid(self, rows, columns): return [range(columns)] * rows
    def status(self): return self.state
    def add(self, a, b): return a.array + b.array
    # fmt: on


if __name__ == "__main__":
    with suppress(KeyboardInterrupt), yarpy.RpcServer("/arm/rpc", Arm(), lock=True) as server:
        print(f"{server.name} listens at http://{server.address}/", flush=True)
        threading.Event().wait()
