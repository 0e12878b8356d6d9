"""The end of a method's answer where it is no Bottle: replies come without a length.

    list<list<i32>>               C++ writes the tag of the inner elements into the outer list
    float32 of YARP 4.0           has the tag that a float64 has in 3.x
    getRemoteProtocolVersion      four numbers of two bytes without tags, where there is one by now:
                                  of a list with one element the second two bytes are 0

Rules: as `yarpy.data.walker.Walker`: no byte is read twice, nothing is allocated on a header's
word. An answer that is another one (`[fail]`) is a Bottle and left to it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from struct import Struct as Packing
from typing import Final

from yarpy.data.value import GROUP_MASK, LIST, MAX_DEPTH, STRING, UNIT_MASK, Buffer
from yarpy.data.walker import Walk, Walker
from yarpy.data.yarp4 import WIDTHS_3, WIDTHS_4
from yarpy.errors import DecodeError
from yarpy.kits.thrift.kind import (
    Kind,
    ListOf,
    MapOf,
    SetOf,
    has_narrow,
    is_enum,
    is_struct,
    list_code,
)

_PAIR: Final = Packing("<ii").unpack_from
_TRIPLE: Final = Packing("<iii").unpack_from
_VERSION: Final = 16

#: What no tag of the other version is mistaken for, first in 3.x, then in 4.0.
_WIDTHS: Final = ({**WIDTHS_4, **WIDTHS_3}, {**WIDTHS_3, **WIDTHS_4})

Ending = Callable[[int], Walk]


def ending_of(kind: Kind | None) -> Ending | None:
    """Return a function that finds the end of answers with such a result; None where any Bottle
    does."""
    if kind is None or not _is_odd(kind, set()):
        return None
    return lambda limit: Extent(kind, limit)


def yarp4_ending_of(kind: Kind | None) -> Ending | None:
    """As `ending_of`, where it is known that YARP 4.0 answers."""
    if kind is None or not has_narrow([kind]):
        return ending_of(kind)
    if _is_odd(kind, set()):
        return lambda limit: Extent(kind, limit, True)
    return lambda limit: Walker(limit, yarp4=True)


def version_ending(limit: int) -> Walk:
    """Return the parser that finds the end of a version."""
    return Extent(None, limit)


def is_version(code: int, count: int, tag: int) -> bool:
    """Return whether an answer that begins so is a version, of a YARP that is not 0, and not a
    list of one element with its tag, as others answer questions that they do not know."""
    return code == LIST and count == 1 and tag >> 16 > 0


def _is_odd(kind: Kind, known: set[object]) -> bool:
    if isinstance(kind, (ListOf, SetOf)):
        inner = kind.element
        return (isinstance(inner, (ListOf, SetOf)) and bool(list_code(inner))) or _is_odd(
            inner, known
        )
    if isinstance(kind, MapOf):
        return _is_odd(kind.value, known)
    if is_struct(kind) and kind not in known:
        known.add(kind)
        return any(_is_odd(each.kind, known) for each in kind._specs())  # type: ignore[union-attr]
    return False


class Extent:
    """Finds the end of one answer; None for a version. See Walker."""

    def __init__(self, kind: Kind | None, limit: int, yarp4: bool = False) -> None:
        self.done = False
        self._yarp4 = yarp4
        self._widths = _WIDTHS[yarp4]
        self._limit = limit
        self._kind = kind
        self._walker: Walker | None = None
        self._view: Buffer = b""
        self._at = 8
        self._steps: Iterator[int] | None = None
        self._need = 12

    def advance(self, view: Buffer) -> int:
        """The least number of bytes that the answer has; its length, once `done`."""
        if self._walker is None and self._steps is None:
            if len(view) < 12:
                return 12
            code, count, tag = _TRIPLE(view)
            if self._kind is None and is_version(code, count, tag):
                self.done = len(view) >= _VERSION
                return _VERSION
            if self._kind is None or code != LIST or (count == 1 and not tag & GROUP_MASK):
                self._walker = Walker(self._limit, self._yarp4)
            else:
                self._steps = self._top(self._kind)
        if self._walker is not None:
            need = self._walker.advance(view)
            self.done = self._walker.done
            return need
        assert self._steps is not None
        self._view = view
        try:
            while self._need <= len(view) and not self.done:
                try:
                    self._need = next(self._steps)
                except StopIteration:
                    self._need, self.done = self._at, self._at <= len(view)
                    break
                if self._need > self._limit:
                    raise DecodeError(f"an answer of more than {self._limit} bytes")
        finally:
            self._view = b""  # it may grow, which it cannot while somebody looks at it
        return self._need

    def _top(self, kind: Kind) -> Iterator[int]:
        yield from self._value(kind, 0)
        yield self._at

    def _value(self, kind: Kind, depth: int) -> Iterator[int]:
        if depth > MAX_DEPTH:
            raise DecodeError(f"lists nested more than {MAX_DEPTH} deep")
        if is_struct(kind):
            for each in kind._specs():  # type: ignore[union-attr]
                if each.nested:
                    yield from self._list_head()
                yield from self._value(each.kind, depth + 1)
            return
        if isinstance(kind, (ListOf, SetOf)) and not _is_bare(kind.element):
            for _ in range((yield from self._list_head())):
                if is_struct(kind.element):
                    yield from self._list_head()
                yield from self._value(kind.element, depth + 1)
        elif isinstance(kind, MapOf) and not _is_bare(kind.value):
            for _ in range((yield from self._list_head())):
                yield from self._list_head()
                yield from self._bottle()
                if is_struct(kind.value):
                    yield from self._list_head()
                yield from self._value(kind.value, depth + 1)
        else:
            yield from self._bottle()

    def _list_head(self) -> Generator[int, None, int]:
        yield self._at + 8
        found: tuple[int, int] = _PAIR(self._view, self._at)
        tag, count = found
        if not tag & LIST or count < 0:
            raise DecodeError(f"no list at byte {self._at} of an answer")
        if self._at + 4 * count > self._limit:
            raise DecodeError(f"{count} elements: an answer of more than {self._limit} bytes")
        self._at += 8
        return count

    def _bottle(self) -> Iterator[int]:
        """One element of a Bottle."""
        widths = self._widths
        waiting = [(1, 0)]
        while waiting:
            count, fixed = waiting.pop()
            if not count:
                continue
            if fixed in widths:
                self._at += count * widths[fixed]
                continue
            waiting.append((count - 1, fixed))
            yield self._at + 8 - (4 if fixed else 0)
            tag = fixed
            if not tag:
                tag = _PAIR(self._view, self._at)[0]
                self._at += 4
            if tag in widths:
                self._at += widths[tag]
                continue
            yield self._at + 4
            number = int.from_bytes(self._view[self._at : self._at + 4], "little", signed=True)
            self._at += 4
            if number < 0 or self._at + number > self._limit:
                raise DecodeError(f"a length of {number} at byte {self._at - 4} of an answer")
            if tag & GROUP_MASK:
                waiting.append((number, tag & UNIT_MASK))
                if len(waiting) > 2 * MAX_DEPTH:
                    raise DecodeError(f"lists nested more than {MAX_DEPTH} deep")
            elif tag == STRING or tag == 12:
                self._at += number
            else:
                raise DecodeError(f"unknown element tag {tag} in an answer")


def _is_bare(kind: Kind) -> bool:
    """Return whether every list of the kind is a Bottle."""
    return not isinstance(kind, (ListOf, SetOf, MapOf)) and (not is_struct(kind) or is_enum(kind))
