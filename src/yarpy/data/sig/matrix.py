"""Matrix: a table of numbers, as yarp::sig::Matrix sends it.

    256, 3, 1, rows, 1, cols, 266, rows * cols, float64 row by row

Rules: always double precision; a received Matrix is a view of the received bytes.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, Any, ClassVar, Self

from yarpy.data.array_export import ArrayExport
from yarpy.data.pickling import Wired
from yarpy.data.value import BIG
from yarpy.errors import DecodeError, Truncated

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_HEAD = Struct("<8i")


class Matrix(Wired, ArrayExport):
    """Rows and columns of float64. `Matrix(array)` takes anything numpy makes two-dimensional;
    `Matrix()` has no rows and no columns."""

    __slots__ = ("_array", "_data", "cols", "rows")

    #: arrays of two dimensions and other numbers are sent as images
    takes_images: ClassVar = True

    rows: int
    cols: int

    def __init__(self, array: ArrayLike | None = None) -> None:
        import numpy as np

        if array is None:
            array = np.empty((0, 0))
        values = np.ascontiguousarray(array, dtype="<f8")
        if np.ndim(array) != 2:
            raise ValueError(f"a Matrix has two dimensions, this has {np.ndim(array)}: use Vector")
        self._array: NDArray[Any] | None = values
        self._data = memoryview(values.data).cast("B") if values.size else memoryview(b"")
        self.rows, self.cols = values.shape

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """A Matrix over the bytes of a message; DecodeError if they are not one."""
        if len(view) < _HEAD.size:
            raise Truncated(f"a Matrix has a header of {_HEAD.size} bytes", _HEAD.size)
        code, length, tag, rows, tag2, cols, list_code, count = _HEAD.unpack_from(view)
        if list_code == 256 and not count:  # an empty list that went through a Bottle
            list_code = 266
        if (code, length, tag, tag2, list_code) != (256, 3, 1, 1, 266):
            raise DecodeError("not a Matrix, a list of rows, columns and a list of float64")
        if rows < 0 or cols < 0 or count != rows * cols:
            raise DecodeError(f"a Matrix of {rows} times {cols} with {count} numbers")
        end = _HEAD.size + 8 * count
        if len(view) < end:
            raise Truncated(f"a Matrix of {rows} times {cols} takes {end} bytes", end)
        self = cls.__new__(cls)
        self.rows, self.cols = rows, cols
        self._array = None
        self._data = memoryview(view)[_HEAD.size : end]
        return self

    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        """Header and numbers; from 4096 bytes the numbers are a block of their own, not copied."""
        head = _HEAD.pack(256, 3, 1, self.rows, 1, self.cols, 266, self.rows * self.cols)
        if len(self._data) < BIG:
            return (head + self._data,)
        return head, self._data

    @property
    def array(self) -> NDArray[Any]:
        """The numbers, shape (rows, cols), over the same memory."""
        if self._array is None:
            import numpy as np

            self._array = np.frombuffer(self._data, "<f8").reshape(self.rows, self.cols)
        return self._array

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Matrix):
            return NotImplemented
        shape = (self.rows, self.cols)
        return shape == (other.rows, other.cols) and bool((self.array == other.array).all())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Matrix({self.array.tolist()!r})"
