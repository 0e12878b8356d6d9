"""A robot of ROS 2 over DDS, with the types of the library cyclonedds: a program of its own.

    python dds_robot.py STATES COMMANDS     two joints, which say where they are on one topic, and
                                            are at once where a trajectory on the other ends

Prints every trajectory as JSON: names, positions, seconds, and the time of its header.
"""

import json
import sys
from dataclasses import dataclass, field

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float64, int32, sequence, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Time_(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):  # noqa: N801
    sec: int32 = 0
    nanosec: uint32 = 0


@dataclass
class Duration_(IdlStruct, typename="builtin_interfaces.msg.dds_.Duration_"):  # noqa: N801
    sec: int32 = 0
    nanosec: uint32 = 0


@dataclass
class Header_(IdlStruct, typename="std_msgs.msg.dds_.Header_"):  # noqa: N801
    stamp: Time_ = field(default_factory=Time_)
    frame_id: str = ""


@dataclass
class JointState_(IdlStruct, typename="sensor_msgs.msg.dds_.JointState_"):  # noqa: N801
    header: Header_
    name: sequence[str]
    position: sequence[float64]
    velocity: sequence[float64]
    effort: sequence[float64]


@dataclass
class JointTrajectoryPoint_(  # noqa: N801
    IdlStruct, typename="trajectory_msgs.msg.dds_.JointTrajectoryPoint_"
):
    positions: sequence[float64]
    velocities: sequence[float64]
    accelerations: sequence[float64]
    effort: sequence[float64]
    time_from_start: Duration_


@dataclass
class JointTrajectory_(  # noqa: N801
    IdlStruct, typename="trajectory_msgs.msg.dds_.JointTrajectory_"
):
    header: Header_
    joint_names: sequence[str]
    points: sequence[JointTrajectoryPoint_]


def main(states: str, commands: str) -> None:
    part = DomainParticipant()
    qos = Qos(Policy.Reliability.Reliable(duration(milliseconds=100)), Policy.History.KeepLast(10))
    writer = DataWriter(part, Topic(part, f"rt{states}", JointState_), qos)
    reader = DataReader(part, Topic(part, f"rt{commands}", JointTrajectory_), qos)
    at = {"shoulder": 0.5, "finger": 0.01}
    while True:
        for told in reader.take_iter(timeout=duration(milliseconds=20)):
            point, stamp = told.points[-1], told.header.stamp
            at.update(zip(told.joint_names, point.positions, strict=True))
            seconds = point.time_from_start.sec + point.time_from_start.nanosec * 1e-9
            row = [told.joint_names, [*point.positions], seconds, stamp.sec + stamp.nanosec]
            print(json.dumps(row), flush=True)
        header = Header_(Time_(1234, 500_000_000))
        writer.write(JointState_(header, [*at], [*at.values()], [0.1] * 2, [2.0] * 2))


if __name__ == "__main__":
    main(*sys.argv[1:])
