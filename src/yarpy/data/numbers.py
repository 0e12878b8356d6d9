"""Packed: a list of numbers that stays what came until somebody asks for an element.

Rules: it is a list in every way that Python asks lists, and unpacks itself at the first of them;
its length and its array do not count as that. What was received is the memory of `array`, of which
no copy is made. The limit on elements counts when they are built, for all lists of a message
together.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.array_export import ArrayExport
from yarpy.data.value import (
    BIG,
    FIXED,
    FLOAT32,
    FLOAT64,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    Blocks,
    Float32,
    Int8,
    Int16,
    Int64,
)
from yarpy.errors import DecodeError
from yarpy.limit import limits

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: tag -> numpy's name of the numbers
DTYPES: Final = {
    FLOAT64: "<f8",
    FLOAT32: "<f4",
    INT64: "<i8",
    INT32: "<i4",
    INT16: "<i2",
    INT8: "|i1",
}
_KINDS: Final[dict[int, frozenset[type]]] = {
    FLOAT64: frozenset((float,)),
    FLOAT32: frozenset((Float32,)),
    INT64: frozenset((Int64, int)),
    INT32: frozenset((int,)),
    INT16: frozenset((Int16,)),
    INT8: frozenset((Int8,)),
}
_HEAD = Struct("<ii")


class Packed(ArrayExport, list[Any]):
    """Numbers of one kind over the bytes of a message."""

    __slots__ = ("_becomes", "_room", "_view", "tag")

    #: the tag of the kind that came
    tag: int

    @classmethod
    def over(
        cls, view: memoryview, tag: int, make: Callable[[Any], Any] | None, room: list[int] | None
    ) -> Any:
        """The numbers in `view`. `make` is what an element becomes, `room` how many elements the
        message may still have."""
        self = cls.__new__(cls)  # `__init__` would be half of the time of a short message
        self._view = view
        self.tag = tag
        self._becomes = make
        self._room = room
        return self

    def __init__(self, *items: Any) -> None:
        super().__init__(*items)
        self._view: memoryview | None = None
        self._becomes: Callable[[Any], Any] | None = None
        self._room: list[int] | None = None
        self.tag = 0

    def unpack(self) -> None:
        """Build the elements, once. DecodeError if the message would have too many."""
        view = self._view
        if view is None:
            return
        letter, width = FIXED[self.tag]
        count = len(view) // width
        room = self._room
        if room is not None:
            if room[0] < count:
                raise DecodeError(
                    f"a list of more than {limits().elements} elements (YARPY_MAX_ELEMENTS); "
                    "its `array` takes less"
                )
            room[0] -= count
        values = Struct(f"<{count}{letter}").unpack(view)
        self._view = None
        super().extend(values if self._becomes is None else map(self._becomes, values))

    def packed_blocks(self) -> Blocks | None:
        """The message, uncopied if it is big; None once the elements were built."""
        view = self._view
        if view is None:
            return None
        head = _HEAD.pack(LIST + self.tag, len(self))
        return (head, view) if len(view) >= BIG else (head + view,)

    @property
    def array(self) -> NDArray[Any]:
        """The numbers as a 1-D numpy array: over the received bytes, unless elements were built."""
        import numpy as np

        if self._view is not None:
            return np.frombuffer(self._view, DTYPES[self.tag])
        if self.tag and _KINDS[self.tag].issuperset(map(type, self)):
            kind = np.dtype(DTYPES[self.tag])
            # Something larger may have been put there, which numpy 1 cuts off and tells nobody.
            if kind.kind == "f" or not self or _hold(np.iinfo(kind), self):
                return np.array(list(self), kind)
        return np.array(list(self))

    def __len__(self) -> int:
        view = self._view
        return super().__len__() if view is None else len(view) // FIXED[self.tag][1]

    def __eq__(self, other: object) -> bool:
        # Of floats, equal bytes may be unequal numbers, and the other way round.
        if isinstance(other, Packed) and self.tag == other.tag and self.tag not in _FLOATS:
            mine, its = self._view, other._view
            if mine is not None and its is not None:
                return mine == its
        if isinstance(other, Packed):
            other.unpack()
        self.unpack()
        return super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = None


_FLOATS: Final = frozenset((FLOAT64, FLOAT32))
_UNPACKING: Final = (
    *("__add__", "__contains__", "__delitem__", "__ge__", "__getitem__", "__gt__", "__iadd__"),
    *("__imul__", "__iter__", "__le__", "__lt__", "__mul__", "__repr__", "__reversed__"),
    *("__rmul__", "__setitem__", "append", "clear", "copy", "count", "extend", "index", "insert"),
    *("pop", "remove", "reverse", "sort"),
)


def _unpacking(name: str) -> Callable[..., Any]:
    def method(self: Packed, *args: Any, **options: Any) -> Any:
        self.unpack()
        for other in args:
            if isinstance(other, Packed):  # which the list would look into by itself
                other.unpack()
        return getattr(super(Packed, self), name)(*args, **options)

    method.__name__ = name
    return method


def _added(self: Packed, other: Any) -> Any:
    """`[1] + packed`: the list on the left would look into this one by itself."""
    self.unpack()
    return NotImplemented if not isinstance(other, list) else [*other, *self]


for _name, _method in [("__radd__", _added), *((name, _unpacking(name)) for name in _UNPACKING)]:
    setattr(Packed, _name, _method)


def _hold(limits: np.iinfo[Any], values: list[Any]) -> bool:
    return bool(limits.min <= min(values) and max(values) <= limits.max)
