"""Points, poses and twists; transforms; maps, paths and odometry.

Rules: as in `shipped/__init__.py`.
"""

from __future__ import annotations

from typing import Final

MESSAGES: Final = {
    "geometry_msgs/Accel": "Vector3 linear; Vector3 angular",
    "geometry_msgs/AccelStamped": "Header header; Accel accel",
    "geometry_msgs/AccelWithCovariance": "Accel accel; float64[36] covariance",
    "geometry_msgs/AccelWithCovarianceStamped": "Header header; AccelWithCovariance accel",
    "geometry_msgs/Inertia": (
        "float64 m; geometry_msgs/Vector3 com; float64 ixx; float64 ixy; float64 ixz; "
        "float64 iyy; float64 iyz; float64 izz"
    ),
    "geometry_msgs/InertiaStamped": "Header header; Inertia inertia",
    "geometry_msgs/Point": "float64 x; float64 y; float64 z",
    "geometry_msgs/Point32": "float32 x; float32 y; float32 z",
    "geometry_msgs/PointStamped": "Header header; Point point",
    "geometry_msgs/Polygon": "Point32[] points",
    "geometry_msgs/PolygonStamped": "Header header; Polygon polygon",
    "geometry_msgs/Pose": "Point position; Quaternion orientation",
    "geometry_msgs/Pose2D": "float64 x; float64 y; float64 theta",
    "geometry_msgs/PoseArray": "Header header; Pose[] poses",
    "geometry_msgs/PoseStamped": "Header header; Pose pose",
    "geometry_msgs/PoseWithCovariance": "Pose pose; float64[36] covariance",
    "geometry_msgs/PoseWithCovarianceStamped": "Header header; PoseWithCovariance pose",
    "geometry_msgs/Quaternion": "float64 x; float64 y; float64 z; float64 w",
    "geometry_msgs/QuaternionStamped": "Header header; Quaternion quaternion",
    "geometry_msgs/Transform": "Vector3 translation; Quaternion rotation",
    "geometry_msgs/TransformStamped": "Header header; string child_frame_id; Transform transform",
    "geometry_msgs/Twist": "Vector3 linear; Vector3 angular",
    "geometry_msgs/TwistStamped": "Header header; Twist twist",
    "geometry_msgs/TwistWithCovariance": "Twist twist; float64[36] covariance",
    "geometry_msgs/TwistWithCovarianceStamped": "Header header; TwistWithCovariance twist",
    "geometry_msgs/Vector3": "float64 x; float64 y; float64 z",
    "geometry_msgs/Vector3Stamped": "Header header; Vector3 vector",
    "geometry_msgs/Wrench": "Vector3 force; Vector3 torque",
    "geometry_msgs/WrenchStamped": "Header header; Wrench wrench",
    "tf2_msgs/TF2Error": (
        "uint8 NO_ERROR=0; uint8 LOOKUP_ERROR=1; uint8 CONNECTIVITY_ERROR=2; "
        "uint8 EXTRAPOLATION_ERROR=3; uint8 INVALID_ARGUMENT_ERROR=4; uint8 TIMEOUT_ERROR=5; "
        "uint8 TRANSFORM_ERROR=6; uint8 error; string error_string"
    ),
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms",
    "nav_msgs/GridCells": (
        "Header header; float32 cell_width; float32 cell_height; geometry_msgs/Point[] cells"
    ),
    "nav_msgs/MapMetaData": (
        "time map_load_time; float32 resolution; uint32 width; uint32 height; "
        "geometry_msgs/Pose origin"
    ),
    "nav_msgs/OccupancyGrid": "Header header; MapMetaData info; int8[] data",
    "nav_msgs/Odometry": (
        "Header header; string child_frame_id; geometry_msgs/PoseWithCovariance pose; "
        "geometry_msgs/TwistWithCovariance twist"
    ),
    "nav_msgs/Path": "Header header; geometry_msgs/PoseStamped[] poses",
    "move_base_msgs/RecoveryStatus": (
        "geometry_msgs/PoseStamped pose_stamped; uint16 current_recovery_number; "
        "uint16 total_number_of_recoveries; string recovery_behavior_name"
    ),
    "map_msgs/OccupancyGridUpdate": (
        "std_msgs/Header header; int32 x; int32 y; uint32 width; uint32 height; int8[] data"
    ),
    "map_msgs/PointCloud2Update": (
        "uint32 ADD=0; uint32 DELETE=1; std_msgs/Header header; uint32 type; "
        "sensor_msgs/PointCloud2 points"
    ),
    "map_msgs/ProjectedMap": "nav_msgs/OccupancyGrid map; float64 min_z; float64 max_z",
    "map_msgs/ProjectedMapInfo": (
        "string frame_id; float64 x; float64 y; float64 width; float64 height; float64 min_z; "
        "float64 max_z"
    ),
    "tf/tfMessage": "geometry_msgs/TransformStamped[] transforms",
}

SERVICES: Final = {
    "tf2_msgs/FrameGraph": "---; string frame_yaml",
    "nav_msgs/GetMap": "---; nav_msgs/OccupancyGrid map",
    "nav_msgs/GetPlan": (
        "geometry_msgs/PoseStamped start; geometry_msgs/PoseStamped goal; float32 tolerance; "
        "---; nav_msgs/Path plan"
    ),
    "nav_msgs/LoadMap": (
        "string map_url; ---; uint8 RESULT_SUCCESS=0; uint8 RESULT_MAP_DOES_NOT_EXIST=1; "
        "uint8 RESULT_INVALID_MAP_DATA=2; uint8 RESULT_INVALID_MAP_METADATA=3; "
        "uint8 RESULT_UNDEFINED_FAILURE=255; nav_msgs/OccupancyGrid map; uint8 result"
    ),
    "nav_msgs/SetMap": (
        "nav_msgs/OccupancyGrid map; geometry_msgs/PoseWithCovarianceStamped initial_pose; "
        "---; bool success"
    ),
    "map_msgs/GetMapROI": (
        "float64 x; float64 y; float64 l_x; float64 l_y; ---; nav_msgs/OccupancyGrid sub_map"
    ),
    "map_msgs/GetPointMap": "---; sensor_msgs/PointCloud2 map",
    "map_msgs/GetPointMapROI": (
        "float64 x; float64 y; float64 z; float64 r; float64 l_x; float64 l_y; float64 l_z; "
        "---; sensor_msgs/PointCloud2 sub_map"
    ),
    "map_msgs/ProjectedMapsInfo": "map_msgs/ProjectedMapInfo[] projected_maps_info; ---",
    "map_msgs/SaveMap": "std_msgs/String filename; ---",
    "map_msgs/SetMapProjections": "---; map_msgs/ProjectedMapInfo[] projected_maps_info",
    "tf/FrameGraph": "---; string dot_graph",
}

ACTIONS: Final = {
    "tf2_msgs/LookupTransform": (
        "string target_frame; string source_frame; time source_time; duration timeout; "
        "time target_time; string fixed_frame; bool advanced; ---; "
        "geometry_msgs/TransformStamped transform; tf2_msgs/TF2Error error; ---"
    ),
    "nav_msgs/GetMap": "---; nav_msgs/OccupancyGrid map; ---",
    "move_base_msgs/MoveBase": (
        "geometry_msgs/PoseStamped target_pose; ---; ---; geometry_msgs/PoseStamped base_position"
    ),
}
