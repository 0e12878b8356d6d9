"""A robot of your own: three joints that any YARP program can move, and a program that does.

    python examples/robot_head.py

Needs no name server. With one, C++ programs and people with netcat find the head too: see
docs/devices.md.
"""

import time

import yarpy
from yarpy.kits.devices import ControlBoard, ControlBoardServer


class Head:
    """Joints that move at constant speed, and stop at their limits."""

    axis_names = ("pitch", "roll", "yaw")
    position_limits = ((-30.0, 30.0), (-20.0, 20.0), (-50.0, 50.0))

    def __init__(self) -> None:
        self.reference_speeds = [100.0] * 3  # deg/s; clients may change them
        self.start, self.target, self.since = [0.0] * 3, [0.0] * 3, time.monotonic()

    def encoders(self) -> list[float]:
        passed = time.monotonic() - self.since
        return [
            start + max(-speed * passed, min(speed * passed, target - start))
            for start, target, speed in zip(
                self.start, self.target, self.reference_speeds, strict=True
            )
        ]

    def position_move(self, joints: list[int], positions: list[float]) -> None:
        self.start, self.since = self.encoders(), time.monotonic()
        for joint, position in zip(joints, positions, strict=True):
            low, high = self.position_limits[joint]
            self.target[joint] = max(low, min(high, position))

    def motion_done(self) -> list[bool]:
        return [a == b for a, b in zip(self.encoders(), self.target, strict=True)]


def main() -> None:
    names = yarpy.LocalNames()
    with (
        ControlBoardServer("/robot/head", Head(), names=names),
        ControlBoard("/robot/head", names=names) as head,
    ):
        print(head, head.axis_names)
        head.position_move("yaw", 20.0)
        head.wait_motion_done(timeout=10)
        print("it went to", head.encoders())
        head.position_move(["pitch", "roll"], [90.0, -5.0])  # 90 is beyond its limit
        head.wait_motion_done(timeout=10)
        print("and then to", head.encoders(), "- its limits are", head.position_limits[0])


if __name__ == "__main__":
    main()
