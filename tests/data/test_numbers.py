import copy
import json
import operator
import pickle
import struct
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from support.steps import measured

from yarpy.data import codec
from yarpy.data.bottle import Bottle, Numbers
from yarpy.data.value import Float32, Int8, Int16, Int64
from yarpy.errors import DecodeError, Truncated
from yarpy.wire.framing import encode
from yarpy.wire.message import Packet

KINDS = [
    (257, "<i4", int),
    (266, "<f8", float),
    (273, "<i8", Int64),
    (288, "|i1", Int8),
    (320, "<i2", Int16),
    (384, "<f4", Float32),
]


def numbers(values: Any = (1, 2, 3), code: int = 257, dtype: str = "<i4") -> Bottle:
    """The Bottle of a message of these numbers."""
    array = np.array(values, dtype)
    found = Bottle.from_bytes(struct.pack("<ii", code, len(array)) + array.tobytes())
    assert type(found) is Numbers
    return found


@pytest.mark.parametrize(("code", "dtype", "kind"), KINDS)
def test_elements_array_and_bytes(code: int, dtype: str, kind: type) -> None:
    bottle = numbers((1, 0, 3), code, dtype)
    assert bottle.array.dtype == dtype and np.asarray(bottle).tolist() == [1, 0, 3]
    wire = bottle.to_bytes()
    assert list(map(type, bottle)) == [kind] * 3 and bottle == [1, 0, 3]
    assert bottle.array.dtype == dtype, "also once there are elements"
    assert (
        wire
        == bottle.to_bytes()
        == struct.pack("<ii", code, 3) + np.array([1, 0, 3], dtype).tobytes()
    )
    empty = numbers((), code, dtype)
    assert empty == [] and not empty and empty.array.dtype == dtype and empty.array.shape == (0,)


USES: list[Callable[[Any], Any]] = [
    lambda it: it[0],
    lambda it: it[-1:],
    lambda it: [*it],
    lambda it: list(it) + sorted(it) + list(reversed(it)),
    lambda it: tuple(it),
    lambda it: set(it),
    lambda it: len(it),
    lambda it: bool(it),
    lambda it: operator.add(it, [4]),
    lambda it: operator.add([4], it),
    lambda it: it * 2,
    lambda it: 2 * it,
    lambda it: it == [1, 2, 3],
    lambda it: operator.eq([1, 2, 3], it),
    lambda it: it != [1, 2, 3],
    lambda it: it < [1, 2, 4],
    lambda it: operator.lt([0], it),
    lambda it: 2 in it,
    lambda it: it.index(2) + it.count(3),
    lambda it: (it.append(4), it.copy()),
    lambda it: (it.insert(0, 4), it.pop(), list(it)),
    lambda it: (it.reverse(), it.sort(), it.remove(2), list(it)),
    lambda it: (it.clear(), list(it)),
    lambda it: (it.__setitem__(0, 7), it.__delitem__(1), list(it)),
    lambda it: (it.extend(it), list(it)),
    lambda it: repr(it),
    lambda it: str(it),
    lambda it: json.dumps(it),
    lambda it: bytes(it),
    lambda it: sum(it),
    lambda it: struct.pack("<3i", *it),
    lambda it: np.array(it).tolist(),
    lambda it: np.array([it, it]).tolist(),
    lambda it: copy.copy(it),
    lambda it: copy.deepcopy(it),
    lambda it: pickle.loads(pickle.dumps(it)),
    lambda it: Bottle(it),
    lambda it: [9, *it, 9],
    lambda it: (lambda target: (target.extend(it), target))([0]),
    lambda it: (lambda target: (target.__setitem__(slice(0, 1), it), target))([0]),
    lambda it: (lambda target: (target.__iadd__(it), target))([0]),
    lambda it: it.to_text(),
    lambda it: it.to_bytes(),
    lambda it: it.find("1"),
    lambda it: it.group("x"),
    lambda it: codec.encode([it, "x"]),
    lambda it: codec.encode_text(it),
    lambda it: codec.encode({"a": it}),
]


@pytest.mark.parametrize("use", USES, ids=range(len(USES)))
def test_is_the_list_that_it_stands_for(use: Callable[[Any], Any]) -> None:
    assert use(numbers()) == use(Bottle([1, 2, 3]))


def test_two_of_them() -> None:
    assert numbers() == numbers() and numbers() != numbers([1, 2, 4])
    assert numbers() + numbers() == [1, 2, 3, 1, 2, 3]
    assert numbers() < numbers([2]) and numbers([1, 2]) == numbers([1, 2], 273, "<i8")
    assert numbers([0.0], 266, "<f8") == numbers([-0.0], 266, "<f8")
    nan = numbers([np.nan], 266, "<f8")
    assert nan != numbers([np.nan], 266, "<f8")


def test_is_matched_as_a_list() -> None:
    match numbers():
        case [first, *rest]:
            assert (first, rest) == (1, [2, 3])
        case _:
            raise AssertionError("no match")


def test_numbers_that_do_not_fit_any_longer() -> None:
    bottle = numbers([1, 2], 288, "|i1")
    bottle.append(1000)
    assert bottle.array.tolist() == [1, 2, 1000]
    wide = numbers()
    wide.append(1 << 40)
    assert wide.array.tolist() == [1, 2, 3, 1 << 40]


def test_the_array_is_the_received_memory() -> None:
    message = bytearray(struct.pack("<ii", 257, 1000) + bytes(4000))
    found = codec.decode(message)
    message[8] = 7
    assert found.array[0] == 7 and np.asarray(found)[0] == 7 and found[0] == 7


def test_what_is_sent_on_is_not_unpacked() -> None:
    message = b"".join(codec.encode(np.arange(1 << 20, dtype="<i2")))
    found = codec.decode(message)
    with measured() as peak:
        blocks = codec.encode(found)
        [framed] = [block for block in encode(Packet(found)) if len(block) > 1 << 20]
    assert peak.bytes < 1 << 18
    memory = np.frombuffer(message, "u1")
    for block in (blocks[-1], framed):
        assert np.shares_memory(np.frombuffer(block, "u1"), memory)


def test_large_lists_in_a_list_stay_as_they_came() -> None:
    array: NDArray[Any] = np.arange(1 << 20, dtype="<i4")
    message = b"".join(codec.encode(["set", array, [1, 2]]))
    with measured() as peak:
        found = codec.decode(message)
        assert found[1].array.sum() == array.sum() and found[2] == [1, 2]
        again = codec.encode(found)
    assert peak.bytes < 1 << 18
    assert b"".join(again) == message
    assert type(found[2]) is Bottle


def test_a_matrix_is_an_array_too() -> None:
    for shape in ((2, 3), (0, 3), (200, 300)):
        matrix = np.arange(np.prod(shape), dtype="f8").reshape(shape)
        found = np.asarray(codec.decode(b"".join(codec.encode(matrix))))
        assert found.dtype == "f8" and found.shape == shape and (found == matrix).all()
    with pytest.raises(ValueError, match="inhomogeneous"):
        np.asarray(Bottle([1, 2, [1.0]]))


@pytest.mark.parametrize("count", [-1, 4, 0x7FFFFFFF])
def test_counts_that_lie(count: int) -> None:
    for code, _, _ in KINDS:
        with pytest.raises(DecodeError):
            Bottle.from_bytes(struct.pack("<ii", code, count) + bytes(3))
    inner = struct.pack("<iiii", 256, 1, 257, count) + bytes(3)
    with pytest.raises(DecodeError):
        Bottle.from_bytes(inner)
    with pytest.raises(Truncated):
        Bottle.from_bytes(struct.pack("<iiii", 256, 1, 257, 5000) + bytes(9000))
