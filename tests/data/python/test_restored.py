"""What restores values: descriptions that lie, sizes, counts, nesting, limits."""

import struct
from typing import Any

import numpy as np
import pytest
from support.steps import measured

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.python import description
from yarpy.errors import DecodeError


def sent(obj: Any) -> bytes:
    return b"".join(codec.encode(obj))


def lying(front: bytes, said: list[Any]) -> bytes:
    """A message with that description."""
    content = sent(Bottle([said]))[8:]
    return front + description.described(content)


BLOB3 = struct.pack("<4i", 256, 2, 12, 3) + b"abc"


@pytest.mark.parametrize(
    "said",
    [
        ["array", "|u1", 4],
        ["array", "|u1", -3],
        ["array", "|u1", 3, 1 << 40],
        ["array", "<u2", 3],
        ["array", "|u1", 1 << 62, 0],
        ["array", "|u1", *[1] * 33, 3],
        ["array", "|u1", 1.5, 2],
        ["array", "|O8", 3],
        ["array", "O", 3],
        ["array", "f4,f4", 3],
        ["array", "|u1", "3"],
        ["array"],
        ["array", 5, 3],
        ["array", "|u1", [3]],
        ["none"],
        ["complex"],
        ["image"],
        ["sound"],
        ["pointcloud"],
        ["os.system", "x"],
        ["list", 5],
        ["list", [0, ["array", "|u1", 9]]],
        ["list", [0, 5]],
        ["list", [[], ["none"]]],
        ["dict"],
        ["dict", ["a", ["none"]]],
        ["tuple", [0, ["tuple"]]],
        [5],
        [["list"], 3],
    ],
    ids=str,
)
def test_descriptions_that_lie(said: list[Any]) -> None:
    message = lying(BLOB3, said)
    with measured() as peak, pytest.raises(DecodeError):
        codec.decode(message)
    assert peak.bytes < 1 << 20
    with pytest.raises(DecodeError):
        codec.decode_as(message, np.ndarray)
    assert codec.decode_as(message, Bottle)[0] == b"abc"


@pytest.mark.parametrize("dtype", ["|b1", "<f4", "<c16"])
def test_sizes_of_nothing_take_no_memory(dtype: str) -> None:
    front = struct.pack("<4i", 256, 2, 12, 0)
    for sizes in ([0], [0, 1 << 61], [1 << 30, 1 << 30, 0]):
        message = lying(front, ["array", dtype, *sizes])
        with measured() as peak:
            try:
                assert codec.decode(message).size == 0
            except DecodeError:
                pass  # numpy has no such array
        assert peak.bytes < 1 << 16


def test_counts_that_lie() -> None:
    good = sent({"a": [None, (1, 2)], "b": np.ones(9, "u1")})
    refused = 0
    for at in range(len(good)):
        with measured() as peak:
            for byte in (0, 1, 127, 128, 255):
                bad = bytearray(good)
                bad[at] = byte
                try:
                    codec.decode(bytes(bad))
                except DecodeError:
                    refused += 1
        assert peak.bytes < 1 << 20
    assert refused > 100
    for end in range(len(good)):
        try:
            codec.decode(good[:end])
        except DecodeError:
            refused += 1


def test_elements_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", "1000")
    message = sent({"a": [[1, "x"]] * 600, "b": None, "c": ()})
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        codec.decode(message)
    numbers = sent({"a": np.ones(5000, "i1"), "b": None})
    assert codec.decode(numbers)["a"].sum() == 5000


def test_keys_that_collide() -> None:
    modulus = (1 << 61) - 1
    pairs = [Bottle([key * modulus, 0]) for key in range(1, 4)] * 60
    message = lying(struct.pack("<2i", 256, len(pairs) + 1) + sent(Bottle([*pairs]))[8:], ["dict"])
    with pytest.raises(DecodeError, match="same hash"):
        codec.decode(message)


def test_nesting_in_the_description() -> None:
    said: list[Any] = ["none"]
    for _ in range(45):
        said = ["list", [0, said]]
    with pytest.raises(DecodeError):
        codec.decode(lying(BLOB3, said))


def test_a_description_further_in_is_a_list_like_any_other() -> None:
    inner = Bottle.from_bytes(sent([1, None]))
    assert codec.decode(sent(Bottle([inner, 5]))) == Bottle([inner, 5])
