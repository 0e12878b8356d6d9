"""Messages of YARP 4.0, which gave the floats other tags, to those of YARP 3.x and back.

                3.x    4.0                      3.x    4.0
    float64      10     20      lists of them   266    276
    float32     128     10                      384    266
    vocab64       -     18                        -    274     becomes a string

Rules: everything else is the same in both. `is_yarp4` says which one a message is: most by a tag
that only one of them has; where 10 or 266 comes first, by what stands behind as many float32:
the end of the message, or a tag. (Whoever tries 3.x first errs with a float32 in front of a list of
one, which C++ sends nowhere.) Linear in the bytes; only DecodeError and Truncated come out.
"""

from __future__ import annotations

from struct import Struct, unpack_from
from struct import error as struct_error
from typing import Final

from yarpy.data.value import (
    BLOB,
    DICT,
    FIXED,
    FLOAT32,
    FLOAT64,
    GROUP_MASK,
    INT16,
    LIST,
    MAX_DEPTH,
    STRING,
    UNIT_MASK,
    VOCAB32,
    Buffer,
)
from yarpy.errors import DecodeError, Truncated

#: tags of YARP 4.0
FLOAT32_4: Final = 10
VOCAB64_4: Final = 18
FLOAT64_4: Final = 20

#: bytes of the kinds that always take as many, by tag
WIDTHS_3: Final = {tag: width for tag, (_, width) in FIXED.items()}
WIDTHS_4: Final = {
    **{tag: width for tag, width in WIDTHS_3.items() if tag not in (FLOAT32, FLOAT64)},
    FLOAT32_4: 4,
    VOCAB64_4: 8,
    FLOAT64_4: 8,
}

#: tags that only one of them has
ONLY_3: Final = frozenset((FLOAT32,))
ONLY_4: Final = frozenset((FLOAT64_4, VOCAB64_4))

#: what it is called in 3.x
TO_3: Final = {FLOAT64_4: FLOAT64, FLOAT32_4: FLOAT32, VOCAB64_4: STRING}
_TO_4: Final = {FLOAT64: FLOAT64_4, FLOAT32: FLOAT32_4}

_KINDS: Final = frozenset((*WIDTHS_3, *WIDTHS_4, STRING, BLOB))
#: every word that can stand where a tag belongs
_TAGS: Final = _KINDS | {LIST, LIST | DICT} | {LIST + kind for kind in _KINDS}

#: how images begin
_IMAGE: Final = Struct("<3i4s").pack(LIST, 4, VOCAB32, b"mat\0")
#: a Sound of 3.9, one of 4.0, and its empty list of markers
_SOUND: Final = Struct("<10i")
_NEW_SOUND: Final = Struct("<12i")
_MARKERS: Final = Struct("<2i").pack(LIST, 0)

_i32 = Struct("<i").unpack_from
_word = Struct("<i").pack


def to_yarp4(data: Buffer) -> Buffer:
    """A message of 3.x as 4.0 spells it; the same object if that is no other. DecodeError if it is
    no Bottle."""
    return _Walk(data, WIDTHS_3, _TO_4).renamed()


def to_yarp3(data: Buffer) -> Buffer:
    """A message of 4.0 as 3.x spells it; as `to_yarp4`."""
    return _Walk(data, WIDTHS_4, TO_3).renamed()


def newest(blocks: tuple[Buffer, ...]) -> tuple[Buffer, ...]:
    """A message in pieces, whatever it is, as 4.0 spells it; the same object if that is no other.
    Images, which have no floats in front of their pixels, are not looked through."""
    if blocks and bytes(blocks[0][: len(_IMAGE)]) == _IMAGE:
        return blocks
    data = b"".join(blocks)
    if len(data) >= _SOUND.size:
        kind, size, zero, samples, *rest = _SOUND.unpack_from(data)
        if (kind, size, zero) == (LIST, 4, 0):
            head = (LIST, 6, 1, samples, *rest, LIST + INT16, (len(data) - _SOUND.size) // 2)
            return _NEW_SOUND.pack(*head), data[_SOUND.size :], _MARKERS
    try:
        other = data if is_yarp4(data) else to_yarp4(data)
    except DecodeError:
        return blocks
    return blocks if other is data else (other,)


def older(data: Buffer) -> Buffer | None:
    """A message of 4.0 as 3.x spells it; None if it is none."""
    try:
        return to_yarp3(data) if is_yarp4(data) else None
    except DecodeError:
        return None


def is_yarp4(data: Buffer) -> bool | None:
    """Return whether a message is of YARP 4; None if it is the same in both versions.
    Raises DecodeError."""
    return _Walk(data, WIDTHS_3, {}).verdict()


class _Walk:
    """A walk over the tags of a message, which begins with the header of a list."""

    def __init__(self, data: Buffer, widths: dict[int, int], names: dict[int, int]) -> None:
        self.data = data
        self.size = len(data)
        self.widths = widths
        self.names = names
        self.patches: list[tuple[int, int, bytes]] = []  # where, how many bytes, what instead
        self.decides = False
        self.is_4: bool | None = None

    def renamed(self) -> Buffer:
        self._run()
        if not self.patches:
            return self.data
        pieces: list[Buffer] = []
        at = 0
        for where, length, instead in self.patches:
            pieces += (self.data[at:where], instead)
            at = where + length
        return b"".join((*pieces, self.data[at:]))

    def verdict(self) -> bool | None:
        self.decides = True
        self._run()
        return self.is_4

    def _run(self) -> None:
        try:
            self._steps()
        except struct_error:
            raise Truncated("the message ends in the middle", self.size + 1) from None

    def _steps(self) -> None:
        data, widths, names = self.data, self.widths, self.names
        at = 0
        waiting = [(1, 0)]  # how many elements, and their tag if it stands in the list's header
        while waiting:
            count, kind = waiting.pop()
            if not count:
                continue
            width = widths.get(kind)
            if width is not None:
                at = self._bare(at, count, kind, width)
            else:
                waiting.append((count - 1, kind))
                where = at
                tag = kind
                if not tag:
                    tag = _i32(data, at)[0]
                    at += 4
                if tag in widths or (self.decides and tag in ONLY_4):
                    if self.decides and self._decided(tag, at, 1):
                        return
                    if tag in names:
                        at = self._patched(where, tag, at)
                    at += widths.get(tag, 8)
                elif tag in (STRING, BLOB):
                    at = self._behind(at)
                elif tag & GROUP_MASK:
                    if tag & DICT:
                        where, tag = at, _i32(data, at)[0]
                        at += 4
                    inner = tag & UNIT_MASK
                    found = _i32(data, at)[0]
                    at += 4
                    if found < 0 or len(waiting) > 2 * MAX_DEPTH:
                        raise DecodeError(f"no list at byte {where}")
                    if self.decides and self._decided(inner, at, found):
                        return
                    if inner in names:
                        self.patches.append((where, 4, _word(LIST + names[inner])))
                    waiting.append((found, inner))
                else:
                    raise DecodeError(f"{tag} at byte {where} is no tag of a Bottle")
            if at > self.size:
                raise Truncated("the message ends in the middle", at)

    def _behind(self, at: int) -> int:
        """Behind a string or a blob."""
        length: int = _i32(self.data, at)[0]
        if length < 0:
            raise DecodeError(f"a length of {length} at byte {at}")
        return at + 4 + length

    def _patched(self, where: int, tag: int, at: int) -> int:
        name = self.names[tag]
        self.patches.append((where, 4, _word(name)))
        if name == STRING:
            self._to_string(at)
        return at

    def _bare(self, at: int, count: int, kind: int, width: int) -> int:
        """Behind elements without tags."""
        end = at + count * width
        if self.names.get(kind) == STRING and end <= self.size:
            for each in range(at, end, width):
                self._to_string(each)
        return end

    def _to_string(self, at: int) -> None:
        """A vocab64: eight characters, the first in the lowest byte."""
        text = bytes(self.data[at : at + 8]).replace(b"\0", b"")
        self.patches.append((at, 8, _word(len(text)) + text))

    def _decided(self, tag: int, at: int, count: int) -> bool:
        """Return whether `count` elements of this tag tell which of the two versions it is."""
        if tag in ONLY_4:
            self.is_4 = True
        elif tag in ONLY_3:
            self.is_4 = False
        elif tag == FLOAT64 and count:
            behind = at + 4 * count
            if behind + 4 <= self.size:
                self.is_4 = unpack_from("<i", self.data, behind)[0] in _TAGS
            else:
                self.is_4 = behind == self.size
        else:
            return False
        return True
