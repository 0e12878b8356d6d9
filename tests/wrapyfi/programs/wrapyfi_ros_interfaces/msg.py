"""The message of sounds, as the package of Wrapyfi's interfaces defines it."""

from genpy.dynamic import generate_dynamic

NAME = "wrapyfi_ros_interfaces/ROSAudioMessage"
FIELDS = """\
std_msgs/Header header
uint32 chunk_size
uint8 channels
uint32 sample_rate
string encoding
uint8 is_bigendian
uint32 bitrate
string coding_format
uint32 step
uint8[] data
"""
HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"

ROSAudioMessage = generate_dynamic(NAME, f"{FIELDS}\n{'=' * 80}\nMSG: std_msgs/Header\n{HEADER}")[
    NAME
]
