import struct

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.python import description

DATA = struct.pack("<4i", 256, 2, 1, 5)
ELEMENT = bytes.fromhex("00010000 03000000 04000000 0a000000 79617270792e74797065")


def test_is_the_last_element() -> None:
    said = description.of_array("<f4", (2, 1 << 40))
    message = DATA + description.described(said)
    assert message.startswith(DATA + ELEMENT)
    size = len(message) - len(DATA)
    assert Bottle.from_bytes(message) == [
        5,
        ["yarpy.type", ["array", "<f4", 2, 1 << 40], size],
    ]
    assert description.place(message) == description.place(memoryview(message)) == len(DATA)
    assert bytes(description.content(message, len(DATA))) == said


@pytest.mark.parametrize("size", [0, 1, 41, 43, 50, 58, 1000, -1, 0x7FFFFFFF, -0x80000000])
def test_a_size_that_lies(size: int) -> None:
    message = DATA + description.described(struct.pack("<ii", 256, 0))
    assert description.place(message) == len(DATA)
    assert description.place(message[:-4] + struct.pack("<i", size)) == 0
    assert description.place(message[:-8]) == 0
    assert description.place(message[:-8] + struct.pack("<ii", 17, 50)) == 0


def test_short_messages() -> None:
    for size in range(60):
        assert description.place(b"\1" * size) == 0


@pytest.mark.parametrize(
    ("dtype", "shape"), [("<u4", (7,)), ("|u1", (3, 0, 2)), ("<c16", ()), ("<f4", (2, 1 << 30))]
)
def test_the_type_of_an_array(dtype: str, shape: tuple[int, ...]) -> None:
    said = description.of_array(dtype, shape)
    assert description.array_type(said) == (dtype, shape)
    for cut in range(len(said)):
        assert description.array_type(said[:cut]) is None
    assert description.array_type(said + struct.pack("<ii", 1, 5)) is None, "one size too many"


def test_what_describes_no_array_or_one_in_another_way() -> None:
    said = description.of_array("<u4", (7,))
    for other in (said.replace(b"array", b"arroy"), said.replace(b"<u4", b"\xffu4")):
        assert description.array_type(other) is None
    assert description.array_type(description.of_array("<u4", (-7,))) is None
    for at in range(len(said)):
        damaged = said[:at] + bytes([said[at] ^ 0x80]) + said[at + 1 :]
        assert description.array_type(damaged) is None or at > len(said) - 5, "the size alone"
