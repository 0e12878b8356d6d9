"""Types that these tests share."""

import pytest

from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.source import Standard, Texts

TEXTS = {
    "test/Every": """\
# One field of every kind.

int32 LIMIT=7 # at most
string WORD=a word
bool flag
int8 i8
uint8 u8
byte b
char c
int16 i16
uint16 u16
int32 i32
uint32 u32
int64 i64
uint64 u64
float32 f32
float64 f64 # in metres
string text
time stamp
duration span
bool[] flags
int8[] i8s
uint8[] u8s
int16[] i16s
uint16[] u16s
int32[] i32s
uint32[3] u32s
int64[] i64s
uint64[] u64s
float32[] f32s
float64[2] f64s
string[] texts
string[2] words
time[] stamps
duration[2] spans
Inner inner
Inner[] inners
Inner[2] pair
std_msgs/Empty nothing
""",
    "test/Inner": "uint8 KIND=3\nfloat64 x\nstring name\n",
    "test/Words": "string from\nint32 self\nint32 from_\nint32 to_ros\nint32 class=3\n".replace(
        "int32 class=3", "int32 None=3"
    ),
    "turtlesim/Pose": "float32 x\nfloat32 y\nfloat32 theta\n\n"
    "float32 linear_velocity\nfloat32 angular_velocity",
    "geometry_msgs/Twist": "Vector3  linear # m/s\nVector3  angular\n",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
}


@pytest.fixture(scope="session")
def library() -> Library:
    return Library([Texts(TEXTS, "the tests"), Standard()])
