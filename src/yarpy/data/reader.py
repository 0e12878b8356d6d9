"""Read the binary spelling of a Bottle.

    i32 code    256 for mixed elements, 256 + tag when all elements have that tag
    i32 count
    elements    i32 tag + payload when mixed, payload only otherwise

Rules: a count or length is checked against the bytes that are there before memory is taken for it.
Only DecodeError and Truncated come out. Bytes after the end are ignored here. Like a C++ reader,
this one looks only at the low byte of the first code. What lists and dicts are made of, the caller
says: this file knows neither Bottle nor Property. A list of numbers is not looked into if the
caller has something to keep it in as it came. (Protocol of YARP 3.x.)
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct, unpack_from
from struct import error as struct_error
from typing import Any, Final, TypeAlias, TypeVar

from yarpy.data.value import (
    BIG,
    BLOB,
    DICT,
    FIXED,
    FLOAT32,
    FLOAT64,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    MAX_DEPTH,
    STRING,
    UNIT_MASK,
    VOCAB32,
    Buffer,
    Float32,
    Int8,
    Int16,
    Int64,
    vocab_of,
)
from yarpy.errors import DecodeError, Truncated
from yarpy.limit import limits

#: Messages up to this size are copied once: slicing bytes is much cheaper than slicing views. Their
#: elements are not counted either.
SMALL: Final = 1 << 16

_read_i32 = Struct("<i").unpack_from
_read_pair = Struct("<ii").unpack_from
_read_i64 = Struct("<q").unpack_from
_read_f64 = Struct("<d").unpack_from
_read_f32 = Struct("<f").unpack_from
_read_i16 = Struct("<h").unpack_from

L = TypeVar("L", bound=list[Any])
#: makes a list of the memory of its numbers, their tag, what each becomes, and how many elements
#: the message may still have
Keep: TypeAlias = Callable[[memoryview, int, Callable[[Any], Any] | None, list[int] | None], Any]


def read_list(
    make_list: type[L], make_dict: Callable[[L], Any], view: Buffer, keep: Keep | None = None
) -> L:
    """The list at the start of `view`; Truncated or DecodeError if there is none.

    It and the lists within are made by `make_list()`, a dict by `make_dict` of the list of its
    `(key value ...)` lists; a list of numbers, and large ones in it, by `keep`.
    """
    size = len(view)
    if keep is not None and size >= 8:
        code, count = _read_pair(view)
        kind = code & UNIT_MASK
        if kind in KEPT:
            packed = _packed(memoryview(view), 8, kind, count)
            room = None if size <= SMALL else room_for(size)
            kept: L = keep(packed, kind, _FROM_FIXED.get(kind), room)
            return kept
    if size <= SMALL:
        return read_small(make_list, make_dict, bytes(view), keep)[0]
    items = make_list()
    buffer = memoryview(view)
    room = room_for(size)
    try:
        code, count = _read_pair(buffer)
        kind = code & UNIT_MASK
        _read_items(buffer, 8, kind, count, 0, items, room, make_list, make_dict, keep)
    except struct_error:
        raise _beyond(size) from None
    return items


def read_element(
    make_list: type[L],
    make_dict: Callable[[L], Any],
    view: memoryview,
    pos: int,
    depth: int,
    room: list[int] | None,
) -> tuple[Any, int]:
    """The element at `pos`, tag and all, in a list that is `depth` lists deep; and where it ends.
    `room`: how many elements the message may still have. Raises as `read_list`."""
    items = make_list()
    try:
        end = _read_items(view, pos, 0, 1, depth, items, room, make_list, make_dict, None)
    except struct_error:
        raise _beyond(len(view)) from None
    return items[0], end


def read_planned(make_list: type[L], buffer: Buffer, count: int) -> tuple[L, int] | None:
    """The list that a buffer begins with, and how many bytes it takes; None if it is not of the
    kind that came last in that size, with that `count` (as its head says) of elements.

    Messages of a kind follow each other: if the last one of the same size and count held plain
    numbers alone, this one is taken apart in the same way, and the tags in it show whether that was
    right.
    """
    plan = _plans.get((len(buffer), count))
    if plan is not None:
        parts = plan.unpack_from(buffer)
        if parts[::2] == plan.tags:
            return make_list(parts[1::2]), plan.end
    return None


def read_small(
    make_list: type[L], make_dict: Callable[[L], Any], buffer: bytes, keep: Keep | None = None
) -> tuple[L, int]:
    """The list that at most SMALL bytes begin with, and how many it takes; as `read_list`."""
    if len(buffer) >= 8:
        code, count = _read_pair(buffer)
        if code == LIST:
            found = read_planned(make_list, buffer, count)
            if found is not None:
                return found
    return read_fresh(make_list, make_dict, buffer, keep)


def read_fresh(
    make_list: type[L], make_dict: Callable[[L], Any], buffer: bytes, keep: Keep | None = None
) -> tuple[L, int]:
    """As `read_small`, for what `read_planned` has not read. What is learned here of a message of
    plain numbers lets that read the next one."""
    size = len(buffer)
    if size < 8:
        raise Truncated(f"a Bottle takes at least 8 bytes, here are {size}", 8)
    items = make_list()
    try:
        code, count = _read_pair(buffer)
        kind = code & UNIT_MASK
        end = _read_items(buffer, 8, kind, count, 0, items, None, make_list, make_dict, keep)
    except struct_error:
        raise _beyond(size) from None
    planned = code == LIST and 0 < count <= _PLANNED
    if planned and _NUMBERS.issuperset(map(type, items)):
        fresh = _Plan([INT32 if type(item) is int else FLOAT64 for item in items])
        if fresh.end == end:  # else there was an int of 64 bits
            if len(_plans) >= _PLANS:
                _plans.clear()
            _plans[size, count] = fresh
    return items, end


def _beyond(size: int) -> Truncated:
    return Truncated(f"the Bottle goes on beyond its {size} bytes", size + 1)


class _Plan:
    """A layout by which a list is read whose elements have the tags INT32 and FLOAT64."""

    __slots__ = ("end", "tags", "unpack_from")

    def __init__(self, tags: list[int]) -> None:
        layout = Struct("<8x" + "".join("i" + FIXED[tag][0] for tag in tags))
        self.tags = tuple(tags)
        self.unpack_from = layout.unpack_from
        self.end = layout.size


_PLANNED: Final = 24  # elements of a list that has a plan
_PLANS: Final = 512  # kept; their number is the peers' choice
_NUMBERS: Final = frozenset((int, float))
_plans: Final[dict[tuple[int, int], _Plan]] = {}

#: the tags of numbers
KEPT: Final = frozenset(FIXED) - {VOCAB32}


def room_for(size: int) -> list[int] | None:
    """Return how many elements a message of `size` bytes may still have; None if there cannot be
    too many.

    An element takes a byte on the wire, and forty here."""
    most = limits().elements
    return [most] if size > most else None


def _read_items(
    buffer: bytes | memoryview,
    pos: int,
    kind: int,
    count: int,
    depth: int,
    items: L,
    room: list[int] | None,
    make_list: type[L],
    make_dict: Callable[[L], Any],
    keep: Keep | None,
) -> int:
    """Append `count` elements to `items`; gives the position after them."""
    if count <= 0:
        if count < 0:
            raise DecodeError(f"a list with {count} elements at byte {pos - 4}")
        return pos
    if room is not None:
        room[0] -= count
        if room[0] < 0:
            raise DecodeError(
                f"a list of more than {limits().elements} elements (YARPY_MAX_ELEMENTS); numbers "
                "in an array take less"
            )
    if kind:
        return read_run(buffer, pos, kind, count, items)
    size = len(buffer)
    if count * 5 > size - pos:
        raise _too_short(pos, count, 5, size)
    add = items.append
    last_pair = size - 8
    for _ in range(count):
        if pos > last_pair:
            pos = _read_tiny(buffer, pos, items)
            continue
        tag, word = _read_pair(buffer, pos)
        if tag == INT32:
            add(word)
            pos += 8
        elif tag == STRING:
            end = pos + 8 + word
            if word < 0 or end > size:
                raise _bad_length(pos + 4, word, size)
            add(str(buffer[pos + 8 : end], "utf-8", "surrogateescape"))
            pos = end
        elif tag == FLOAT64:
            add(_read_f64(buffer, pos + 4)[0])
            pos += 12
        elif tag == VOCAB32:
            add(vocab_of(word))
            pos += 8
        elif LIST <= tag < 2 * DICT:
            if depth >= MAX_DEPTH:
                raise DecodeError(f"lists nested more than {MAX_DEPTH} deep")
            if tag & DICT:
                kind, start = word & UNIT_MASK, pos + 12
                word = _read_i32(buffer, pos + 8)[0]
            else:
                kind, start = tag & UNIT_MASK, pos + 8
                if keep is not None and word * 8 >= BIG and kind in KEPT:
                    packed = _packed(memoryview(buffer), start, kind, word)
                    add(keep(packed, kind, _FROM_FIXED.get(kind), room))
                    pos = start + len(packed)
                    continue
            inner = make_list()
            pos = _read_items(
                buffer, start, kind, word, depth + 1, inner, room, make_list, make_dict, keep
            )
            add(make_dict(inner) if tag & DICT else inner)
        elif tag == BLOB:
            end = pos + 8 + word
            if word < 0 or end > size:
                raise _bad_length(pos + 4, word, size)
            add(bytes(buffer[pos + 8 : end]))
            pos = end
        elif tag == INT64:
            add(_int64(_read_i64(buffer, pos + 4)[0]))
            pos += 12
        elif tag == FLOAT32:
            add(_float32(_read_f32(buffer, pos + 4)[0]))
            pos += 8
        elif tag in (INT8, INT16):
            pos = _read_tiny(buffer, pos, items)
        else:
            raise _unknown_tag(tag, pos)
    return pos


def _read_tiny(buffer: bytes | memoryview, pos: int, items: list[Any]) -> int:
    """One element that may end less than 8 bytes after its start."""
    tag = _read_i32(buffer, pos)[0]
    if tag == INT8:
        if pos + 4 >= len(buffer):
            raise Truncated("the Bottle ends inside a number", pos + 5)
        items.append(_int8(_signed(buffer[pos + 4])))
        return pos + 5
    if tag == INT16:
        items.append(_int16(_read_i16(buffer, pos + 4)[0]))
        return pos + 6
    if tag not in FIXED and tag not in (STRING, BLOB) and not LIST <= tag < 2 * DICT:
        raise _unknown_tag(tag, pos)
    raise Truncated("the Bottle ends inside an element", pos + 8)


def _packed(buffer: memoryview, pos: int, kind: int, count: int) -> memoryview:
    """The memory of `count` numbers of that kind."""
    if count < 0:
        raise DecodeError(f"a list with {count} elements at byte {pos - 4}")
    width = FIXED[kind][1]
    end = pos + count * width
    if end > len(buffer):
        raise _too_short(pos, count, width, len(buffer))
    return buffer[pos:end]


def read_run(buffer: bytes | memoryview, pos: int, kind: int, count: int, items: list[Any]) -> int:
    """`count` > 0 elements that all have the tag `kind` and therefore carry none."""
    size = len(buffer)
    fixed = FIXED.get(kind)
    if fixed is not None:
        letter, width = fixed
        end = pos + count * width
        if end > size:
            raise _too_short(pos, count, width, size)
        values = unpack_from(f"<{count}{letter}", buffer, pos)
        if kind in (INT32, FLOAT64):
            items.extend(values)
        else:
            items.extend(map(_FROM_FIXED[kind], values))
        return end
    if kind != STRING and kind != BLOB:
        raise _unknown_tag(kind, pos)
    if count * 4 > size - pos:
        raise _too_short(pos, count, 4, size)
    for _ in range(count):
        length = _read_i32(buffer, pos)[0]
        start = pos + 4
        pos = start + length
        if length < 0 or pos > size:
            raise _bad_length(start - 4, length, size)
        if kind == STRING:
            items.append(str(buffer[start:pos], "utf-8", "surrogateescape"))
        else:
            items.append(bytes(buffer[start:pos]))
    return pos


def _signed(byte: int) -> int:
    return byte - 256 if byte > 127 else byte


# `object`: what is declared as `int` or `float` is a plain one once it is compiled.
def _int8(value: int) -> object:
    return int.__new__(Int8, value)


def _int16(value: int) -> object:
    return int.__new__(Int16, value)


def _int64(value: int) -> object:
    # What needs 64 bits anyway may be a plain int: it is sent as 64 bits again.
    if -0x80000000 <= value <= 0x7FFFFFFF:
        return int.__new__(Int64, value)
    return value


def _float32(value: float) -> object:
    return float.__new__(Float32, value)


_FROM_FIXED: Final[dict[int, Callable[[Any], Any]]] = {
    VOCAB32: vocab_of,
    INT64: _int64,
    INT8: _int8,
    INT16: _int16,
    FLOAT32: _float32,
}


def _unknown_tag(tag: int, pos: int) -> DecodeError:
    return DecodeError(f"unknown element tag {tag} at byte {pos}: not a Bottle of YARP 3.x")


def _too_short(pos: int, count: int, width: int, size: int) -> Truncated:
    return Truncated(
        f"a list announces {count} elements at byte {pos - 4}, only {size - pos} bytes follow",
        pos + count * width,
    )


def _bad_length(pos: int, length: int, size: int) -> DecodeError:
    if length < 0:
        return DecodeError(f"a length of {length} at byte {pos}")
    need = pos + 4 + length
    return Truncated(f"{length} bytes announced at byte {pos}, only {size - pos - 4} follow", need)
