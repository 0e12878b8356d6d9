"""A node that hears of frames over DDS, with the types of the library cyclonedds: its own program.

python dds_frames.py TOPIC      prints each TFMessage as JSON, until its input ends
"""

import json
import sys
import threading
from dataclasses import asdict, dataclass, field
from pathlib import Path

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float64, sequence
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.dds_robot import Header_


@dataclass
class Vector3_(IdlStruct, typename="geometry_msgs.msg.dds_.Vector3_"):  # noqa: N801
    x: float64 = 0
    y: float64 = 0
    z: float64 = 0


@dataclass
class Quaternion_(IdlStruct, typename="geometry_msgs.msg.dds_.Quaternion_"):  # noqa: N801
    x: float64 = 0
    y: float64 = 0
    z: float64 = 0
    w: float64 = 1


@dataclass
class Transform_(IdlStruct, typename="geometry_msgs.msg.dds_.Transform_"):  # noqa: N801
    translation: Vector3_ = field(default_factory=Vector3_)
    rotation: Quaternion_ = field(default_factory=Quaternion_)


@dataclass
class TransformStamped_(  # noqa: N801
    IdlStruct, typename="geometry_msgs.msg.dds_.TransformStamped_"
):
    header: Header_
    child_frame_id: str
    transform: Transform_


@dataclass
class TFMessage_(IdlStruct, typename="tf2_msgs.msg.dds_.TFMessage_"):  # noqa: N801
    transforms: sequence[TransformStamped_]


def main(topic: str) -> None:
    part = DomainParticipant()
    qos = Qos(Policy.Reliability.Reliable(duration(milliseconds=100)), Policy.History.KeepLast(100))
    reader = DataReader(part, Topic(part, f"rt{topic}", TFMessage_), qos)
    ended = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
    while not ended.is_set():
        for message in reader.take_iter(timeout=duration(milliseconds=20)):
            print(json.dumps(asdict(message)), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
