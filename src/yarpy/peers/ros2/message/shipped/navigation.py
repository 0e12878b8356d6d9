"""Navigation with Nav2: goals, paths, routes, docks, costmaps, behaviours; places on the earth.

Rules: as in `shipped/__init__.py`; of nav2_msgs 1.3.13.
"""

from __future__ import annotations

from typing import Final

MESSAGES: Final = {
    "geographic_msgs/GeoPoint": "float64 latitude; float64 longitude; float64 altitude",
    "geographic_msgs/GeoPose": "GeoPoint position; geometry_msgs/Quaternion orientation",
    "nav2_msgs/BehaviorTreeLog": (
        "builtin_interfaces/Time timestamp; BehaviorTreeStatusChange[] event_log"
    ),
    "nav2_msgs/BehaviorTreeStatusChange": (
        "builtin_interfaces/Time timestamp; string node_name; uint16 uid; string previous_status; "
        "string current_status"
    ),
    "nav2_msgs/CollisionDetectorState": "string[] polygons; bool[] detections",
    "nav2_msgs/CollisionMonitorState": (
        "uint8 DO_NOTHING=0; uint8 STOP=1; uint8 SLOWDOWN=2; uint8 APPROACH=3; uint8 LIMIT=4; "
        "uint8 action_type; string polygon_name"
    ),
    "nav2_msgs/Costmap": "std_msgs/Header header; CostmapMetaData metadata; uint8[] data",
    "nav2_msgs/CostmapFilterInfo": (
        "std_msgs/Header header; uint8 type; string filter_mask_topic; float32 base; "
        "float32 multiplier"
    ),
    "nav2_msgs/CostmapMetaData": (
        "builtin_interfaces/Time map_load_time; builtin_interfaces/Time update_time; string layer; "
        "float32 resolution; uint32 size_x; uint32 size_y; geometry_msgs/Pose origin"
    ),
    "nav2_msgs/CostmapUpdate": (
        "std_msgs/Header header; uint32 x; uint32 y; uint32 size_x; uint32 size_y; uint8[] data"
    ),
    "nav2_msgs/EdgeCost": "uint16 edgeid; float32 cost",
    "nav2_msgs/MissedWaypoint": "uint32 index; geometry_msgs/PoseStamped goal; uint16 error_code",
    "nav2_msgs/Particle": "geometry_msgs/Pose pose; float64 weight",
    "nav2_msgs/ParticleCloud": "std_msgs/Header header; Particle[] particles",
    "nav2_msgs/Route": (
        "std_msgs/Header header; float32 route_cost; RouteNode[] nodes; RouteEdge[] edges"
    ),
    "nav2_msgs/RouteEdge": "uint16 edgeid; geometry_msgs/Point start; geometry_msgs/Point end",
    "nav2_msgs/RouteNode": "uint16 nodeid; geometry_msgs/Point position",
    "nav2_msgs/SpeedLimit": "std_msgs/Header header; bool percentage; float64 speed_limit",
    "nav2_msgs/VoxelGrid": (
        "std_msgs/Header header; uint32[] data; geometry_msgs/Point32 origin; "
        "geometry_msgs/Vector3 resolutions; uint32 size_x; uint32 size_y; uint32 size_z"
    ),
}

SERVICES: Final = {
    "nav2_msgs/ClearCostmapAroundPose": (
        "geometry_msgs/PoseStamped pose; float64 reset_distance; ---; std_msgs/Empty response"
    ),
    "nav2_msgs/ClearCostmapAroundRobot": "float32 reset_distance; ---; std_msgs/Empty response",
    "nav2_msgs/ClearCostmapExceptRegion": "float32 reset_distance; ---; std_msgs/Empty response",
    "nav2_msgs/ClearEntireCostmap": "std_msgs/Empty request; ---; std_msgs/Empty response",
    "nav2_msgs/DynamicEdges": (
        "uint16[] closed_edges; uint16[] opened_edges; EdgeCost[] adjust_edges; ---; bool success"
    ),
    "nav2_msgs/GetCost": (
        "bool use_footprint; float32 x; float32 y; float32 theta; ---; float32 cost"
    ),
    "nav2_msgs/GetCostmap": "nav2_msgs/CostmapMetaData specs; ---; nav2_msgs/Costmap map",
    "nav2_msgs/IsPathValid": "nav_msgs/Path path; ---; bool is_valid; int32[] invalid_pose_indices",
    "nav2_msgs/LoadMap": (
        "string map_url; ---; uint8 RESULT_SUCCESS=0; uint8 RESULT_MAP_DOES_NOT_EXIST=1; "
        "uint8 RESULT_INVALID_MAP_DATA=2; uint8 RESULT_INVALID_MAP_METADATA=3; "
        "uint8 RESULT_UNDEFINED_FAILURE=255; nav_msgs/OccupancyGrid map; uint8 result"
    ),
    "nav2_msgs/ManageLifecycleNodes": (
        "uint8 STARTUP=0; uint8 PAUSE=1; uint8 RESUME=2; uint8 RESET=3; uint8 SHUTDOWN=4; "
        "uint8 CONFIGURE=5; uint8 CLEANUP=6; uint8 command; ---; bool success"
    ),
    "nav2_msgs/ReloadDockDatabase": "string filepath; ---; bool success",
    "nav2_msgs/SaveMap": (
        "string map_topic; string map_url; string image_format; string map_mode; "
        "float32 free_thresh; float32 occupied_thresh; ---; bool result"
    ),
    "nav2_msgs/SetInitialPose": "geometry_msgs/PoseWithCovarianceStamped pose; ---",
    "nav2_msgs/SetRouteGraph": "string graph_filepath; ---; bool success",
    "nav2_msgs/Toggle": "bool enable; ---; bool success; string message",
}

ACTIONS: Final = {
    "nav2_msgs/AssistedTeleop": (
        "builtin_interfaces/Duration time_allowance; ---; uint16 NONE=0; uint16 UNKNOWN=730; "
        "uint16 TIMEOUT=731; uint16 TF_ERROR=732; builtin_interfaces/Duration total_elapsed_time; "
        "uint16 error_code; string error_msg; ---; "
        "builtin_interfaces/Duration current_teleop_duration"
    ),
    "nav2_msgs/BackUp": (
        "geometry_msgs/Point target; float32 speed; builtin_interfaces/Duration time_allowance; "
        "---; uint16 NONE=0; uint16 UNKNOWN=710; uint16 TIMEOUT=711; uint16 TF_ERROR=712; "
        "uint16 INVALID_INPUT=713; uint16 COLLISION_AHEAD=714; "
        "builtin_interfaces/Duration total_elapsed_time; uint16 error_code; string error_msg; ---; "
        "float32 distance_traveled"
    ),
    "nav2_msgs/ComputeAndTrackRoute": (
        "uint16 start_id; geometry_msgs/PoseStamped start; uint16 goal_id; "
        "geometry_msgs/PoseStamped goal; bool use_start; bool use_poses; ---; uint16 NONE=0; "
        "uint16 UNKNOWN=400; uint16 TF_ERROR=401; uint16 NO_VALID_GRAPH=402; "
        "uint16 INDETERMINANT_NODES_ON_GRAPH=403; uint16 TIMEOUT=404; uint16 NO_VALID_ROUTE=405; "
        "uint16 OPERATION_FAILED=406; uint16 INVALID_EDGE_SCORER_USE=407; "
        "builtin_interfaces/Duration execution_duration; uint16 error_code 0; ---; "
        "uint16 last_node_id; uint16 next_node_id; uint16 current_edge_id; Route route; "
        "nav_msgs/Path path; string[] operations_triggered; bool rerouted"
    ),
    "nav2_msgs/ComputePathThroughPoses": (
        "geometry_msgs/PoseStamped[] goals; geometry_msgs/PoseStamped start; string planner_id; "
        "bool use_start; ---; uint16 NONE=0; uint16 UNKNOWN=300; uint16 INVALID_PLANNER=301; "
        "uint16 TF_ERROR=302; uint16 START_OUTSIDE_MAP=303; uint16 GOAL_OUTSIDE_MAP=304; "
        "uint16 START_OCCUPIED=305; uint16 GOAL_OCCUPIED=306; uint16 TIMEOUT=307; "
        "uint16 NO_VALID_PATH=308; uint16 NO_VIAPOINTS_GIVEN=309; nav_msgs/Path path; "
        "builtin_interfaces/Duration planning_time; uint16 error_code; string error_msg; ---"
    ),
    "nav2_msgs/ComputePathToPose": (
        "geometry_msgs/PoseStamped goal; geometry_msgs/PoseStamped start; string planner_id; "
        "bool use_start; ---; uint16 NONE=0; uint16 UNKNOWN=200; uint16 INVALID_PLANNER=201; "
        "uint16 TF_ERROR=202; uint16 START_OUTSIDE_MAP=203; uint16 GOAL_OUTSIDE_MAP=204; "
        "uint16 START_OCCUPIED=205; uint16 GOAL_OCCUPIED=206; uint16 TIMEOUT=207; "
        "uint16 NO_VALID_PATH=208; nav_msgs/Path path; builtin_interfaces/Duration planning_time; "
        "uint16 error_code; string error_msg; ---"
    ),
    "nav2_msgs/ComputeRoute": (
        "uint16 start_id; geometry_msgs/PoseStamped start; uint16 goal_id; "
        "geometry_msgs/PoseStamped goal; bool use_start; bool use_poses; ---; uint16 NONE=0; "
        "uint16 UNKNOWN=400; uint16 TF_ERROR=401; uint16 NO_VALID_GRAPH=402; "
        "uint16 INDETERMINANT_NODES_ON_GRAPH=403; uint16 TIMEOUT=404; uint16 NO_VALID_ROUTE=405; "
        "uint16 INVALID_EDGE_SCORER_USE=407; builtin_interfaces/Duration planning_time; "
        "nav_msgs/Path path; Route route; uint16 error_code 0; ---"
    ),
    "nav2_msgs/DockRobot": (
        "bool use_dock_id True; string dock_id; geometry_msgs/PoseStamped dock_pose; "
        "string dock_type; float32 max_staging_time 1000.0; bool navigate_to_staging_pose True; "
        "---; uint16 NONE=0; uint16 DOCK_NOT_IN_DB=901; uint16 DOCK_NOT_VALID=902; "
        "uint16 FAILED_TO_STAGE=903; uint16 FAILED_TO_DETECT_DOCK=904; "
        "uint16 FAILED_TO_CONTROL=905; uint16 FAILED_TO_CHARGE=906; uint16 UNKNOWN=999; "
        "bool success True; uint16 error_code 0; uint16 num_retries 0; string error_msg; ---; "
        "uint16 NONE=0; uint16 NAV_TO_STAGING_POSE=1; uint16 INITIAL_PERCEPTION=2; "
        "uint16 CONTROLLING=3; uint16 WAIT_FOR_CHARGE=4; uint16 RETRY=5; uint16 state; "
        "builtin_interfaces/Duration docking_time; uint16 num_retries 0"
    ),
    "nav2_msgs/DriveOnHeading": (
        "geometry_msgs/Point target; float32 speed; builtin_interfaces/Duration time_allowance; "
        "---; uint16 NONE=0; uint16 UNKNOWN=720; uint16 TIMEOUT=721; uint16 TF_ERROR=722; "
        "uint16 COLLISION_AHEAD=723; uint16 INVALID_INPUT=724; "
        "builtin_interfaces/Duration total_elapsed_time; uint16 error_code; string error_msg; ---; "
        "float32 distance_traveled"
    ),
    "nav2_msgs/DummyBehavior": (
        "std_msgs/String command; ---; builtin_interfaces/Duration total_elapsed_time; "
        "uint16 error_code; string error_msg; ---"
    ),
    "nav2_msgs/FollowGPSWaypoints": (
        "uint32 number_of_loops; uint32 goal_index 0; geographic_msgs/GeoPose[] gps_poses; ---; "
        "uint16 NONE=0; uint16 UNKNOWN=600; uint16 TASK_EXECUTOR_FAILED=601; "
        "MissedWaypoint[] missed_waypoints; int16 error_code; string error_msg; ---; "
        "uint32 current_waypoint"
    ),
    "nav2_msgs/FollowObject": (
        "string pose_topic; string tracked_frame; builtin_interfaces/Duration max_duration; ---; "
        "uint16 NONE=0; uint16 TF_ERROR=901; uint16 FAILED_TO_DETECT_OBJECT=902; "
        "uint16 FAILED_TO_CONTROL=903; uint16 TIMEOUT=904; uint16 UNKNOWN=999; "
        "builtin_interfaces/Duration total_elapsed_time; uint16 error_code 0; "
        "uint16 num_retries 0; string error_msg; ---; uint16 NONE=0; uint16 INITIAL_PERCEPTION=1; "
        "uint16 CONTROLLING=2; uint16 STOPPING=3; uint16 RETRY=4; uint16 state; "
        "builtin_interfaces/Duration following_time; uint16 num_retries 0"
    ),
    "nav2_msgs/FollowPath": (
        "nav_msgs/Path path; string controller_id; string goal_checker_id; "
        "string progress_checker_id; ---; uint16 NONE=0; uint16 UNKNOWN=100; "
        "uint16 INVALID_CONTROLLER=101; uint16 TF_ERROR=102; uint16 INVALID_PATH=103; "
        "uint16 PATIENCE_EXCEEDED=104; uint16 FAILED_TO_MAKE_PROGRESS=105; "
        "uint16 NO_VALID_CONTROL=106; uint16 CONTROLLER_TIMED_OUT=107; std_msgs/Empty result; "
        "uint16 error_code; string error_msg; ---; float32 distance_to_goal; float32 speed"
    ),
    "nav2_msgs/FollowWaypoints": (
        "uint32 number_of_loops; uint32 goal_index 0; geometry_msgs/PoseStamped[] poses; ---; "
        "uint16 NONE=0; uint16 UNKNOWN=600; uint16 TASK_EXECUTOR_FAILED=601; "
        "MissedWaypoint[] missed_waypoints; uint16 error_code; string error_msg; ---; "
        "uint32 current_waypoint"
    ),
    "nav2_msgs/NavigateThroughPoses": (
        "geometry_msgs/PoseStamped[] poses; string behavior_tree; ---; uint16 NONE=0; "
        "uint16 error_code; string error_msg; ---; geometry_msgs/PoseStamped current_pose; "
        "builtin_interfaces/Duration navigation_time; "
        "builtin_interfaces/Duration estimated_time_remaining; int16 number_of_recoveries; "
        "float32 distance_remaining; int16 number_of_poses_remaining"
    ),
    "nav2_msgs/NavigateToPose": (
        "geometry_msgs/PoseStamped pose; string behavior_tree; ---; uint16 NONE=0; "
        "uint16 error_code; string error_msg; ---; geometry_msgs/PoseStamped current_pose; "
        "builtin_interfaces/Duration navigation_time; "
        "builtin_interfaces/Duration estimated_time_remaining; int16 number_of_recoveries; "
        "float32 distance_remaining"
    ),
    "nav2_msgs/SmoothPath": (
        "nav_msgs/Path path; string smoother_id; "
        "builtin_interfaces/Duration max_smoothing_duration; bool check_for_collisions; ---; "
        "uint16 NONE=0; uint16 UNKNOWN=500; uint16 INVALID_SMOOTHER=501; uint16 TIMEOUT=502; "
        "uint16 SMOOTHED_PATH_IN_COLLISION=503; uint16 FAILED_TO_SMOOTH_PATH=504; "
        "uint16 INVALID_PATH=505; nav_msgs/Path path; "
        "builtin_interfaces/Duration smoothing_duration; bool was_completed; uint16 error_code; "
        "string error_msg; ---"
    ),
    "nav2_msgs/Spin": (
        "float32 target_yaw; builtin_interfaces/Duration time_allowance; ---; uint16 NONE=0; "
        "uint16 UNKNOWN=700; uint16 TIMEOUT=701; uint16 TF_ERROR=702; uint16 COLLISION_AHEAD=703; "
        "builtin_interfaces/Duration total_elapsed_time; uint16 error_code; string error_msg; ---; "
        "float32 angular_distance_traveled"
    ),
    "nav2_msgs/UndockRobot": (
        "string dock_type; float32 max_undocking_time 30.0; ---; uint16 NONE=0; "
        "uint16 DOCK_NOT_VALID=902; uint16 FAILED_TO_CONTROL=905; uint16 UNKNOWN=999; "
        "bool success True; uint16 error_code 0; string error_msg; ---"
    ),
    "nav2_msgs/Wait": (
        "builtin_interfaces/Duration time; ---; builtin_interfaces/Duration total_elapsed_time; "
        "uint16 error_code; string error_msg; ---; builtin_interfaces/Duration time_left"
    ),
}
