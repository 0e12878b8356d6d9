import struct
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.vectors import rows

from yarpy.data.sig.vector import KINDS, Vector
from yarpy.errors import DecodeError, Truncated

GOLDEN = [row for row in rows("types") if row["type"] == "vector"]


def joined(vector):
    return b"".join(vector.to_wire())


@pytest.mark.parametrize("row", GOLDEN, ids=lambda row: str(row["params"]))
def test_golden(row):
    message = bytes.fromhex(row["binary"])
    assert joined(Vector(row["params"])) == message
    assert Vector.from_wire(message) == row["params"]
    for size in range(len(message)):
        with pytest.raises(Truncated) as caught:
            Vector.from_wire(message[:size])
        assert size < caught.value.need <= len(message)


def test_is_like_a_list():
    vector = Vector([1, 2.5, -3])
    assert len(vector) == 3 and list(vector) == [1, 2.5, -3] and vector.tolist() == [1, 2.5, -3]
    assert vector[0] == 1.0 and vector[-1] == -3.0 and vector[1:].tolist() == [2.5, -3]
    assert vector == [1, 2.5, -3] == vector and vector == (1, 2.5, -3)
    assert vector == Vector((1, 2.5, -3)) and vector == np.array([1, 2.5, -3])
    assert vector != [1, 2] and vector != "word" and 2.5 in vector
    assert repr(vector) == "Vector([1.0, 2.5, -3.0])"
    for index in (3, -4):
        with pytest.raises(IndexError):
            vector[index]
    with pytest.raises(TypeError):
        hash(vector)


def test_is_a_sequence():
    """A message of floats alone arrives as a Vector: programs match it like any other list."""
    match Vector.from_wire(joined(Vector([1.5, 2.5, 1.5]))):
        case [first, *rest]:
            assert (first, rest) == (1.5, [2.5, 1.5])
        case _:
            raise AssertionError("a Vector does not match the pattern of a list")
    vector = Vector([1.5, 2.5, 1.5])
    assert isinstance(vector, Sequence)
    assert vector.count(1.5) == 2 and vector.index(2.5) == 1
    assert list(reversed(vector)) == [1.5, 2.5, 1.5]


def test_can_be_changed():
    vector = Vector([1.0, 2.0])
    vector[0] = 5
    vector.array[1] = 7
    assert vector == [5, 7] and joined(vector) == joined(Vector([5, 7]))


def test_received_is_a_view():
    message = bytearray(joined(Vector([1.0, 2.0])))
    vector = Vector.from_wire(message)
    struct.pack_into("<d", message, 8, 9.0)
    assert vector == [9.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        Vector.from_wire(bytes(message))[0] = 1


@pytest.mark.parametrize("kind", KINDS)
def test_kinds(kind):
    tag, letter, _ = KINDS[kind]
    message = struct.pack(f"<ii3{letter}", 256 + tag, 3, 1, -2, 3)
    for vector in (
        Vector([1, -2, 3], kind),
        Vector(np.array([1, -2, 3], kind), kind),
        Vector(np.array([1, -2, 3], ">f8"), np.dtype(kind)),
        Vector([1, -2, 3], getattr(np, kind)),
    ):
        assert joined(vector) == message and vector.kind == kind
        assert vector.array.dtype == kind
    again = Vector.from_wire(memoryview(message))
    assert again.kind == kind and again == [1, -2, 3]
    assert np.asarray(again).dtype == kind
    assert again.array is again.array


def test_arrays_become_double_unless_said():
    assert Vector(np.array([1, 2], "i4")).kind == "float64"
    assert Vector([1, 2], int).kind == "int32" and Vector([1], float).kind == "float64"
    assert Vector(np.arange(10.0)[::2]) == [0, 2, 4, 6, 8]
    assert Vector(np.array([])) == [] and Vector() == []


def test_numpy_arrays_are_not_copied():
    array = np.arange(1000.0)
    vector = Vector(array)
    head, numbers = vector.to_wire()
    assert len(head) == 8 and np.shares_memory(np.frombuffer(numbers), array)
    assert np.shares_memory(np.asarray(vector), array)
    assert np.asarray(vector, "f4").dtype == "f4"
    assert not np.shares_memory(np.array(vector), array)
    assert len(Vector(array[:500]).to_wire()) == 1


def test_what_is_no_vector():
    with pytest.raises(TypeError, match="Vector of float64"):
        Vector(["a"])
    with pytest.raises(TypeError, match="Vector of int32"):
        Vector([2**40], "int32")
    with pytest.raises(TypeError, match="cannot hold"):
        Vector([1], "complex128")
    with pytest.raises(ValueError, match="one dimension"):
        Vector(np.zeros((2, 2)))


@pytest.mark.parametrize(
    "message",
    [
        struct.pack("<ii", 256, 0),
        struct.pack("<ii", 260, 0),
        struct.pack("<ii", 10, 0),
        struct.pack("<ii", 266, -1),
        struct.pack("<ii", 266 + 512, 0),
    ],
)
def test_other_messages(message):
    with pytest.raises(DecodeError):
        Vector.from_wire(message)


def test_announced_count_takes_no_memory():
    with pytest.raises(Truncated) as caught:
        Vector.from_wire(struct.pack("<ii", 266, 0x7FFFFFFF) + bytes(16))
    assert caught.value.need == 8 + 8 * 0x7FFFFFFF


@given(st.lists(st.floats(allow_nan=False)))
def test_round_trip(values):
    vector = Vector(values)
    again = Vector.from_wire(joined(vector))
    assert again == values == vector
    assert again.array.tolist() == values
