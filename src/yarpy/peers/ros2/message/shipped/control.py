"""Controllers of joints, grippers and wheels: what ros2_control is asked and tells; and the turtle
of the tutorials.

Rules: as in `shipped/__init__.py`; of control_msgs 5.8.0 and turtlesim 1.8.2.
"""

from __future__ import annotations

from typing import Final

MESSAGES: Final = {
    "control_msgs/AdmittanceControllerState": (
        "std_msgs/Float64MultiArray mass; std_msgs/Float64MultiArray damping; "
        "std_msgs/Float64MultiArray stiffness; geometry_msgs/Quaternion rot_base_control; "
        "geometry_msgs/TransformStamped ref_trans_base_ft; std_msgs/Int8MultiArray selected_axes; "
        "std_msgs/String ft_sensor_frame; geometry_msgs/TransformStamped admittance_position; "
        "geometry_msgs/TwistStamped admittance_acceleration; "
        "geometry_msgs/TwistStamped admittance_velocity; geometry_msgs/WrenchStamped wrench_base; "
        "sensor_msgs/JointState joint_state"
    ),
    "control_msgs/BatteryStateArray": "sensor_msgs/BatteryState[] battery_states",
    "control_msgs/DynamicInterfaceGroupValues": (
        "std_msgs/Header header; string[] interface_groups; InterfaceValue[] interface_values"
    ),
    "control_msgs/DynamicInterfaceValues": (
        "std_msgs/Header header; InterfaceValue states; InterfaceValue commands"
    ),
    "control_msgs/DynamicJointState": (
        "std_msgs/Header header; string[] joint_names; InterfaceValue[] interface_values"
    ),
    "control_msgs/Float64Values": "std_msgs/Header header; float64[] values",
    "control_msgs/GripperCommand": "float64 position; float64 max_effort",
    "control_msgs/InterfaceValue": "string[] interface_names; float64[] values",
    "control_msgs/JointComponentTolerance": (
        "uint16 X_AXIS=1; uint16 Y_AXIS=2; uint16 Z_AXIS=3; uint16 TRANSLATION=4; "
        "uint16 ROTATION=5; string joint_name; uint16 component; float64 position; "
        "float64 velocity; float64 acceleration"
    ),
    "control_msgs/JointControllerState": (
        "std_msgs/Header header; float64 set_point; float64 process_value; "
        "float64 process_value_dot; float64 error; float64 time_step; float64 command; float64 p; "
        "float64 i; float64 d; float64 i_clamp; bool antiwindup"
    ),
    "control_msgs/JointJog": (
        "std_msgs/Header header; string[] joint_names; float64[] displacements; "
        "float64[] velocities; float64 duration"
    ),
    "control_msgs/JointTolerance": (
        "string name; float64 position; float64 velocity; float64 acceleration"
    ),
    "control_msgs/JointTrajectoryControllerState": (
        "std_msgs/Header header; string[] joint_names; "
        "trajectory_msgs/JointTrajectoryPoint reference; "
        "trajectory_msgs/JointTrajectoryPoint feedback; "
        "trajectory_msgs/JointTrajectoryPoint error; trajectory_msgs/JointTrajectoryPoint output; "
        "string[] multi_dof_joint_names; "
        "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_reference; "
        "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_feedback; "
        "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_error; "
        "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_output; "
        "float64 speed_scaling_factor"
    ),
    "control_msgs/Keys": "std_msgs/Header header; string[] keys",
    "control_msgs/MecanumDriveControllerState": (
        "std_msgs/Header header; float64 front_left_wheel_velocity; "
        "float64 back_left_wheel_velocity; float64 back_right_wheel_velocity; "
        "float64 front_right_wheel_velocity; geometry_msgs/Twist reference_velocity"
    ),
    "control_msgs/MotionArgument": "string name; float64 value",
    "control_msgs/MotionPrimitive": (
        "int8 UNKNOWN=-1; int8 LINEAR_JOINT=0; int8 LINEAR_CARTESIAN=50; "
        "int8 CIRCULAR_CARTESIAN=51; int8 type -1; float64 blend_radius; "
        "MotionArgument[] additional_arguments; geometry_msgs/PoseStamped[] poses; "
        "float64[] joint_positions"
    ),
    "control_msgs/MotionPrimitiveSequence": "MotionPrimitive[] motions",
    "control_msgs/MultiDOFCommand": "string[] dof_names; float64[] values; float64[] values_dot",
    "control_msgs/MultiDOFStateStamped": "std_msgs/Header header; SingleDOFState[] dof_states",
    "control_msgs/PidState": (
        "std_msgs/Header header; builtin_interfaces/Duration timestep; float64 error; "
        "float64 error_dot; float64 p_error; float64 i_error; float64 d_error; float64 p_term; "
        "float64 i_term; float64 d_term; float64 i_max; float64 i_min; float64 output"
    ),
    "control_msgs/SingleDOFState": (
        "string name; float64 reference; float64 feedback; float64 feedback_dot; float64 error; "
        "float64 error_dot; float64 time_step; float64 output"
    ),
    "control_msgs/SingleDOFStateStamped": "std_msgs/Header header; SingleDOFState dof_state",
    "control_msgs/SpeedScalingFactor": "float64 factor",
    "control_msgs/SteeringControllerStatus": (
        "std_msgs/Header header; float64[] traction_wheels_position; "
        "float64[] traction_wheels_velocity; float64[] steer_positions; "
        "float64[] linear_velocity_command; float64[] steering_angle_command"
    ),
    "control_msgs/VDA5050SafetyState": (
        'string e_stop; bool field_violation; string AUTO_ACK="autoAck"; '
        'string MANUAL="manual"; string REMOTE="remote"; string NONE="none"'
    ),
    "turtlesim/Color": "uint8 r; uint8 g; uint8 b",
    "turtlesim/Pose": (
        "float32 x; float32 y; float32 theta; float32 linear_velocity; float32 angular_velocity"
    ),
}

SERVICES: Final = {
    "control_msgs/QueryCalibrationState": "---; bool is_calibrated",
    "control_msgs/QueryTrajectoryState": (
        "builtin_interfaces/Time time; ---; bool success; string message; string[] name; "
        "float64[] position; float64[] velocity; float64[] acceleration"
    ),
    "control_msgs/SetOdometry": (
        "float64 x; float64 y; float64 z; float64 roll; float64 pitch; float64 yaw; ---; "
        "bool success; string message"
    ),
    "turtlesim/Kill": "string name; ---",
    "turtlesim/SetPen": "uint8 r; uint8 g; uint8 b; uint8 width; uint8 off; ---",
    "turtlesim/Spawn": "float32 x; float32 y; float32 theta; string name; ---; string name",
    "turtlesim/TeleportAbsolute": "float32 x; float32 y; float32 theta; ---",
    "turtlesim/TeleportRelative": "float32 linear; float32 angular; ---",
}

ACTIONS: Final = {
    "control_msgs/ExecuteMotionPrimitiveSequence": (
        "MotionPrimitiveSequence trajectory; ---; int32 SUCCESSFUL=0; int32 INVALID_GOAL=-1; "
        "int32 OLD_HEADER_TIMESTAMP=-3; int32 error_code; string error_string; ---; "
        "uint8 current_primitive_index"
    ),
    "control_msgs/FollowJointTrajectory": (
        "trajectory_msgs/JointTrajectory trajectory; "
        "trajectory_msgs/MultiDOFJointTrajectory multi_dof_trajectory; "
        "JointTolerance[] path_tolerance; JointComponentTolerance[] component_path_tolerance; "
        "JointTolerance[] goal_tolerance; JointComponentTolerance[] component_goal_tolerance; "
        "builtin_interfaces/Duration goal_time_tolerance; ---; int32 error_code; "
        "int32 SUCCESSFUL=0; int32 INVALID_GOAL=-1; int32 INVALID_JOINTS=-2; "
        "int32 OLD_HEADER_TIMESTAMP=-3; int32 PATH_TOLERANCE_VIOLATED=-4; "
        "int32 GOAL_TOLERANCE_VIOLATED=-5; string error_string; ---; std_msgs/Header header; "
        "string[] joint_names; trajectory_msgs/JointTrajectoryPoint desired; "
        "trajectory_msgs/JointTrajectoryPoint actual; trajectory_msgs/JointTrajectoryPoint error; "
        "string[] multi_dof_joint_names; "
        "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_desired; "
        "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_actual; "
        "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_error"
    ),
    "control_msgs/GripperCommand": (
        "GripperCommand command; ---; float64 position; float64 effort; bool stalled; "
        "bool reached_goal; ---; float64 position; float64 effort; bool stalled; bool reached_goal"
    ),
    "control_msgs/JointTrajectory": "trajectory_msgs/JointTrajectory trajectory; ---; ---",
    "control_msgs/ParallelGripperCommand": (
        "sensor_msgs/JointState command; ---; sensor_msgs/JointState state; bool stalled; "
        "bool reached_goal; ---; sensor_msgs/JointState state"
    ),
    "control_msgs/PointHead": (
        "geometry_msgs/PointStamped target; geometry_msgs/Vector3 pointing_axis; "
        "string pointing_frame; builtin_interfaces/Duration min_duration; float64 max_velocity; "
        "---; ---; float64 pointing_angle_error"
    ),
    "control_msgs/SingleJointPosition": (
        "float64 position; builtin_interfaces/Duration min_duration; float64 max_velocity; ---; "
        "---; std_msgs/Header header; float64 position; float64 velocity; float64 error"
    ),
    "turtlesim/RotateAbsolute": "float32 theta; ---; float32 delta; ---; float32 remaining",
}
