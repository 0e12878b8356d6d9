"""CDR of other computers and of other programs: golden bytes, two independent libraries, wrong
bytes."""

from random import Random
from typing import Any

import pytest
from cyclonedds.idl._support import Endianness
from rosbags.typesys import Stores, get_typestore
from support.dds_mixed import mixed as theirs
from support.ros_value import PLAIN, filled

from yarpy.errors import DecodeError, Truncated
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.message.cdr_plain import plain
from yarpy.peers.ros2.message.library import Library
from yarpy.peers.ros2.message.source import Rosbags, Standard

STORE = get_typestore(Stores.ROS2_JAZZY)
LIBRARY = Library([Rosbags("jazzy"), Standard()])
String: Any = LIBRARY.message("std_msgs/String")
MIXED = """\
uint8 a
float64 b
string c
int16[] d
float64[] e
string[] f
p/Inner g
p/Inner[] h
p/Inner[2] i
uint8 j
"""
INNER = "uint8 a\nint64 b\n"


def mixed() -> Any:
    texts = {"p/T": MIXED, "p/Inner": INNER}
    return Library([Texts(texts, "here"), Standard()]).message("p/T")


def value(cls: Any) -> Any:
    pairs, others = [[1, 2], [3, 4]], [[5, 6], [7, 8]]
    return cls.from_bottle(
        [1, 2.5, "three", [4, 5], [6.5, 7.5], ["a", "bc"], [8, 9], pairs, others, 10]
    )


@pytest.mark.parametrize(
    "data",
    [
        "0000 0000 00000003 686900",
        "0006 0000 00000003 686900",
        "0007 0001 03000000 686900 00",
        "0008 0000 00000007 00000003 686900",
        "0009 0000 0c000000 03000000 686900 00 2a000000",  # with a field that we do not know
    ],
)
def test_golden_bytes(data: str) -> None:
    assert String.from_ros(bytes.fromhex(data)).data == "hi"


def test_every_message_of_a_distribution_from_a_big_endian_computer() -> None:
    for name in STORE.fielddefs:
        cls: Any = LIBRARY.message(name)
        data = b"".join(filled(cls, Random(name), PLAIN).to_ros())
        theirs = STORE.serialize_cdr(STORE.deserialize_cdr(data, name), name, little_endian=False)
        assert b"".join(cls.from_ros(bytes(theirs)).to_ros()) == data, name


@pytest.mark.parametrize("big", [False, True], ids=["little", "big"])
@pytest.mark.parametrize("version_2", [False, True], ids=["xcdr1", "xcdr2"])
@pytest.mark.parametrize("extensible", [False, True], ids=["final", "appendable"])
def test_what_cyclonedds_writes(extensible: bool, version_2: bool, big: bool) -> None:
    order = Endianness.Big if big else Endianness.Little
    data = theirs(extensible).serialize(endianness=order, use_version_2=version_2)
    cls = mixed()
    assert cls.from_ros(data).to_bottle() == value(cls).to_bottle()


@pytest.mark.parametrize("head", [0, 6, 7, 8, 9])
def test_what_is_cut_off_is_truncated(head: int) -> None:
    cls = mixed()
    struct = cls._definition.struct
    for size in range(0, 60, 3):
        with pytest.raises((Truncated, DecodeError)):
            cls.from_ros(bytes([0, head, 0, 0]) + bytes(size))
    with pytest.raises(DecodeError):
        plain(struct, bytes([0, head, 0, 0]) + b"\xff" * 200)


def test_a_struct_is_not_longer_than_it_says() -> None:
    with pytest.raises(DecodeError, match="std_msgs/String is longer than it says"):
        String.from_ros(bytes.fromhex("0009 0000 05000000 03000000 686900 00"))


def test_wide_strings() -> None:
    cls: Any = Library([Texts({"p/T": "wstring a\n"}, "here"), Standard()]).message("p/T")
    assert cls.from_ros(bytes.fromhex("0000 0000 00000001 000000e9")).a == "é"
    with pytest.raises(DecodeError, match=r"p/T\.a: a wide string in XCDR2"):
        cls.from_ros(bytes.fromhex("0007 0000 02000000 e900"))
