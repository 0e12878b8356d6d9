"""Vector: numbers of one kind, as yarp::sig::Vector sends them.

    i32 256 + tag, i32 n, n packed numbers

Rules: a received Vector is a view of the received bytes; `array` makes a numpy array of it without
copying, and numpy is not needed before. C++ reads float64 (Vector) and int32 (VectorOf<int>); the
other kinds are for yarpy peers and for Bottles.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from struct import Struct, error
from typing import TYPE_CHECKING, Any, Final, Self

from yarpy.data.array_export import ArrayExport
from yarpy.data.pickling import Wired
from yarpy.data.value import BIG, FLOAT32, FLOAT64, INT8, INT16, INT32, INT64, UNIT_MASK
from yarpy.errors import DecodeError, Truncated

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray

#: name of the kind -> tag, struct character, bytes
KINDS: Final = {
    "float64": (FLOAT64, "d", 8),
    "float32": (FLOAT32, "f", 4),
    "int32": (INT32, "i", 4),
    "int64": (INT64, "q", 8),
    "int16": (INT16, "h", 2),
    "int8": (INT8, "b", 1),
}
_NAMES: Final = {tag: name for name, (tag, _, _) in KINDS.items()}

_HEAD = Struct("<ii")


class Vector(Wired, ArrayExport, Sequence[Any]):
    """A list of numbers with a numpy array inside.

    `Vector([1, 2.5])`, `Vector(numpy_array)`, `Vector([1, 2], dtype="int32")`. It has a length, can
    be indexed, iterated, matched (`case [x, y]`) and compared with lists; `array` is the 1-D numpy
    view of the same memory, through which it can be changed unless the bytes it came from are
    read-only.
    """

    __slots__ = ("_array", "_data", "_letter", "_width", "kind")

    #: the name of the kind of the numbers: float64, float32, int32, int64, int16 or int8
    kind: str

    def __init__(
        self, values: Iterable[float] | NDArray[Any] = (), dtype: DTypeLike = "float64"
    ) -> None:
        name = _kind_name(dtype)
        _, letter, width = KINDS[name]
        self.kind = name
        self._letter = letter
        self._width = width
        self._array: NDArray[Any] | None = None
        if hasattr(values, "__array_interface__"):
            import numpy as np

            array = np.ascontiguousarray(values, dtype=np.dtype(name).newbyteorder("<"))
            if array.ndim != 1:
                raise ValueError(
                    f"a Vector has one dimension, this array has {array.ndim}: use Matrix or Image"
                )
            self._array = array
            self._data = memoryview(array.view("u1").data) if array.size else memoryview(b"")
            return
        numbers = list(values)
        try:
            packed = bytearray(Struct(f"<{len(numbers)}{letter}").pack(*numbers))
        except error as bad:
            raise TypeError(f"these values do not make a Vector of {name}: {bad}") from None
        self._data = memoryview(packed)

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """A Vector over the bytes of a message, uncopied; DecodeError if they are not one."""
        if len(view) < 8:
            raise Truncated(f"a Vector takes at least 8 bytes, here are {len(view)}", 8)
        code, count = _HEAD.unpack_from(view)
        name = _NAMES.get(code & UNIT_MASK)
        if name is None or code & ~UNIT_MASK != 256 or count < 0:
            raise DecodeError(f"not a Vector: list code {code} is not 256 plus a kind of number")
        return cls._over(memoryview(view)[8:], name, count)

    @classmethod
    def _over(cls, data: memoryview, name: str, count: int) -> Self:
        _, letter, width = KINDS[name]
        size = count * width
        if size > len(data):
            raise Truncated(
                f"a Vector of {count} {name} takes {size} bytes, only {len(data)} follow", 8 + size
            )
        self = cls.__new__(cls)
        self.kind = name
        self._letter = letter
        self._width = width
        self._array = None
        self._data = data[:size]
        return self

    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        """Header and numbers; from 4096 bytes the numbers are a block of their own, not copied."""
        head = _HEAD.pack(256 + KINDS[self.kind][0], len(self))
        if len(self._data) < BIG:
            return (head + self._data,)
        return head, self._data

    @property
    def array(self) -> NDArray[Any]:
        """The numbers as a 1-D numpy array over the same memory."""
        if self._array is None:
            import numpy as np

            dtype = np.dtype(self.kind).newbyteorder("<")
            self._array = np.frombuffer(self._data, dtype)
        return self._array

    def tolist(self) -> list[Any]:
        """The numbers as a plain list."""
        return list(Struct(f"<{len(self)}{self._letter}").unpack(self._data))

    def __len__(self) -> int:
        return len(self._data) // self._width

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, int):
            count = len(self)
            if not -count <= index < count:
                raise IndexError(f"index {index} of a Vector of {count}")
            at = index % count * self._width
            return Struct("<" + self._letter).unpack_from(self._data, at)[0]
        return self.array[index]

    def __setitem__(self, index: Any, value: Any) -> None:
        self.array[index] = value

    def __iter__(self) -> Iterator[Any]:
        return iter(self.tolist())

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Vector):
            return self.tolist() == other.tolist()
        if isinstance(other, (list, tuple)):
            return self.tolist() == list(other)
        if hasattr(other, "__array_interface__"):
            return bool(self.tolist() == other.tolist())  # type: ignore[attr-defined]
        return NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        kind = "" if self.kind == "float64" else f", dtype={self.kind!r}"
        return f"Vector({self.tolist()!r}{kind})"


def _kind_name(dtype: Any) -> str:
    """The name of a kind, of a numpy dtype or of one of the types int and float."""
    if dtype is float:
        return "float64"
    if dtype is int:
        return "int32"
    name = dtype if isinstance(dtype, str) else getattr(dtype, "name", "")
    name = name or getattr(dtype, "__name__", "")
    if name not in KINDS:
        raise TypeError(f"a Vector cannot hold {dtype!r}; it can hold {', '.join(KINDS)}")
    return name
