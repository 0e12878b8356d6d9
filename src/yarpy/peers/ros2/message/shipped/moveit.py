"""Planning with MoveIt: states, constraints, scenes, plans, grasps, and what they are made of.

Rules: as in `shipped/__init__.py`; of moveit_msgs 2.6.0.
"""

from __future__ import annotations

from typing import Final

MESSAGES: Final = {
    "object_recognition_msgs/ObjectType": "string key; string db",
    "octomap_msgs/Octomap": (
        "std_msgs/Header header; bool binary; string id; float64 resolution; int8[] data"
    ),
    "octomap_msgs/OctomapWithPose": (
        "std_msgs/Header header; geometry_msgs/Pose origin; octomap_msgs/Octomap octomap"
    ),
    "moveit_msgs/AllowedCollisionEntry": "bool[] enabled",
    "moveit_msgs/AllowedCollisionMatrix": (
        "string[] entry_names; AllowedCollisionEntry[] entry_values; string[] default_entry_names; "
        "bool[] default_entry_values"
    ),
    "moveit_msgs/AttachedCollisionObject": (
        "string link_name; CollisionObject object; string[] touch_links; "
        "trajectory_msgs/JointTrajectory detach_posture; float64 weight"
    ),
    "moveit_msgs/BoundingVolume": (
        "shape_msgs/SolidPrimitive[] primitives; geometry_msgs/Pose[] primitive_poses; "
        "shape_msgs/Mesh[] meshes; geometry_msgs/Pose[] mesh_poses"
    ),
    "moveit_msgs/CartesianPoint": (
        "geometry_msgs/Pose pose; geometry_msgs/Twist velocity; geometry_msgs/Accel acceleration"
    ),
    "moveit_msgs/CartesianTrajectory": (
        "std_msgs/Header header; string tracked_frame; CartesianTrajectoryPoint[] points"
    ),
    "moveit_msgs/CartesianTrajectoryPoint": (
        "CartesianPoint point; builtin_interfaces/Duration time_from_start"
    ),
    "moveit_msgs/CollisionObject": (
        "std_msgs/Header header; geometry_msgs/Pose pose; string id; "
        "object_recognition_msgs/ObjectType type; shape_msgs/SolidPrimitive[] primitives; "
        "geometry_msgs/Pose[] primitive_poses; shape_msgs/Mesh[] meshes; "
        "geometry_msgs/Pose[] mesh_poses; shape_msgs/Plane[] planes; "
        "geometry_msgs/Pose[] plane_poses; string[] subframe_names; "
        "geometry_msgs/Pose[] subframe_poses; byte ADD=0; byte REMOVE=1; byte APPEND=2; "
        "byte MOVE=3; byte operation"
    ),
    "moveit_msgs/ConstraintEvalResult": "bool result; float64 distance",
    "moveit_msgs/Constraints": (
        "string name; JointConstraint[] joint_constraints; "
        "PositionConstraint[] position_constraints; "
        "OrientationConstraint[] orientation_constraints; "
        "VisibilityConstraint[] visibility_constraints"
    ),
    "moveit_msgs/ContactInformation": (
        "std_msgs/Header header; geometry_msgs/Point position; geometry_msgs/Vector3 normal; "
        "float64 depth; string contact_body_1; uint32 body_type_1; string contact_body_2; "
        "uint32 body_type_2; uint32 ROBOT_LINK=0; uint32 WORLD_OBJECT=1; uint32 ROBOT_ATTACHED=2"
    ),
    "moveit_msgs/CostSource": (
        "float64 cost_density; geometry_msgs/Vector3 aabb_min; geometry_msgs/Vector3 aabb_max"
    ),
    "moveit_msgs/DisplayRobotState": "RobotState state; ObjectColor[] highlight_links; bool hide",
    "moveit_msgs/DisplayTrajectory": (
        "string model_id; RobotTrajectory[] trajectory; RobotState trajectory_start"
    ),
    "moveit_msgs/GenericTrajectory": (
        "std_msgs/Header header; trajectory_msgs/JointTrajectory[] joint_trajectory; "
        "moveit_msgs/CartesianTrajectory[] cartesian_trajectory"
    ),
    "moveit_msgs/Grasp": (
        "string id; trajectory_msgs/JointTrajectory pre_grasp_posture; "
        "trajectory_msgs/JointTrajectory grasp_posture; geometry_msgs/PoseStamped grasp_pose; "
        "float64 grasp_quality; GripperTranslation pre_grasp_approach; "
        "GripperTranslation post_grasp_retreat; GripperTranslation post_place_retreat; "
        "float32 max_contact_force; string[] allowed_touch_objects"
    ),
    "moveit_msgs/GripperTranslation": (
        "geometry_msgs/Vector3Stamped direction; float32 desired_distance; float32 min_distance"
    ),
    "moveit_msgs/JointConstraint": (
        "string joint_name; float64 position; float64 tolerance_above; float64 tolerance_below; "
        "float64 weight"
    ),
    "moveit_msgs/JointLimits": (
        "string joint_name; bool has_position_limits; float64 min_position; float64 max_position; "
        "bool has_velocity_limits; float64 max_velocity; bool has_acceleration_limits; "
        "float64 max_acceleration; bool has_jerk_limits; float64 max_jerk"
    ),
    "moveit_msgs/KinematicSolverInfo": (
        "string[] joint_names; moveit_msgs/JointLimits[] limits; string[] link_names"
    ),
    "moveit_msgs/LinkPadding": "string link_name; float64 padding",
    "moveit_msgs/LinkScale": "string link_name; float64 scale",
    "moveit_msgs/MotionPlanDetailedResponse": (
        "RobotState trajectory_start; string group_name; RobotTrajectory[] trajectory; "
        "string[] description; float64[] processing_time; MoveItErrorCodes error_code"
    ),
    "moveit_msgs/MotionPlanRequest": (
        "WorkspaceParameters workspace_parameters; RobotState start_state; "
        "Constraints[] goal_constraints; Constraints path_constraints; "
        "TrajectoryConstraints trajectory_constraints; GenericTrajectory[] reference_trajectories; "
        "string pipeline_id; string planner_id; string group_name; int32 num_planning_attempts; "
        "float64 allowed_planning_time; float64 max_velocity_scaling_factor; "
        "float64 max_acceleration_scaling_factor; string cartesian_speed_limited_link; "
        "float64 max_cartesian_speed"
    ),
    "moveit_msgs/MotionPlanResponse": (
        "RobotState trajectory_start; string group_name; RobotTrajectory trajectory; "
        "float64 planning_time; MoveItErrorCodes error_code"
    ),
    "moveit_msgs/MotionSequenceItem": "MotionPlanRequest req; float64 blend_radius",
    "moveit_msgs/MotionSequenceRequest": "MotionSequenceItem[] items",
    "moveit_msgs/MotionSequenceResponse": (
        "MoveItErrorCodes error_code; RobotState sequence_start; "
        "RobotTrajectory[] planned_trajectories; float64 planning_time"
    ),
    "moveit_msgs/MoveItErrorCodes": (
        "int32 val; int32 SUCCESS=1; int32 UNDEFINED=0; int32 FAILURE=99999; "
        "int32 PLANNING_FAILED=-1; int32 INVALID_MOTION_PLAN=-2; "
        "int32 MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE=-3; int32 CONTROL_FAILED=-4; "
        "int32 UNABLE_TO_AQUIRE_SENSOR_DATA=-5; int32 TIMED_OUT=-6; int32 PREEMPTED=-7; "
        "int32 START_STATE_IN_COLLISION=-10; int32 START_STATE_VIOLATES_PATH_CONSTRAINTS=-11; "
        "int32 START_STATE_INVALID=-26; int32 GOAL_IN_COLLISION=-12; "
        "int32 GOAL_VIOLATES_PATH_CONSTRAINTS=-13; int32 GOAL_CONSTRAINTS_VIOLATED=-14; "
        "int32 GOAL_STATE_INVALID=-27; int32 UNRECOGNIZED_GOAL_TYPE=-28; "
        "int32 INVALID_GROUP_NAME=-15; int32 INVALID_GOAL_CONSTRAINTS=-16; "
        "int32 INVALID_ROBOT_STATE=-17; int32 INVALID_LINK_NAME=-18; "
        "int32 INVALID_OBJECT_NAME=-19; int32 FRAME_TRANSFORM_FAILURE=-21; "
        "int32 COLLISION_CHECKING_UNAVAILABLE=-22; int32 ROBOT_STATE_STALE=-23; "
        "int32 SENSOR_INFO_STALE=-24; int32 COMMUNICATION_FAILURE=-25; int32 CRASH=-29; "
        "int32 ABORT=-30; int32 NO_IK_SOLUTION=-31; string message; string source"
    ),
    "moveit_msgs/ObjectColor": "string id; std_msgs/ColorRGBA color",
    "moveit_msgs/OrientationConstraint": (
        "std_msgs/Header header; geometry_msgs/Quaternion orientation; string link_name; "
        "float64 absolute_x_axis_tolerance; float64 absolute_y_axis_tolerance; "
        "float64 absolute_z_axis_tolerance; uint8 parameterization; uint8 XYZ_EULER_ANGLES=0; "
        "uint8 ROTATION_VECTOR=1; float64 weight"
    ),
    "moveit_msgs/OrientedBoundingBox": "geometry_msgs/Pose pose; geometry_msgs/Point32 extents",
    "moveit_msgs/PipelineState": (
        "MotionPlanRequest request; MotionPlanResponse response; string pipeline_stage"
    ),
    "moveit_msgs/PlaceLocation": (
        "string id; trajectory_msgs/JointTrajectory post_place_posture; "
        "geometry_msgs/PoseStamped place_pose; float64 quality; "
        "GripperTranslation pre_place_approach; GripperTranslation post_place_retreat; "
        "string[] allowed_touch_objects"
    ),
    "moveit_msgs/PlannerInterfaceDescription": (
        "string name; string pipeline_id; string[] planner_ids"
    ),
    "moveit_msgs/PlannerParams": "string[] keys; string[] values; string[] descriptions",
    "moveit_msgs/PlanningOptions": (
        "PlanningScene planning_scene_diff; bool plan_only; bool look_around; "
        "int32 look_around_attempts; float64 max_safe_execution_cost; bool replan; "
        "int32 replan_attempts; float64 replan_delay"
    ),
    "moveit_msgs/PlanningScene": (
        "string name; RobotState robot_state; string robot_model_name; "
        "geometry_msgs/TransformStamped[] fixed_frame_transforms; "
        "AllowedCollisionMatrix allowed_collision_matrix; LinkPadding[] link_padding; "
        "LinkScale[] link_scale; ObjectColor[] object_colors; PlanningSceneWorld world; "
        "bool is_diff"
    ),
    "moveit_msgs/PlanningSceneComponents": (
        "uint32 SCENE_SETTINGS=1; uint32 ROBOT_STATE=2; uint32 ROBOT_STATE_ATTACHED_OBJECTS=4; "
        "uint32 WORLD_OBJECT_NAMES=8; uint32 WORLD_OBJECT_GEOMETRY=16; uint32 OCTOMAP=32; "
        "uint32 TRANSFORMS=64; uint32 ALLOWED_COLLISION_MATRIX=128; "
        "uint32 LINK_PADDING_AND_SCALING=256; uint32 OBJECT_COLORS=512; uint32 components"
    ),
    "moveit_msgs/PlanningSceneWorld": (
        "CollisionObject[] collision_objects; octomap_msgs/OctomapWithPose octomap"
    ),
    "moveit_msgs/PositionConstraint": (
        "std_msgs/Header header; string link_name; geometry_msgs/Vector3 target_point_offset; "
        "BoundingVolume constraint_region; float64 weight"
    ),
    "moveit_msgs/PositionIKRequest": (
        "string group_name; moveit_msgs/RobotState robot_state; Constraints constraints; "
        "bool avoid_collisions; string ik_link_name; geometry_msgs/PoseStamped pose_stamped; "
        "string[] ik_link_names; geometry_msgs/PoseStamped[] pose_stamped_vector; "
        "builtin_interfaces/Duration timeout"
    ),
    "moveit_msgs/RobotState": (
        "sensor_msgs/JointState joint_state; sensor_msgs/MultiDOFJointState multi_dof_joint_state; "
        "AttachedCollisionObject[] attached_collision_objects; bool is_diff"
    ),
    "moveit_msgs/RobotTrajectory": (
        "trajectory_msgs/JointTrajectory joint_trajectory; "
        "trajectory_msgs/MultiDOFJointTrajectory multi_dof_joint_trajectory"
    ),
    "moveit_msgs/ServoStatus": (
        "int8 code; string message; int8 INVALID=-1; int8 NO_WARNING=0; "
        "int8 DECELERATE_FOR_APPROACHING_SINGULARITY=1; int8 HALT_FOR_SINGULARITY=2; "
        "int8 DECELERATE_FOR_LEAVING_SINGULARITY=3; int8 DECELERATE_FOR_COLLISION=4; "
        "int8 HALT_FOR_COLLISION=5; int8 JOINT_BOUND=6"
    ),
    "moveit_msgs/TrajectoryConstraints": "Constraints[] constraints",
    "moveit_msgs/VisibilityConstraint": (
        "float64 target_radius; geometry_msgs/PoseStamped target_pose; int32 cone_sides; "
        "geometry_msgs/PoseStamped sensor_pose; float64 max_view_angle; float64 max_range_angle; "
        "uint8 SENSOR_Z=0; uint8 SENSOR_Y=1; uint8 SENSOR_X=2; uint8 sensor_view_direction; "
        "float64 weight"
    ),
    "moveit_msgs/WorkspaceParameters": (
        "std_msgs/Header header; geometry_msgs/Vector3 min_corner; geometry_msgs/Vector3 max_corner"
    ),
}

SERVICES: Final = {
    "moveit_msgs/ApplyPlanningScene": "PlanningScene scene; ---; bool success",
    "moveit_msgs/CheckIfRobotStateExistsInWarehouse": "string name; string robot; ---; bool exists",
    "moveit_msgs/DeleteRobotStateFromWarehouse": "string name; string robot; ---",
    "moveit_msgs/GetCartesianPath": (
        "std_msgs/Header header; RobotState start_state; string group_name; string link_name; "
        "geometry_msgs/Pose[] waypoints; float64 max_step; float64 jump_threshold; "
        "float64 prismatic_jump_threshold; float64 revolute_jump_threshold; bool avoid_collisions; "
        "Constraints path_constraints; float64 max_velocity_scaling_factor; "
        "float64 max_acceleration_scaling_factor; string cartesian_speed_limited_link; "
        "float64 max_cartesian_speed; ---; RobotState start_state; RobotTrajectory solution; "
        "float64 fraction; MoveItErrorCodes error_code"
    ),
    "moveit_msgs/GetGroupUrdf": (
        "string group_name; ---; MoveItErrorCodes error_code; string urdf_string"
    ),
    "moveit_msgs/GetMotionPlan": (
        "MotionPlanRequest motion_plan_request; ---; MotionPlanResponse motion_plan_response"
    ),
    "moveit_msgs/GetMotionSequence": (
        "MotionSequenceRequest request; ---; MotionSequenceResponse response"
    ),
    "moveit_msgs/GetPlannerParams": (
        "string pipeline_id; string planner_config; string group; ---; PlannerParams params"
    ),
    "moveit_msgs/GetPlanningScene": "PlanningSceneComponents components; ---; PlanningScene scene",
    "moveit_msgs/GetPositionFK": (
        "std_msgs/Header header; string[] fk_link_names; RobotState robot_state; ---; "
        "geometry_msgs/PoseStamped[] pose_stamped; string[] fk_link_names; "
        "MoveItErrorCodes error_code"
    ),
    "moveit_msgs/GetPositionIK": (
        "PositionIKRequest ik_request; ---; RobotState solution; MoveItErrorCodes error_code"
    ),
    "moveit_msgs/GetRobotStateFromWarehouse": (
        "string name; string robot; ---; moveit_msgs/RobotState state"
    ),
    "moveit_msgs/GetStateValidity": (
        "RobotState robot_state; string group_name; Constraints constraints; ---; bool valid; "
        "ContactInformation[] contacts; CostSource[] cost_sources; "
        "ConstraintEvalResult[] constraint_result"
    ),
    "moveit_msgs/GraspPlanning": (
        "string group_name; CollisionObject target; string[] support_surfaces; "
        "Grasp[] candidate_grasps; CollisionObject[] movable_obstacles; ---; Grasp[] grasps; "
        "MoveItErrorCodes error_code"
    ),
    "moveit_msgs/ListRobotStatesInWarehouse": "string regex; string robot; ---; string[] states",
    "moveit_msgs/LoadGeometryFromFile": "string file_path_and_name; ---; bool success",
    "moveit_msgs/LoadMap": "string filename; ---; bool success",
    "moveit_msgs/QueryPlannerInterfaces": "---; PlannerInterfaceDescription[] planner_interfaces",
    "moveit_msgs/RenameRobotStateInWarehouse": (
        "string old_name; string new_name; string robot; ---"
    ),
    "moveit_msgs/SaveGeometryToFile": "string file_path_and_name; ---; bool success",
    "moveit_msgs/SaveMap": "string filename; ---; bool success",
    "moveit_msgs/SaveRobotStateToWarehouse": (
        "string name; string robot; moveit_msgs/RobotState state; ---; bool success"
    ),
    "moveit_msgs/ServoCommandType": (
        "int8 JOINT_JOG=0; int8 TWIST=1; int8 POSE=2; int8 command_type; ---; bool success"
    ),
    "moveit_msgs/SetPlannerParams": (
        "string pipeline_id; string planner_config; string group; PlannerParams params; "
        "bool replace; ---"
    ),
    "moveit_msgs/UpdatePointcloudOctomap": "sensor_msgs/PointCloud2 cloud; ---; bool success",
}

ACTIONS: Final = {
    "moveit_msgs/ExecuteTrajectory": (
        "RobotTrajectory trajectory; string[] controller_names; ---; MoveItErrorCodes error_code; "
        "---; string state"
    ),
    "moveit_msgs/GlobalPlanner": (
        "string planning_group; moveit_msgs/MotionSequenceRequest motion_sequence; ---; "
        "moveit_msgs/MotionPlanResponse response; ---; string feedback"
    ),
    "moveit_msgs/HybridPlanner": (
        "string planning_group; moveit_msgs/MotionSequenceRequest motion_sequence; ---; "
        "moveit_msgs/MoveItErrorCodes error_code; string error_message; ---; string feedback"
    ),
    "moveit_msgs/LocalPlanner": (
        "Constraints[] local_constraints; ---; moveit_msgs/MoveItErrorCodes error_code; "
        "string error_message; ---; string feedback"
    ),
    "moveit_msgs/MoveGroup": (
        "MotionPlanRequest request; PlanningOptions planning_options; ---; "
        "MoveItErrorCodes error_code; moveit_msgs/RobotState trajectory_start; "
        "moveit_msgs/RobotTrajectory planned_trajectory; "
        "moveit_msgs/RobotTrajectory executed_trajectory; float64 planning_time; ---; string state"
    ),
    "moveit_msgs/MoveGroupSequence": (
        "MotionSequenceRequest request; PlanningOptions planning_options; ---; "
        "MotionSequenceResponse response; ---; string state"
    ),
    "moveit_msgs/Pickup": (
        "string target_name; string group_name; string end_effector; Grasp[] possible_grasps; "
        "string support_surface_name; bool allow_gripper_support_collision; "
        "string[] attached_object_touch_links; bool minimize_object_distance; "
        "Constraints path_constraints; string planner_id; string[] allowed_touch_objects; "
        "float64 allowed_planning_time; PlanningOptions planning_options; ---; "
        "MoveItErrorCodes error_code; RobotState trajectory_start; "
        "RobotTrajectory[] trajectory_stages; string[] trajectory_descriptions; Grasp grasp; "
        "float64 planning_time; ---; string state"
    ),
    "moveit_msgs/Place": (
        "string group_name; string attached_object_name; PlaceLocation[] place_locations; "
        "bool place_eef; string support_surface_name; bool allow_gripper_support_collision; "
        "Constraints path_constraints; string planner_id; string[] allowed_touch_objects; "
        "float64 allowed_planning_time; PlanningOptions planning_options; ---; "
        "MoveItErrorCodes error_code; RobotState trajectory_start; "
        "RobotTrajectory[] trajectory_stages; string[] trajectory_descriptions; "
        "PlaceLocation place_location; float64 planning_time; ---; string state"
    ),
}
