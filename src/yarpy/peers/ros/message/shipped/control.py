"""Trajectories of joints, grippers; actions, diagnostics, the clock, the log; parameters of
dynamic_reconfigure; tutorials.

Rules: as in `shipped/__init__.py`.
"""

from __future__ import annotations

from typing import Final

MESSAGES: Final = {
    "trajectory_msgs/JointTrajectory": (
        "Header header; string[] joint_names; JointTrajectoryPoint[] points"
    ),
    "trajectory_msgs/JointTrajectoryPoint": (
        "float64[] positions; float64[] velocities; float64[] accelerations; "
        "float64[] effort; duration time_from_start"
    ),
    "trajectory_msgs/MultiDOFJointTrajectory": (
        "Header header; string[] joint_names; MultiDOFJointTrajectoryPoint[] points"
    ),
    "trajectory_msgs/MultiDOFJointTrajectoryPoint": (
        "geometry_msgs/Transform[] transforms; geometry_msgs/Twist[] velocities; "
        "geometry_msgs/Twist[] accelerations; duration time_from_start"
    ),
    "actionlib_msgs/GoalID": "time stamp; string id",
    "actionlib_msgs/GoalStatus": (
        "GoalID goal_id; uint8 status; uint8 PENDING=0; uint8 ACTIVE=1; uint8 PREEMPTED=2; "
        "uint8 SUCCEEDED=3; uint8 ABORTED=4; uint8 REJECTED=5; uint8 PREEMPTING=6; "
        "uint8 RECALLING=7; uint8 RECALLED=8; uint8 LOST=9; string text"
    ),
    "actionlib_msgs/GoalStatusArray": "Header header; GoalStatus[] status_list",
    "diagnostic_msgs/DiagnosticArray": "Header header; DiagnosticStatus[] status",
    "diagnostic_msgs/DiagnosticStatus": (
        "byte OK=0; byte WARN=1; byte ERROR=2; byte STALE=3; byte level; string name; "
        "string message; string hardware_id; KeyValue[] values"
    ),
    "diagnostic_msgs/KeyValue": "string key; string value",
    "rosgraph_msgs/Clock": "time clock",
    "rosgraph_msgs/Log": (
        "byte DEBUG=1; byte INFO=2; byte WARN=4; byte ERROR=8; byte FATAL=16; Header header; "
        "byte level; string name; string msg; string file; string function; uint32 line; "
        "string[] topics"
    ),
    "rosgraph_msgs/TopicStatistics": (
        "string topic; string node_pub; string node_sub; time window_start; time window_stop; "
        "int32 delivered_msgs; int32 dropped_msgs; int32 traffic; duration period_mean; "
        "duration period_stddev; duration period_max; duration stamp_age_mean; "
        "duration stamp_age_stddev; duration stamp_age_max"
    ),
    "control_msgs/GripperCommand": "float64 position; float64 max_effort",
    "control_msgs/JointControllerState": (
        "Header header; float64 set_point; float64 process_value; float64 process_value_dot; "
        "float64 error; float64 time_step; float64 command; float64 p; float64 i; float64 d; "
        "float64 i_clamp; bool antiwindup"
    ),
    "control_msgs/JointJog": (
        "Header header; string[] joint_names; float64[] displacements; float64[] velocities; "
        "float64 duration"
    ),
    "control_msgs/JointTolerance": (
        "string name; float64 position; float64 velocity; float64 acceleration"
    ),
    "control_msgs/JointTrajectoryControllerState": (
        "Header header; string[] joint_names; trajectory_msgs/JointTrajectoryPoint desired; "
        "trajectory_msgs/JointTrajectoryPoint actual; "
        "trajectory_msgs/JointTrajectoryPoint error"
    ),
    "control_msgs/PidState": (
        "Header header; duration timestep; float64 error; float64 error_dot; float64 p_error; "
        "float64 i_error; float64 d_error; float64 p_term; float64 i_term; float64 d_term; "
        "float64 i_max; float64 i_min; float64 output"
    ),
    "rospy_tutorials/Floats": "float32[] data",
    "rospy_tutorials/HeaderString": "Header header; string data",
    "roscpp/Logger": "string name; string level",
    "dynamic_reconfigure/BoolParameter": "string name; bool value",
    "dynamic_reconfigure/DoubleParameter": "string name; float64 value",
    "dynamic_reconfigure/IntParameter": "string name; int32 value",
    "dynamic_reconfigure/StrParameter": "string name; string value",
    "dynamic_reconfigure/GroupState": "string name; bool state; int32 id; int32 parent",
    "dynamic_reconfigure/Config": (
        "BoolParameter[] bools; IntParameter[] ints; StrParameter[] strs; "
        "DoubleParameter[] doubles; GroupState[] groups"
    ),
    "dynamic_reconfigure/ParamDescription": (
        "string name; string type; uint32 level; string description; string edit_method"
    ),
    "dynamic_reconfigure/Group": (
        "string name; string type; ParamDescription[] parameters; int32 parent; int32 id"
    ),
    "dynamic_reconfigure/ConfigDescription": "Group[] groups; Config max; Config min; Config dflt",
}

SERVICES: Final = {
    "diagnostic_msgs/AddDiagnostics": "string load_namespace; ---; bool success; string message",
    "diagnostic_msgs/SelfTest": "---; string id; byte passed; DiagnosticStatus[] status",
    "control_msgs/QueryCalibrationState": "---; bool is_calibrated",
    "control_msgs/QueryTrajectoryState": (
        "time time; ---; string[] name; float64[] position; float64[] velocity; "
        "float64[] acceleration"
    ),
    "dynamic_reconfigure/Reconfigure": "Config config; ---; Config config",
    "roscpp/Empty": "---",
    "roscpp/GetLoggers": "---; Logger[] loggers",
    "roscpp/SetLoggerLevel": "string logger; string level; ---",
    "roscpp_tutorials/TwoInts": "int64 a; int64 b; ---; int64 sum",
    "rospy_tutorials/AddTwoInts": "int64 a; int64 b; ---; int64 sum",
    "rospy_tutorials/BadTwoInts": "int64 a; int32 b; ---; int32 sum",
}

ACTIONS: Final = {
    "actionlib/Test": "int32 goal; ---; int32 result; ---; int32 feedback",
    "actionlib_tutorials/Averaging": (
        "int32 samples; ---; float32 mean; float32 std_dev; ---; int32 sample; float32 data; "
        "float32 mean; float32 std_dev"
    ),
    "actionlib_tutorials/Fibonacci": "int32 order; ---; int32[] sequence; ---; int32[] sequence",
    "control_msgs/FollowJointTrajectory": (
        "trajectory_msgs/JointTrajectory trajectory; JointTolerance[] path_tolerance; "
        "JointTolerance[] goal_tolerance; duration goal_time_tolerance; ---; "
        "int32 error_code; int32 SUCCESSFUL=0; int32 INVALID_GOAL=-1; "
        "int32 INVALID_JOINTS=-2; int32 OLD_HEADER_TIMESTAMP=-3; "
        "int32 PATH_TOLERANCE_VIOLATED=-4; int32 GOAL_TOLERANCE_VIOLATED=-5; "
        "string error_string; ---; Header header; string[] joint_names; "
        "trajectory_msgs/JointTrajectoryPoint desired; "
        "trajectory_msgs/JointTrajectoryPoint actual; "
        "trajectory_msgs/JointTrajectoryPoint error"
    ),
    "control_msgs/GripperCommand": (
        "GripperCommand command; ---; float64 position; float64 effort; bool stalled; "
        "bool reached_goal; ---; float64 position; float64 effort; bool stalled; "
        "bool reached_goal"
    ),
    "control_msgs/JointTrajectory": "trajectory_msgs/JointTrajectory trajectory; ---; ---",
    "control_msgs/PointHead": (
        "geometry_msgs/PointStamped target; geometry_msgs/Vector3 pointing_axis; "
        "string pointing_frame; duration min_duration; float64 max_velocity; ---; ---; "
        "float64 pointing_angle_error"
    ),
    "control_msgs/SingleJointPosition": (
        "float64 position; duration min_duration; float64 max_velocity; ---; ---; "
        "Header header; float64 position; float64 velocity; float64 error"
    ),
}
