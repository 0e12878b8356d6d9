"""The definitions of the messages that yarpy's own types turn into, so that images, numbers and
text meet ROS where neither ROS nor rosbags is installed.

Rules: declarations alone; the checksums are those of ROS, which does not sum up comments.
"""

from __future__ import annotations

from typing import Final

MESSAGES: Final = {
    "std_msgs/Empty": "",
    "std_msgs/String": "string data\n",
    "std_msgs/Bool": "bool data\n",
    "std_msgs/Int32": "int32 data\n",
    "std_msgs/Float64": "float64 data\n",
    "std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id\n",
    "std_msgs/MultiArrayDimension": "string label\nuint32 size\nuint32 stride\n",
    "std_msgs/MultiArrayLayout": "MultiArrayDimension[] dim\nuint32 data_offset\n",
    "std_msgs/Float64MultiArray": "MultiArrayLayout layout\nfloat64[] data\n",
    "sensor_msgs/Image": """\
Header header
uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data
""",
    "sensor_msgs/CompressedImage": "Header header\nstring format\nuint8[] data\n",
    "sensor_msgs/JointState": """\
Header header
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
Header header
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
}

#: by which a type server is asked, and by which the simulated robot is moved: neither needs a
#: definition that somebody has
SERVICES: Final = {
    "std_srvs/Empty": "---\n",
    "std_srvs/Trigger": "---\nbool success\nstring message\n",
    "std_srvs/SetBool": "bool data\n---\nbool success\nstring message\n",
    "test_roscpp/TestStringString": "string str\n---\nstring str\n",
    "gazebo_msgs/SetModelConfiguration": """\
string model_name
string urdf_param_name
string[] joint_names
float64[] joint_positions
---
bool success
string status_message
""",
}
