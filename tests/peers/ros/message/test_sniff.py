"""A .msg for the bytes that a YARP port sends anyway."""

from struct import pack
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import yarpy
from yarpy.data import codec
from yarpy.data.bottle import Bottle, Property
from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.sniff import sniff


def seen(library: Library, sample: Any) -> Any:
    """What ROS would read with the sniffed type."""
    data = b"".join(codec.encode(sample))
    message = library.message_of("p/Sniffed", sniff(sample)).from_ros(data)
    assert b"".join(message.to_ros()) == data
    return message


def test_two_numbers_as_recorded() -> None:
    assert sniff(Bottle([7, 8])) == (
        "int32 v_tag # set to 257 (BOTTLE_TAG_LIST+code)\nint32[] v # suggested length: 2 (7 8)\n"
    )


def test_encoders() -> None:
    assert sniff(yarpy.Vector([1.0, 2.0, 3.0, 4.5])) == (
        "int32 v_tag # set to 266 (BOTTLE_TAG_LIST+code)\n"
        "float64[] v # suggested length: 4 (1.0 2.0 3.0 4.5)\n"
    )


def test_an_image_as_recorded(library: Library) -> None:
    image = yarpy.Image(np.arange(18, dtype="u1").reshape(2, 3, 3))
    lines = sniff(image).splitlines()
    assert [line.partition(" # ")[0] for line in lines] == [
        "int32 v_tag",
        "int32 v_len",
        "int32 v0_tag",
        "int32 v0",
        "int32 v1_tag",
        "int32 v1",
        "int32 v2_tag",
        "int32[] v2",
        "int32 v3_tag",
        "int8[] v3",
    ]
    assert lines[1].endswith("# set to 4")
    assert lines[3].endswith('# "mat"')
    found = seen(library, image)
    assert found.v2.tolist()[-2:] == [3, 2]
    assert found.v3.view("u1").tolist() == list(image.to_wire()[1])


def test_everything_that_a_bottle_holds(library: Library) -> None:
    sample = Bottle(
        [
            *(1, 2.5, "a\nb", Vocab("set"), b"xyz", True, Int8(-3), Int16(4), Int64(5)),
            *(Float32(0.5), [1, "x", [2, [3.5, "deep"]]], ["a", "b"], [], [b"p", b"qr"]),
            *(Property({"key": 1}), [Vocab("on"), Vocab("off")]),
        ]
    )
    found = seen(library, sample)
    assert (found.v0, found.v1, found.v2) == (1, 2.5, "a\nb")
    assert (found.v6, found.v7, found.v8, found.v9) == (-3, 4, 5, 0.5)
    assert (found.v10_0, found.v10_1, found.v10_2_1_1) == (1, "x", "deep")
    assert found.v11 == ["a", "b"]
    assert found.v12_len == 0
    assert found.v13_1.tolist() == [113, 114]


_ELEMENTS: Any = st.recursive(
    st.one_of(st.integers(-(2**31), 2**31 - 1), st.floats(allow_nan=False), st.text(), st.binary()),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=80)
@given(st.lists(_ELEMENTS, max_size=6))
def test_ros_reads_the_bytes_of_any_bottle(library: Library, items: list[Any]) -> None:
    seen(library, Bottle(items))


def test_arrays_may_differ_in_length_other_lists_may_not() -> None:
    text = sniff(Bottle([[1, 2], "a"]), Bottle([[1, 2, 3], "b"]))
    assert "int32[] v0" in text
    with pytest.raises(DecodeError, match="message 2 is of another structure than the first"):
        sniff(Bottle([1, "a"]), Bottle([1, "a", 2]))
    with pytest.raises(DecodeError, match="int32 v1_tag # set to 4"):
        sniff(Bottle([1, 2.5]), Bottle([1, "a"]))


def test_bytes_of_a_port_are_samples_too() -> None:
    assert sniff(Bottle([7, 8]).to_bytes()) == sniff(Bottle([7, 8]))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"hello world!",
        pack("<ii", 256, 3),
        pack("<ii", 257, 1 << 30),
        pack("<ii", 256, -1),
        pack("<iii", 256, 1, 77),
        pack("<iiii", 256, 1, 4, -5),
        Bottle([1]).to_bytes() + b"x",
        yarpy.Sound(np.zeros(4, "i2")).to_wire()[0],
        pack("<ii", 256, 1) * 500 + pack("<ii", 256, 0),
    ],
)
def test_what_is_no_bottle(data: bytes) -> None:
    with pytest.raises(DecodeError):
        sniff(data)


def test_what_is_no_type() -> None:
    with pytest.raises(DecodeError, match="no type of ROS"):
        sniff(Bottle([1, "a"] * 5000))
    with pytest.raises(ValueError, match="a message at least"):
        sniff()
