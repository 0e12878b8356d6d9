"""Numbers in CDR, as a reader of ROS 2 takes them."""

import struct

import numpy as np
import pytest
from support.recordings import payload_of

import yarpy
from yarpy.kits.record.form import numbers
from yarpy.kits.record.form.form import Converted, restored


def doubles(data: bytes) -> tuple[float, ...]:
    """What is in a Float64MultiArray: encapsulation, no dimensions, no offset, the numbers."""
    assert data[:12] == bytes((0, 1, 0, 0)) + bytes(8)
    (count,) = struct.unpack_from("<I", data, 12)
    return struct.unpack_from(f"<{count}d", data, 20)


def written(found: Converted | None) -> bytes:
    assert found is not None
    return b"".join(found.parts(None))


def test_a_vector_is_there_once() -> None:
    payload = payload_of(yarpy.Vector([1.5, -2.5, 3.5]))
    data = written(numbers.vector(payload))
    assert doubles(data) == (1.5, -2.5, 3.5)
    assert len(data) == 20 + len(payload)
    parts, _ = restored("cdr body", memoryview(data), False)
    assert b"".join(parts) == payload


def test_a_matrix_row_by_row() -> None:
    payload = payload_of(yarpy.Matrix(np.array([[1.0, 2], [3, 4]])))
    data = written(numbers.matrix(payload))
    assert doubles(data) == (1, 2, 3, 4)
    parts, _ = restored("cdr body", memoryview(data), False)
    assert b"".join(parts) == payload


@pytest.mark.parametrize(
    "payload",
    [
        payload_of(yarpy.Vector([])),
        payload_of(yarpy.Vector([1], dtype="int32")),
        payload_of(yarpy.Vector([1.0])) + b"\0",
        b"\0",
    ],
)
def test_what_is_no_list_of_float64(payload: bytes) -> None:
    assert numbers.vector(payload) is None


def test_an_empty_matrix() -> None:
    assert numbers.matrix(payload_of(yarpy.Matrix())) is None


def test_numbers_of_any_kind() -> None:
    payload = payload_of([1, 2.5])
    data = written(numbers.numbers((1, 2.5), payload))
    assert doubles(data) == (1.0, 2.5)
    assert restored("cdr", memoryview(data), False) == ((payload,), "")
