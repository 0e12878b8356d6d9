"""The spelling of YARP 4.0: golden bytes from its tables, both ways, and which one a message is."""

import struct
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.message import bottles, kinds, walk
from support.table import for_each
from support.vectors import binaries

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.sig.sound import Sound
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Float32
from yarpy.data.walker import Walker
from yarpy.data.yarp4 import is_yarp4, newest, older, to_yarp3, to_yarp4
from yarpy.errors import DecodeError, Truncated

# what is sent, as YARP 3.x spells it, and as 4.0 does
ROWS = [
    ([1.5], "00010000 01000000 0a000000 000000000000f83f",
     "00010000 01000000 14000000 000000000000f83f"),
    ([Float32(1.5)], "00010000 01000000 80000000 0000c03f",
     "00010000 01000000 0a000000 0000c03f"),
    ([1.5, 2.5], "0a010000 02000000 000000000000f83f 0000000000000440",
     "14010000 02000000 000000000000f83f 0000000000000440"),
    ([Float32(1.5), Float32(2.5)], "80010000 02000000 0000c03f 00002040",
     "0a010000 02000000 0000c03f 00002040"),
    (["hi", 1.5], "00010000 02000000 04000000 02000000 6869 0a000000 000000000000f83f",
     "00010000 02000000 04000000 02000000 6869 14000000 000000000000f83f"),
    ([[1.5], 3],
     "00010000 02000000 0a010000 01000000 000000000000f83f 01000000 03000000",
     "00010000 02000000 14010000 01000000 000000000000f83f 01000000 03000000"),
    ([1, "a", [2, "b"]], None, None),
]  # fmt: skip


# What `yarp write` of C++ 4.0.0 sent of these lines.
SENT = {
    '1 2.25 "a b" (1.5 2.5) ((1 0.5))':
        "00010000 05000000 01000000 01000000 14000000 0000000000000240 04000000 03000000 612062"
        "14010000 02000000 000000000000f83f 0000000000000440"
        "00010000 01000000 00010000 02000000 01000000 01000000 14000000 000000000000e03f",
    "[set] (a (b 1.0)) 7":
        "00010000 03000000 09000000 73657400 00010000 02000000 04000000 01000000 61"
        "00010000 02000000 04000000 01000000 62 14000000 000000000000f03f 01000000 07000000",
    "0.0 (1.0 x) ()":
        "00010000 03000000 14000000 0000000000000000"
        "00010000 02000000 14000000 000000000000f03f 04000000 01000000 78 00010000 00000000",
}  # fmt: skip


@pytest.mark.parametrize("line", SENT)
def test_what_cpp_sent_is_what_it_is_sent(line: str) -> None:
    sent = bytes.fromhex(SENT[line])
    value = Bottle.from_text(line)
    assert codec.decode_as(sent, Bottle) == value
    assert newest((value.to_bytes(),)) == (sent,)
    assert newest((sent,)) == (sent,)


def test_what_is_no_bottle() -> None:
    for blocks in ((b"",), (b"what else",), Image(np.zeros((2, 2), "uint8")).to_wire(), ()):
        assert newest(blocks) is blocks
    sound = Sound([[1, -2, 3], [4, 5, 6]], 16000)
    assert b"".join(newest(sound.to_wire())) == sound.to_bottle("4.0").to_bytes()


@pytest.mark.parametrize(("value", "three", "four"), ROWS)
def test_both_spellings(value, three, four):
    older_ = Bottle(value).to_bytes()
    if three is None:
        assert to_yarp4(older_) is older_ and to_yarp3(older_) is older_
        assert is_yarp4(older_) is None and older(older_) is None
        return
    newer = bytes.fromhex(four)
    if len(value) > 1 or not isinstance(value[0], float):
        assert older_ == bytes.fromhex(three)
    older_ = bytes.fromhex(three)
    assert to_yarp4(older_) == newer
    assert to_yarp3(newer) == older_
    assert is_yarp4(older_) is False and is_yarp4(newer) is True
    assert codec.decode_as(newer, Bottle) == value
    assert codec.decode_as(newer, list) == value
    for step in (1, 3, len(newer)):
        assert walk(newer, step, yarp4=True) == len(newer)


def test_natural_values_are_those_of_3():
    assert codec.decode(bytes.fromhex(ROWS[0][2])) == 1.5
    vector = codec.decode(bytes.fromhex(ROWS[2][2]))
    assert isinstance(vector, Vector) and vector == [1.5, 2.5]
    assert codec.decode_as(bytes.fromhex(ROWS[2][2]), Vector) == [1.5, 2.5]
    assert codec.decode_as(bytes.fromhex(ROWS[0][2]), float) == 1.5
    with pytest.raises(DecodeError, match=r"expected a string, got 1\.5"):
        codec.decode_as(bytes.fromhex(ROWS[0][2]), str)


def test_words_of_eight_characters_become_strings():
    word = struct.pack("<iii8s", 256, 1, 18, b"abcdefgh")
    assert codec.decode(word) == "abcdefgh" and is_yarp4(word) is True
    words = struct.pack("<ii16si", 274, 2, b"abcdefghij\0\0\0\0\0\0", 0)[:-4]
    assert codec.decode(words) == ["abcdefgh", "ij"]
    mixed = struct.pack("<iii8sii", 256, 2, 18, b"moving", 1, 7)
    assert codec.decode(mixed) == ["moving", 7]


TINY = sys.float_info.min


def items(value: Any) -> Iterator[Any]:
    """What is in a value, at any depth."""
    for item in value:
        yield item
        if isinstance(item, list):
            yield from items(item)


@given(bottles)
@settings(max_examples=150, deadline=None)
def test_there_and_back(value):
    # In the bytes of a number this small stands what may be the length of a word of YARP 4.
    assume(not any(isinstance(item, float) and 0 < abs(item) < TINY for item in items(value)))
    data = Bottle(value).to_bytes()
    newer = bytes(to_yarp4(data))
    assert len(newer) == len(data)
    assert to_yarp3(newer) == data
    verdict = is_yarp4(data)
    assert verdict is not True
    assert is_yarp4(newer) is (None if verdict is None else True)
    assert (newer == data) == (verdict is None)
    # A float32 in front of a list of one may be the float64 of a message of 3.x.
    assert older(newer) in (None, data)
    assert codec.decode_as(newer, Bottle).to_bytes() == data or "Float32" in str(kinds(value))
    assert walk(newer, 7, yarp4=True) == len(newer)


@for_each(binaries())
def test_no_message_of_3_is_taken_for_one_of_4(message):
    assert is_yarp4(message) in (None, False)
    assert to_yarp3(bytes(to_yarp4(message))) == message


def test_a_walker_notices_by_itself():
    data = struct.pack("<iiiiiiid", 256, 3, 1, 5, 276, 0, 20, 1.5)
    assert walk(data + b"more", 5) == len(data)
    walker = Walker()
    assert walker.advance(struct.pack("<iiid", 256, 2, 20, 1.5)) > 20 and not walker.done
    with pytest.raises(DecodeError, match="unknown element tag 128"):
        Walker(yarp4=True).advance(struct.pack("<iiif", 256, 1, 128, 1.5))


@pytest.mark.parametrize(
    "data",
    [
        b"", b"\0\1\0", struct.pack("<ii", 256, 1), struct.pack("<ii", 256, -1),
        struct.pack("<iii", 256, 1, 5), struct.pack("<iiii", 256, 1, 4, -1),
        struct.pack("<iiii", 256, 1, 4, 100), struct.pack("<iii", 276, 1 << 30, 1),
        struct.pack("<ii", 260, 1 << 30), struct.pack("<ii", 256, 1) * 300, struct.pack("<i", 7),
    ],
)  # fmt: skip
def test_what_is_no_message(data):
    for look in (to_yarp4, to_yarp3):
        with pytest.raises((DecodeError, Truncated)):
            look(data)
    assert older(data) is None


@given(st.binary(max_size=200))
@settings(max_examples=200, deadline=None)
def test_any_bytes(data):
    for head in (b"", struct.pack("<ii", 256, 3), struct.pack("<iii", 256, 3, 20)):
        for look in (to_yarp4, to_yarp3, is_yarp4):
            try:
                look(head + data)
            except DecodeError:
                pass
