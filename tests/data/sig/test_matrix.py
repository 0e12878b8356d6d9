import struct

import numpy as np
import pytest
from support.vectors import rows

from yarpy.data.bottle import Bottle
from yarpy.data.sig.matrix import Matrix
from yarpy.errors import DecodeError, Truncated

(GOLDEN,) = (row for row in rows("types") if row["type"] == "matrix")
MESSAGE = bytes.fromhex(GOLDEN["binary"])


def joined(matrix):
    return b"".join(matrix.to_wire())


def test_golden():
    matrix = Matrix(GOLDEN["params"])
    assert joined(matrix) == MESSAGE
    again = Matrix.from_wire(MESSAGE)
    assert again == matrix and again.array.tolist() == GOLDEN["params"]
    assert (again.rows, again.cols) == again.array.shape == (2, 3)
    assert Bottle.from_bytes(MESSAGE).to_text() == "2 3 (0.0 1.0 2.0 10.0 11.0 12.0)"
    for size in range(len(MESSAGE)):
        with pytest.raises(Truncated) as caught:
            Matrix.from_wire(MESSAGE[:size])
        assert size < caught.value.need <= len(MESSAGE)


def test_takes_any_table():
    assert Matrix(np.arange(6, dtype="f4").reshape(2, 3).T).array.tolist() == [
        [0, 3],
        [1, 4],
        [2, 5],
    ]
    assert Matrix(np.zeros((0, 3))).array.shape == (0, 3)
    assert Matrix.from_wire(joined(Matrix(np.zeros((3, 0))))).array.shape == (3, 0)
    for wrong in ([1.0, 2.0], 5.0, [[[1.0]]]):
        with pytest.raises(ValueError, match="two dimensions"):
            Matrix(wrong)


def test_memory():
    array = np.arange(1024.0).reshape(32, 32)
    head, numbers = Matrix(array).to_wire()
    assert len(head) == 32 and np.shares_memory(np.frombuffer(numbers), array)
    message = bytearray(joined(Matrix([[1.0, 2.0]])))
    matrix = Matrix.from_wire(message)
    matrix.array[0, 1] = 7
    assert joined(Matrix([[1.0, 7.0]])) == message
    assert np.asarray(matrix).tolist() == [[1, 7]]
    assert np.asarray(matrix, "f4").dtype == "f4"
    assert not np.shares_memory(np.array(matrix), matrix.array)


def test_comparison_and_repr():
    assert Matrix([[1.0]]) == Matrix([[1]]) and Matrix([[1.0]]) != Matrix([[2.0]])
    assert Matrix([[1.0, 2.0]]) != Matrix([[1.0], [2.0]]) and Matrix([[1.0]]) != [[1.0]]
    assert repr(Matrix([[1, 2]])) == "Matrix([[1.0, 2.0]])"


@pytest.mark.parametrize("at", [0, 4, 8, 12, 16, 20, 24, 28])
@pytest.mark.parametrize("word", [-1, 0, 77, 0x7FFFFFFF])
def test_wrong_header(at, word):
    message = bytearray(MESSAGE)
    struct.pack_into("<i", message, at, word)
    with pytest.raises(DecodeError):
        Matrix.from_wire(message)


def test_announced_size_takes_no_memory():
    head = struct.pack("<8i", 256, 3, 1, 32768, 1, 32768, 266, 1 << 30)
    with pytest.raises(Truncated):
        Matrix.from_wire(head + bytes(100))
