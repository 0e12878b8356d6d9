"""The frames of the simulated head, as a peer printed them, beside our kinematics."""

from __future__ import annotations

import json
from typing import Any

from support.process import Process
from support.wait import HANG, wait_until

from yarpy.kits.sim import rotation as of
from yarpy.kits.sim.head import Side, eye_pose
from yarpy.kits.sim.robot import Robot
from yarpy.peers.ros.transform.pose import Pose

AT = {2: 30.0, 0: -10.0, 4: 5.0, 3: 8.0}  # degrees of joints


def turned(robot: Robot) -> list[float]:
    """Let the head look somewhere; return where its joints are once it does."""
    board: Any = robot.parts.boards["head"]
    board.position_move([*AT], [*AT.values()])
    wait_until(
        lambda: all(abs(board.encoders()[joint] - AT[joint]) < 1e-9 for joint in AT), HANG, "there"
    )
    found: list[float] = board.encoders()
    return found


def messages(peer: Process) -> list[dict[str, Any]]:
    """What a peer has printed: objects."""
    return [json.loads(line) for line in peer.stdout.splitlines() if line.startswith("{")]


def sees_the_eyes(peer: Process, model: str, angles: list[float]) -> None:
    """Wait until what a peer has printed of /tf says where the eyes are with the joints at
    `angles`, and when."""
    sides: tuple[Side, Side] = ("left", "right")

    def right() -> bool:
        for message in messages(peer)[-20:]:
            frames = {each["child_frame_id"]: each for each in message["transforms"]}
            if f"{model}/cam/left" in frames:  # else it is of another robot
                return all(
                    near(placed(frames, f"{model}/cam/{side}", f"{model}/root_link"), angles, side)
                    for side in sides
                )
        return False

    wait_until(right, 2 * HANG, "the eyes are where they are")
    stamps = [
        each["header"]["stamp"] for message in messages(peer) for each in message["transforms"]
    ]
    assert all(stamp["sec"] > 1e9 and 0 <= stamp["nanosec"] < 1e9 for stamp in stamps)


def placed(frames: dict[str, Any], name: str, root: str) -> Pose:
    """The pose of a frame in the root."""
    found = Pose()
    while name != root:
        transform = frames[name]["transform"]
        found = Pose(_numbers(transform["translation"]), _numbers(transform["rotation"])) @ found
        name = frames[name]["header"]["frame_id"]
    return found


def near(found: Pose, angles: list[float], side: Side) -> bool:
    """Whether that is the eye's place, of which the pictures are drawn."""
    wanted = eye_pose(angles, side)
    same = sum(a * b for a, b in zip(found.turned, of.quaternion(wanted.rotation), strict=True))
    away = max(abs(a - b) for a, b in zip(found.at, wanted.position, strict=True))
    return away < 1e-9 and abs(abs(same) - 1) < 1e-9


def _numbers(fields: dict[str, float]) -> Any:
    return tuple(fields.values())
