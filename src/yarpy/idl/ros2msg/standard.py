"""The definitions that are always there in ROS 2: those of ROS 1 under its rules, and what nodes
ask each other for.

Rules: declarations alone, as in `rosmsg/standard.py`.
"""

from __future__ import annotations

from typing import Final

from yarpy.idl.rosmsg import standard

MESSAGES: Final = {
    **{
        name: text.replace("Header header", "std_msgs/Header header")
        for name, text in standard.MESSAGES.items()
    },
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec\n",
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
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
    **{name: text for name, text in standard.SERVICES.items() if name.startswith("std_srvs/")},
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
