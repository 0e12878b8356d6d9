"""The definitions that are always there in ROS 2: those of ROS 1 under its rules, what nodes ask
each other for (types, parameters, actions), and the examples.

Rules: declarations alone, as in `ros/message/standard.py`.
"""

from __future__ import annotations

from typing import Final

from yarpy.peers.ros.message import standard
from yarpy.peers.ros.message.shipped import geometry
from yarpy.peers.ros.message.shipped.action import spelled

#: messages of example_interfaces, which are those of std_msgs but for its Header and ColorRGBA
_EXAMPLES: Final = {
    **{
        f"{name}MultiArray": f"MultiArrayLayout layout; {name.lower()}[] data"
        for name in ("Byte", "Float32", "Float64", "Int8", "Int16", "Int32", "Int64")
    },
    **{
        f"U{name}MultiArray": f"MultiArrayLayout layout; u{name.lower()}[] data"
        for name in ("Int8", "Int16", "Int32", "Int64")
    },
    **{
        name: f"{name.lower()} data"
        for name in ("Bool", "Byte", "Char", "Float32", "Float64", "String", "WString")
    },
    **{name: f"{name.lower()} data" for name in ("Int8", "Int16", "Int32", "Int64")},
    **{f"U{name}": f"u{name.lower()} data" for name in ("Int8", "Int16", "Int32", "Int64")},
    "Empty": "",
    "MultiArrayDimension": "string label; uint32 size; uint32 stride",
    "MultiArrayLayout": "MultiArrayDimension[] dim; uint32 data_offset",
}

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
    **{
        name: spelled(text)
        for name, text in {
            **{f"example_interfaces/{name}": text for name, text in _EXAMPLES.items()},
            "rmw_dds_common/Gid": "char[16] data",
            "rmw_dds_common/NodeEntitiesInfo": (
                "string<=256 node_namespace; string<=256 node_name; Gid[] reader_gid_seq; "
                "Gid[] writer_gid_seq"
            ),
            "rmw_dds_common/ParticipantEntitiesInfo": (
                "Gid gid; NodeEntitiesInfo[] node_entities_info_seq"
            ),
            "unique_identifier_msgs/UUID": "uint8[16] uuid",
            "action_msgs/GoalInfo": (
                "unique_identifier_msgs/UUID goal_id; builtin_interfaces/Time stamp"
            ),
            "action_msgs/GoalStatus": (
                "int8 STATUS_UNKNOWN=0; int8 STATUS_ACCEPTED=1; int8 STATUS_EXECUTING=2; "
                "int8 STATUS_CANCELING=3; int8 STATUS_SUCCEEDED=4; int8 STATUS_CANCELED=5; "
                "int8 STATUS_ABORTED=6; GoalInfo goal_info; int8 status"
            ),
            "action_msgs/GoalStatusArray": "GoalStatus[] status_list",
            "rcl_interfaces/FloatingPointRange": (
                "float64 from_value; float64 to_value; float64 step"
            ),
            "rcl_interfaces/IntegerRange": "int64 from_value; int64 to_value; uint64 step",
            "rcl_interfaces/Log": (
                "byte DEBUG=10; byte INFO=20; byte WARN=30; byte ERROR=40; byte FATAL=50; "
                "builtin_interfaces/Time stamp; uint8 level; string name; string msg; "
                "string file; string function; uint32 line"
            ),
            "rcl_interfaces/ListParametersResult": "string[] names; string[] prefixes",
            "rcl_interfaces/LoggerLevel": (
                "uint8 LOG_LEVEL_UNKNOWN=0; uint8 LOG_LEVEL_DEBUG=10; uint8 LOG_LEVEL_INFO=20; "
                "uint8 LOG_LEVEL_WARN=30; uint8 LOG_LEVEL_ERROR=40; uint8 LOG_LEVEL_FATAL=50; "
                "string name; uint32 level"
            ),
            "rcl_interfaces/SetLoggerLevelsResult": "bool successful; string reason",
            "rcl_interfaces/Parameter": "string name; ParameterValue value",
            "rcl_interfaces/ParameterDescriptor": (
                "string name; uint8 type; string description; string additional_constraints; "
                "bool read_only false; bool dynamic_typing false; "
                "FloatingPointRange[<=1] floating_point_range; IntegerRange[<=1] integer_range"
            ),
            "rcl_interfaces/ParameterEvent": (
                "builtin_interfaces/Time stamp; string node; Parameter[] new_parameters; "
                "Parameter[] changed_parameters; Parameter[] deleted_parameters"
            ),
            "rcl_interfaces/ParameterType": (
                "uint8 PARAMETER_NOT_SET=0; uint8 PARAMETER_BOOL=1; uint8 PARAMETER_INTEGER=2; "
                "uint8 PARAMETER_DOUBLE=3; uint8 PARAMETER_STRING=4; "
                "uint8 PARAMETER_BYTE_ARRAY=5; uint8 PARAMETER_BOOL_ARRAY=6; "
                "uint8 PARAMETER_INTEGER_ARRAY=7; uint8 PARAMETER_DOUBLE_ARRAY=8; "
                "uint8 PARAMETER_STRING_ARRAY=9"
            ),
            "rcl_interfaces/ParameterValue": (
                "uint8 type; bool bool_value; int64 integer_value; float64 double_value; "
                "string string_value; byte[] byte_array_value; bool[] bool_array_value; "
                "int64[] integer_array_value; float64[] double_array_value; "
                "string[] string_array_value"
            ),
            "rcl_interfaces/SetParametersResult": "bool successful; string reason",
            "lifecycle_msgs/State": "uint8 id; string label",
            "lifecycle_msgs/Transition": "uint8 id; string label",
            "lifecycle_msgs/TransitionDescription": (
                "Transition transition; State start_state; State goal_state"
            ),
            "lifecycle_msgs/TransitionEvent": (
                "uint64 timestamp; Transition transition; State start_state; State goal_state"
            ),
        }.items()
    },
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
    **{
        name: spelled(text)
        for name, text in {
            "action_msgs/CancelGoal": (
                "GoalInfo goal_info; ---; int8 ERROR_NONE=0; int8 ERROR_REJECTED=1; "
                "int8 ERROR_UNKNOWN_GOAL_ID=2; int8 ERROR_GOAL_TERMINATED=3; "
                "int8 return_code; GoalInfo[] goals_canceling"
            ),
            # Of packages whose messages rosbags brings, or an installed ROS.
            **{
                name: text
                for name, text in geometry.SERVICES.items()
                if name.startswith(("nav_msgs/", "tf2_msgs/"))
            },
            "diagnostic_msgs/AddDiagnostics": (
                "string load_namespace; ---; bool success; string message"
            ),
            "diagnostic_msgs/SelfTest": "---; string id; byte passed; DiagnosticStatus[] status",
            "sensor_msgs/SetCameraInfo": (
                "sensor_msgs/CameraInfo camera_info; ---; bool success; string status_message"
            ),
            "visualization_msgs/GetInteractiveMarkers": (
                "---; uint64 sequence_number; InteractiveMarker[] markers"
            ),
            "example_interfaces/SetBool": "bool data; ---; bool success; string message",
            "example_interfaces/Trigger": "---; bool success; string message",
            "lifecycle_msgs/ChangeState": "Transition transition; ---; bool success",
            "lifecycle_msgs/GetState": "---; State current_state",
            "lifecycle_msgs/GetAvailableStates": "---; State[] available_states",
            "lifecycle_msgs/GetAvailableTransitions": (
                "---; TransitionDescription[] available_transitions"
            ),
            "rcl_interfaces/DescribeParameters": (
                "string[] names; ---; ParameterDescriptor[] descriptors"
            ),
            "rcl_interfaces/GetLoggerLevels": "string[] names; ---; LoggerLevel[] levels",
            "rcl_interfaces/SetLoggerLevels": (
                "LoggerLevel[] levels; ---; SetLoggerLevelsResult[] results"
            ),
            "rcl_interfaces/GetParameters": "string[] names; ---; ParameterValue[] values",
            "rcl_interfaces/GetParameterTypes": "string[] names; ---; uint8[] types",
            "rcl_interfaces/ListParameters": (
                "uint64 DEPTH_RECURSIVE=0; string[] prefixes; uint64 depth; ---; "
                "ListParametersResult result"
            ),
            "rcl_interfaces/SetParameters": (
                "Parameter[] parameters; ---; SetParametersResult[] results"
            ),
            "rcl_interfaces/SetParametersAtomically": (
                "Parameter[] parameters; ---; SetParametersResult result"
            ),
        }.items()
    },
}

#: goal, result and feedback
ACTIONS: Final = {
    "example_interfaces/Fibonacci": spelled(
        "int32 order; ---; int32[] sequence; ---; int32[] sequence"
    ),
}
