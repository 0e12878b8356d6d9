"""Where the text of a type of ROS 2 comes from: installed packages, what rosbags brings, and a few
that are always there.

Rules: as in `rosmsg/source.py`. Of the distributions that rosbags knows, the one of ROS_DISTRO is
asked first; the others only for a type whose hash a peer has named.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from yarpy.idl.rosmsg.source import Packages

#: with type hashes, the newest first; a computer without ROS takes the one with the longest support
DISTROS: Final = ("lyrical", "kilted", "jazzy", "iron", "humble")
USUAL: Final = "jazzy"


def installed(environment: Mapping[str, str]) -> Packages:
    """The packages of the ROS 2 that an environment was set up for, or that is installed."""
    prefixes = environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    folders = [Path(prefix) for prefix in prefixes if prefix]
    if not folders:
        folders = sorted(Path("/opt/ros").glob("*"), reverse=True)
    return Packages((), [folder / "share" for folder in folders])


def distro(environment: Mapping[str, str]) -> str:
    """The distribution of an environment."""
    named = environment.get("ROS_DISTRO", "")
    return named if named in DISTROS else USUAL


class Rosbags:
    """The messages of a distribution that the package rosbags knows."""

    def __init__(self, name: str) -> None:
        self.name = name

    def find(self, name: str, kind: str) -> str | None:
        package, _, plain = name.partition("/")
        full = f"{package}/msg/{plain}"
        if kind != "msg" or self._store is None or full not in self._store.fielddefs:
            return None
        text: str = self._store.generate_msgdef(full, ros_version=2)[0]
        return text.partition("=" * 80)[0]

    @cached_property
    def _store(self) -> Any:
        try:
            from rosbags.typesys import Stores, get_typestore
        except ImportError:
            return None
        return get_typestore(Stores[f"ROS2_{self.name.upper()}"])

    def __str__(self) -> str:
        if self._store is None:
            return "rosbags, which is not installed (pip install 'yarpy[ros2]')"
        return f"the types of {self.name.title()} that rosbags brings"


class Standard:
    """The messages that yarpy's own types turn into, and the services that are asked for most."""

    def find(self, name: str, kind: str) -> str | None:
        return (MESSAGES if kind == "msg" else SERVICES).get(name)

    def __str__(self) -> str:
        return "the types that yarpy brings"


MESSAGES: Final = {
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec\n",
    "std_msgs/Empty": "",
    "std_msgs/String": "string data\n",
    "std_msgs/Bool": "bool data\n",
    "std_msgs/Int32": "int32 data\n",
    "std_msgs/Float64": "float64 data\n",
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "std_msgs/MultiArrayDimension": "string label\nuint32 size\nuint32 stride\n",
    "std_msgs/MultiArrayLayout": "MultiArrayDimension[] dim\nuint32 data_offset\n",
    "std_msgs/Float64MultiArray": "MultiArrayLayout layout\nfloat64[] data\n",
    "sensor_msgs/Image": """\
std_msgs/Header header
uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data
""",
    "sensor_msgs/CompressedImage": "std_msgs/Header header\nstring format\nuint8[] data\n",
    "sensor_msgs/JointState": """\
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
""",
    "sensor_msgs/PointField": """\
uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset
uint8 datatype
uint32 count
""",
    "sensor_msgs/PointCloud2": """\
std_msgs/Header header
uint32 height
uint32 width
PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
""",
    "audio_common_msgs/AudioData": "uint8[] data\n",
    # By which nodes are asked for types that nobody here knows.
    "type_description_interfaces/FieldType": """\
uint8 type_id 0
uint64 capacity
uint64 string_capacity
string<=255 nested_type_name
""",
    "type_description_interfaces/Field": "string name\nFieldType type\nstring default_value\n",
    "type_description_interfaces/IndividualTypeDescription": (
        "string<=255 type_name\nField[] fields\n"
    ),
    "type_description_interfaces/TypeDescription": """\
IndividualTypeDescription type_description
IndividualTypeDescription[] referenced_type_descriptions
""",
    "type_description_interfaces/TypeSource": """\
string type_name
string encoding
string raw_file_contents
""",
    "type_description_interfaces/KeyValue": "string key\nstring value\n",
}

SERVICES: Final = {
    "std_srvs/Empty": "---\n",
    "std_srvs/Trigger": "---\nbool success\nstring message\n",
    "std_srvs/SetBool": "bool data\n---\nbool success\nstring message\n",
    "type_description_interfaces/GetTypeDescription": """\
string type_name
string type_hash
bool include_type_sources true
---
bool successful
string failure_reason
TypeDescription type_description
TypeSource[] type_sources
KeyValue[] extra_information
""",
    "example_interfaces/AddTwoInts": "int64 a\nint64 b\n---\nint64 sum\n",
}
