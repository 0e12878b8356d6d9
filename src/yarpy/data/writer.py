"""Write the binary spelling of a Bottle (its layout is described in `reader`).

Rules: a message is a tuple of blocks to be joined: a single one, unless something big is inside,
which then is a block of its own and not copied. Small messages are the hot path: there is one
packing plan for every combination of element types that came up lately.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from struct import Struct
from struct import error as struct_error
from typing import Any, Final, TypeAlias

from yarpy.data.embedded import message_of, plain
from yarpy.data.numbers import Packed
from yarpy.data.reader import read_list
from yarpy.data.text import sorted_groups, text_of
from yarpy.data.text_reader import parse_text
from yarpy.data.value import (
    BIG,
    BLOB,
    DICT,
    FIXED,
    FLOAT32,
    FLOAT64,
    GROUP_MASK,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    MAX_DEPTH,
    STRING,
    VOCAB32,
    Blocks,
    Buffer,
    Float32,
    Int8,
    Int16,
    Int64,
    Vocab,
)

#: Lists up to this long have a plan for their combination of types; so many are remembered.
_PLANNED: Final = 24
_PLANS: Final = 512
_UNPLANNED: Final[Any] = object()
_plans: Final[dict[tuple[type, ...], Callable[[Sequence[Any]], bytes] | None]] = {}

#: The payload of an element; in pieces if something big is inside.
_Payload: TypeAlias = bytes | list[bytes | memoryview]

_I32 = Struct("<i")
_I64 = Struct("<q")
_PAIR = Struct("<ii")
_TRIPLE = Struct("<iii")


def list_blocks(
    items: Sequence[Any], otherwise: Callable[[Sequence[Any]], Blocks] | None = None
) -> Blocks:
    """The message of a list: TypeError for an element that no tag stands for. `otherwise` makes it
    where there is no short way: that is for numbers and words alone."""
    bare = items
    if type(items) is not list and type(items) is not tuple:
        if isinstance(items, Packed):
            packed = items.packed_blocks()
            if packed is not None:
                return packed
        else:
            bare = items[:]  # which the interpreter looks into faster than into a class of its own
    kinds = tuple(map(type, bare))
    plan = _plans.get(kinds, _UNPLANNED)
    if plan is _UNPLANNED:
        plan = _plan(kinds) if len(kinds) <= _PLANNED else _long_plan(kinds)
    if plan is not None:
        try:
            if type(plan) is not _NumberPlan:
                return (plan(bare),)
            arguments = plan.head[:]  # as in its __call__
            arguments[plan.where] = bare
            return (plan.pack(*arguments),)
        except struct_error:
            pass  # an int beyond 32 bits
    return long_blocks(items) if otherwise is None else otherwise(items)


def long_blocks(items: Sequence[Any]) -> Blocks:
    """The message of a list, element by element."""
    code, parts = _list_parts(items, 0)
    return joined([_I32.pack(code), *parts])


def value_blocks(value: Any) -> Blocks:
    """The message of a single value: a list of one that is never specialised."""
    code, payload = element(value, 0)
    head = _TRIPLE.pack(LIST, 1, code)
    if isinstance(payload, bytes):
        return (head + payload,)
    return joined([head, *payload])


def dict_elements(values: Mapping[str, Any]) -> list[Any]:
    """The elements that a dict is sent as: its text, read back."""
    try:
        return [[_through_text(item) for item in group] for group in sorted_groups(values)]
    except _NotPlain:
        return parse_text(text_of(values))


class _NotPlain(Exception):
    """Only printing and reading it back shows what this value becomes."""


def _through_text(value: Any) -> Any:
    """A value after it was printed and read back: mostly unchanged."""
    kind = type(value)
    if kind is int or kind is bool or kind is bytes:
        return value
    if kind is str and value not in ("null", "inf", "nan"):
        return value
    if kind is float and value == value:
        return value
    if isinstance(value, (list, tuple)):
        return [_through_text(item) for item in value]
    raise _NotPlain


# ---------------------------------------------------------------------------------- short ways


def _plan(kinds: tuple[type, ...]) -> Callable[[Sequence[Any]], bytes] | None:
    """A packer for lists of elements of these types, which is remembered; None if there is no
    short way.

    It raises struct.error for an int beyond 32 bits, which no longer has the tag of its type.
    """
    if len(_plans) >= _PLANS:
        _plans.clear()
    plan = _plans[kinds] = _new_plan(kinds)
    return plan


def _new_plan(kinds: tuple[type, ...]) -> Callable[[Sequence[Any]], bytes] | None:
    tags = [_TAGS.get(kind, 0) for kind in kinds]
    if not all(tags):
        return None
    uniform = len(set(tags)) == 1
    if uniform:
        start, step, head = 2, 1, [LIST + tags[0], len(tags)]
    else:
        start, step, head = 3, 2, [LIST, len(tags)]
        for tag in tags:
            head += (tag, 0)
    if _NUMBERS.issuperset(kinds):
        gap = "" if uniform else "i"
        pack = Struct("<ii" + "".join(gap + FIXED[tag][0] for tag in tags)).pack
        return _NumberPlan(pack, head, start, step)

    begin = _PAIR.pack(head[0], head[1])
    table = _PAYLOAD if uniform else _WITH_TAG
    writers = [table[kind] for kind in kinds]

    def pack_words(items: Sequence[Any]) -> bytes:
        pieces = [begin]
        for write, item in zip(writers, items, strict=True):
            pieces.append(write(item))
        return b"".join(pieces)

    return pack_words


class _NumberPlan:
    """A packer for lists of numbers: `head` with the numbers from `start` on, `step` apart."""

    __slots__ = ("head", "pack", "where")

    def __init__(self, pack: Callable[..., bytes], head: list[int], start: int, step: int) -> None:
        self.pack = pack
        self.head: list[Any] = head
        self.where = slice(start, None, step)

    def __call__(self, items: Sequence[Any]) -> bytes:
        arguments = self.head[:]
        arguments[self.where] = items
        return self.pack(*arguments)


def _long_plan(kinds: tuple[type, ...]) -> Callable[[Sequence[Any]], bytes] | None:
    """The same for longer lists, whose combinations of types are not worth remembering."""
    kind = kinds[0]
    if kind not in _NUMBERS or kinds.count(kind) != len(kinds):
        return None
    tag = _TAGS[kind]
    pack = Struct(f"<ii{len(kinds)}{FIXED[tag][0]}").pack
    return lambda items: pack(LIST + tag, len(items), *items)


def _str_payload(value: str) -> bytes:
    text = value.encode("utf-8", "surrogateescape")
    return _I32.pack(len(text)) + text


def _str_with_tag(value: str) -> bytes:
    text = value.encode("utf-8", "surrogateescape")
    return _PAIR.pack(STRING, len(text)) + text


def _bool_payload(value: bool) -> bytes:
    return b"1\0\0\0" if value else b"\0\0\0\0"


def _bool_with_tag(value: bool) -> bytes:
    return b"\t\0\0\0001\0\0\0" if value else b"\t\0\0\0\0\0\0\0"


def _vocab_payload(value: Vocab) -> bytes:
    return _I32.pack(value.code)


def _vocab_with_tag(value: Vocab) -> bytes:
    return _PAIR.pack(VOCAB32, value.code)


_TAGS: Final[dict[type, int]] = {
    int: INT32,
    float: FLOAT64,
    str: STRING,
    bool: VOCAB32,
    Vocab: VOCAB32,
    Int8: INT8,
    Int16: INT16,
    Int64: INT64,
    Float32: FLOAT32,
}
_NUMBERS: Final = frozenset((int, float, Int8, Int16, Int64, Float32))

_PAYLOAD: Final[dict[type, Callable[[Any], bytes]]] = {
    **{kind: Struct("<" + FIXED[_TAGS[kind]][0]).pack for kind in _NUMBERS},
    str: _str_payload,
    bool: _bool_payload,
    Vocab: _vocab_payload,
}
_WITH_TAG: Final[dict[type, Callable[[Any], bytes]]] = {
    **{kind: partial(Struct("<i" + FIXED[_TAGS[kind]][0]).pack, _TAGS[kind]) for kind in _NUMBERS},
    str: _str_with_tag,
    bool: _bool_with_tag,
    Vocab: _vocab_with_tag,
}


# ---------------------------------------------------------------------------------- the long way


def _list_parts(items: Sequence[Any], depth: int) -> tuple[int, list[bytes | memoryview]]:
    """Code of a list, and what follows the code in pieces."""
    if depth > MAX_DEPTH:
        raise ValueError(f"lists nested more than {MAX_DEPTH} deep cannot be sent: flatten them")
    elements = [element(item, depth) for item in items]
    codes = [code for code, _ in elements]
    uniform = bool(codes) and codes.count(codes[0]) == len(codes) and not codes[0] & GROUP_MASK
    parts: list[bytes | memoryview] = [_I32.pack(len(codes))]
    for code, payload in elements:
        if not uniform:
            parts.append(_I32.pack(code))
        if isinstance(payload, bytes):
            parts.append(payload)
        else:
            parts += payload
    return LIST + (codes[0] if uniform else 0), parts


def element(value: Any, depth: int) -> tuple[int, _Payload]:
    """Tag and payload of one element."""
    kind = type(value)
    if kind is int:
        return _int(value)
    tag = _TAGS.get(kind)
    if tag is not None:
        return tag, _PAYLOAD[kind](value)
    if isinstance(value, (list, tuple)):
        return _list(value, depth + 1)
    if isinstance(value, (bytes, bytearray, memoryview)):
        return _blob(value)
    if isinstance(value, dict):
        code, payload = _list(dict_elements(value), depth + 1)
        head = _I32.pack(code)
        return LIST + DICT, head + payload if isinstance(payload, bytes) else [head, *payload]
    if isinstance(value, int):
        return _int(value) if not isinstance(value, (Int8, Int16, Int64)) else _odd(value)
    if isinstance(value, (str, float)):
        return _odd(value)
    number = plain(value)
    if number is not value:
        return element(number, depth)
    message = message_of(value)
    read_list(list, list, message)  # it has to be a Bottle: DecodeError
    return _I32.unpack_from(message)[0], message[4:]  # the code of a message is the tag of a list


def _int(value: int) -> tuple[int, bytes]:
    if -0x80000000 <= value <= 0x7FFFFFFF:
        return INT32, _I32.pack(value)
    try:
        return INT64, _I64.pack(value)
    except struct_error:
        raise OverflowError(
            f"{value} does not fit in 64 bits; send it as a float or a string"
        ) from None


def _odd(value: Any) -> tuple[int, bytes]:
    """An element of a subclass: of an enumeration, of a numpy float, of one of our own kinds."""
    for kind in (Vocab, str, Int8, Int16, Int64, Float32, float):
        if isinstance(value, kind):
            return _TAGS[kind], _PAYLOAD[kind](value)
    raise AssertionError(value)


def _list(items: Sequence[Any], depth: int) -> tuple[int, _Payload]:
    if isinstance(items, Packed):
        packed = items.packed_blocks()
        if packed is not None and depth <= MAX_DEPTH:
            head = packed[0]
            return LIST + items.tag, [head[4:], *packed[1:]]
    kinds = tuple(map(type, items))
    plan = _plans.get(kinds, _UNPLANNED) if depth <= MAX_DEPTH else None
    if plan is _UNPLANNED:
        plan = _plan(kinds) if len(kinds) <= _PLANNED else None
    if plan is not None:
        try:
            message = plan(items)
        except struct_error:
            pass  # an int beyond 32 bits
        else:
            return _I32.unpack_from(message)[0], message[4:]
    code, parts = _list_parts(items, depth)
    return code, parts if memoryview in map(type, parts) else b"".join(parts)


def _blob(value: Buffer) -> tuple[int, _Payload]:
    if isinstance(value, memoryview) and (value.itemsize != 1 or value.ndim != 1):
        value = value.cast("B") if value.c_contiguous else value.tobytes()
    size = len(value)
    if size > 0x7FFFFFFF:
        raise OverflowError(f"a blob of {size} bytes is too long for a Bottle: split it")
    if size < BIG:
        return BLOB, _I32.pack(size) + bytes(value)
    return BLOB, [_I32.pack(size), memoryview(value)]


def joined(parts: Sequence[bytes | memoryview]) -> Blocks:
    """The pieces with all small neighbours joined; the views among them are kept."""
    if memoryview not in map(type, parts):
        return (b"".join(parts),)
    blocks: list[bytes | memoryview] = []
    run: list[bytes | memoryview] = []
    for part in parts:
        if isinstance(part, memoryview):
            blocks += (b"".join(run), part)
            run = []
        else:
            run.append(part)
    if run:
        blocks.append(b"".join(run))
    return tuple(blocks)
