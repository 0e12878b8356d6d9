"""Arrays as .npy: what numpy writes is read; what is damaged is refused, and takes no memory."""

from __future__ import annotations

import io

import numpy as np
import pytest
from support.steps import measured

import yarpy
from yarpy.kits.wrap.value.npy import from_npy, to_npy

ARRAYS = [
    np.arange(6.0).reshape(2, 3),
    np.asfortranarray(np.arange(6, dtype="i2").reshape(2, 3)),
    np.arange(4, dtype=">i4"),
    np.array(7, "u1"),
    np.zeros((0, 3)),
    np.array(["a", "bc"]),
]


@pytest.mark.parametrize("array", ARRAYS, ids=lambda a: f"{a.dtype.str}{a.shape}")
def test_there_and_back(array: np.ndarray) -> None:
    data = to_npy(array)
    assert np.array_equal(np.load(io.BytesIO(data)), array)
    found = from_npy(data)
    assert found.dtype == array.dtype and np.array_equal(found, array)
    assert found.flags.f_contiguous == array.flags.f_contiguous


def test_objects_are_refused_both_ways() -> None:
    with pytest.raises(TypeError, match="Python objects"):
        to_npy(np.array([{}]))
    out = io.BytesIO()
    np.save(out, np.array([{}]), allow_pickle=True)
    with pytest.raises(yarpy.DecodeError, match="run code"):
        from_npy(out.getvalue())


def test_size_is_checked_before_memory_is_taken() -> None:
    data = to_npy(np.zeros((2, 3)))
    with pytest.raises(yarpy.Truncated):
        from_npy(data[:-1])
    huge = data.replace(b"(2, 3), }" + b" " * 9, b"(2, 3000000000), }")
    assert huge != data
    with pytest.raises(yarpy.Truncated):
        from_npy(huge)


def header(dtype: str, shape: str) -> bytes:
    text = f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\1\0" + len(text).to_bytes(2, "little") + text.encode()


@pytest.mark.parametrize("shape", ["(3000000000,)", "(10**10,)", f"({10**15},)", "(1,)"])
@pytest.mark.parametrize("dtype", ["|S0", "|V0", "<U0"])
def test_elements_of_no_size_are_refused(dtype: str, shape: str) -> None:
    """numpy would give them one byte each, of which none is there."""
    with measured() as peak, pytest.raises(yarpy.DecodeError):
        from_npy(header(dtype, shape))
    assert peak.bytes < 1 << 20


@pytest.mark.parametrize("shape", ["(True,)", "(1.0,)", "1", "(-1,)", "(0, -1)", "((1,),)"])
def test_lengths_are_plain_numbers(shape: str) -> None:
    with pytest.raises(yarpy.DecodeError):
        from_npy(header("|u1", shape) + bytes(8))


@pytest.mark.parametrize(
    "data", [b"", b"x", b"\x93NUMPY", b"\x93NUMPY\x09\x00abc", b"\x93NUMPY\1\0\2\0{("]
)
def test_what_is_no_array(data: bytes) -> None:
    with pytest.raises(yarpy.DecodeError):
        from_npy(data)
