"""The bytes of ROS 2 to messages: golden ones, those of an independent library, and wrong ones."""

import struct
import tracemalloc
from random import Random

import numpy as np
import pytest
from rosbags.typesys import Stores, get_typestore
from support.ros_value import PLAIN, filled

from yarpy.errors import DecodeError, Truncated
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.message.library import Library
from yarpy.peers.ros2.message.source import Rosbags, Standard

HI = bytes.fromhex("00010000 03000000 686900")
STORE = get_typestore(Stores.ROS2_JAZZY)
LIBRARY = Library([Rosbags("jazzy"), Standard()])
String = LIBRARY.message("std_msgs/String")


def of(text: str) -> type:
    found: type = Library([Texts({"p/T": text}, "here"), Standard()]).message("p/T")
    return found


def test_golden_bytes() -> None:
    assert String.from_ros(HI).data == "hi"  # type: ignore[attr-defined]
    assert String.from_ros(HI + b"\0\0\0").data == "hi"  # type: ignore[attr-defined]  # over DDS
    LIBRARY.message("std_msgs/Empty").from_ros(bytes.fromhex("0001000000"))


def test_every_message_of_a_distribution() -> None:
    for name in STORE.fielddefs:
        cls = LIBRARY.message(name)
        for seed in range(2):
            data = b"".join(filled(cls, Random(seed), PLAIN).to_ros())
            theirs = bytes(STORE.serialize_cdr(STORE.deserialize_cdr(data, name), name))
            assert theirs == data, name
            assert b"".join(cls.from_ros(theirs).to_ros()) == data, name


def test_padding_of_every_kind() -> None:
    """Numbers of all sizes behind texts of all lengths, in lists and messages, empty ones too."""
    text = """\
uint8 a
float64 b
string c
int16 d
uint8[3] e
float64[2] f
string[] g
float64[] h
uint8[] i
int64 j
std_msgs/Header[] k
bool[] l
uint32 m
std_msgs/Empty n
int16[] o
float64 p
"""
    rosbags = get_typestore(Stores.ROS2_JAZZY)
    from rosbags.typesys import get_types_from_msg

    rosbags.register(get_types_from_msg(text, "p/msg/T"))
    cls = of(text)
    for seed in range(300):
        chance = Random(seed)
        words = ["x" * chance.randrange(9) for _ in range(5)]
        data = b"".join(filled(cls, chance, words).to_ros())  # type: ignore[arg-type]
        theirs = bytes(rosbags.serialize_cdr(rosbags.deserialize_cdr(data, "p/msg/T"), "p/msg/T"))
        assert theirs == data, seed
        assert b"".join(cls.from_ros(data).to_ros()) == data, seed  # type: ignore[attr-defined]


def test_arrays_look_at_the_bytes() -> None:
    image = LIBRARY.message("sensor_msgs/Image")
    data = b"".join(image(height=2, width=2, step=6, data=bytes(range(12))).to_ros())
    found = image.from_ros(data)
    assert np.shares_memory(found.data, np.frombuffer(data, "u1"))  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "no message of ROS 2"),
        (b"\0\1", "no message of ROS 2"),
        (b"\0\x0b\0\0\3\0\0\0hi\0", "no plain CDR"),
        (HI[:-1], "takes bytes up to 7, the message has 6"),
        (HI[:5], "goes on beyond"),
        (b"\0\1\0\0\2\0\0\0hi", "without its zero"),
        (HI + b"\0" * 4, "another type"),
        (b"\0\1\0\0\xff\xff\xff\xffhi\0", "takes bytes up to"),
    ],
)
def test_what_is_wrong(data: bytes, says: str) -> None:
    with pytest.raises(DecodeError, match=says):
        String.from_ros(data)


def test_an_empty_string_may_lack_its_zero() -> None:
    assert String.from_ros(b"\0\1\0\0\0\0\0\0").data == ""  # type: ignore[attr-defined]


def test_every_message_cut_off_is_truncated() -> None:
    cls = LIBRARY.message("sensor_msgs/JointState")
    data = b"".join(filled(cls, Random(3), PLAIN).to_ros())
    for size in range(len(data)):
        with pytest.raises(Truncated):
            cls.from_ros(data[:size])


def test_counts_are_checked_before_memory_is_taken() -> None:
    names = {
        "string[] a": 4,
        "uint8[] a": 1,
        "float64[] a": 8,
        "std_msgs/Header[] a": 12,
        "bool[] a": 1,
    }
    for text in names:
        cls = of(text)
        tracemalloc.start()
        with pytest.raises(DecodeError):
            cls.from_ros(b"\0\1\0\0" + struct.pack("<I", 0xFFFFFFFF) + bytes(64))  # type: ignore[attr-defined]
        assert tracemalloc.get_traced_memory()[1] < 1 << 20
        tracemalloc.stop()


def test_elements_have_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", "1000")
    count = 20_000
    data = b"\0\1\0\0" + struct.pack("<I", count) + struct.pack("<I", 1) * 2 * count
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        of("string[] a").from_ros(data)  # type: ignore[attr-defined]


def test_bounds_of_lists_hold() -> None:
    cls = of("uint8[<=2] a")
    assert cls.from_ros(b"\0\1\0\0\2\0\0\0ab").a.tolist() == [97, 98]  # type: ignore[attr-defined]
    with pytest.raises(DecodeError, match="3 elements, of 2 that the type allows"):
        cls.from_ros(b"\0\1\0\0\3\0\0\0abc")  # type: ignore[attr-defined]


WIDE = 'uint8 a\nwstring b\nwstring[] c\nuint8 d\nfloat64 e\nwstring<=4 f "hi"\nwstring G=x\n'


def test_wide_strings() -> None:
    """As rosidl's type support for Fast CDR writes them: a count, and a uint32 for each unit."""
    cls = of(WIDE)
    said = bytes.fromhex(
        "00010000 05000000 03000000 61000000 3dd80000 00de0000"  # "a" and a smile, of two units
        "02000000 01000000 ac200000 00000000 07000000"
        "00000000 0000f83f 02000000 68000000 69000000"
    )
    found = cls(5, "a\U0001f600", ["\u20ac", ""], 7, 1.5)  # type: ignore[call-arg]
    assert b"".join(found.to_ros()) == said  # type: ignore[attr-defined]
    assert cls.from_ros(said) == found  # type: ignore[attr-defined]
    assert (found.b, found.f, found.G) == ("a\U0001f600", "hi", "x")  # type: ignore[attr-defined]
    alone = cls(b="\ud83d")  # type: ignore[call-arg]  # half a pair may come
    assert cls.from_ros(b"".join(alone.to_ros())).b == "\ud83d"  # type: ignore[attr-defined]


def test_wide_strings_that_are_wrong() -> None:
    cls = of("wstring a")
    with pytest.raises(DecodeError, match=r"p/T\.a: a wide string with a unit of more"):
        cls.from_ros(bytes.fromhex("00010000 01000000 00000100"))  # type: ignore[attr-defined]
    for size in range(4, 16):
        with pytest.raises(Truncated):
            cls.from_ros(bytes.fromhex("00010000 03000000 61000000 61")[:size])  # type: ignore[attr-defined]
