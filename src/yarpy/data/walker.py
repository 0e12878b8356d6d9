"""The end of a message that carries its length only inside itself.

Replies and some messages come without any length. A Walker finds their end in a buffer that is
still growing, without building objects. Rules: no byte is read twice, nothing is allocated on a
header's word, and bytes that cannot be a message are refused at the first wrong one. A PointCloud
may begin as a list does: where its header is there, or most of it, it is one; a list that ends
within so few bytes is complete where no more has come, or what has is no part of such a header.
Messages of YARP 4.0 are known by the tags that only it has; where there is none before a float32,
the asker says so.
"""

from __future__ import annotations

from struct import Struct
from typing import Final, Protocol

from yarpy.data.sig.cloud_head import HEAD, POINTS, cloud_size, is_likely_cloud, may_be_cloud
from yarpy.data.value import (
    BLOB,
    DICT,
    LIST,
    MAX_DEPTH,
    STRING,
    UNIT_MASK,
    Buffer,
)
from yarpy.data.yarp4 import ONLY_4, WIDTHS_3, WIDTHS_4
from yarpy.errors import DecodeError

_HEAD: Final = HEAD.size

_read_i32 = Struct("<i").unpack_from
_read_pair = Struct("<ii").unpack_from
_read_sound = Struct("<10i").unpack_from


def sound_size(view: Buffer) -> int:
    """Return how many bytes the Sound takes whose header of 40 bytes this is, as YARP 3.9 has it.
    Raises DecodeError."""
    _, _, _, samples, one, channels, also, _, again, _ = _read_sound(view, 0)
    if (one, also, again) != (1, 1, 1) or samples < 0 or channels < 0:
        raise DecodeError("unknown element tag 0 at byte 8: not a Bottle")
    size: int = 40 + 2 * samples * channels
    return size


class Walk(Protocol):
    """Finds the end of a message in a buffer that grows."""

    done: bool

    def advance(self, view: Buffer) -> int:
        """The least number of bytes that the message has; its length, once `done`."""


class Walker:
    """Finds the end of one Bottle (or of a Sound, which only looks like one, also within one), or
    of a PointCloud.

    Call `advance` with everything received so far, again and again, until `done`. Every call
    returns the least number of bytes that the message can have; if that is more than have come,
    call again when so many are there. Once `done`, it is the length of the message. DecodeError if
    this is not a message, or longer than `limit` bytes. `yarp4`: it comes from YARP 4.0. `nested`:
    it is part of a message, so it is a list, and there is nothing to wait for.
    """

    __slots__ = (
        "_begun",
        "_kinds",
        "_left",
        "_looked",
        "_owed",
        "_pos",
        "_widths",
        "done",
        "limit",
    )

    def __init__(self, limit: int = 1 << 30, yarp4: bool = False, nested: bool = False) -> None:
        self._widths = WIDTHS_4 if yarp4 else WIDTHS_3
        self.limit = limit
        self.done = False
        self._begun = False
        self._looked = nested  # whether it is a cloud
        self._pos = 0
        # One entry per list that is open: the tag of its elements (0: each has its own), and how
        # many are to come. `_owed` is the least that all of these can take.
        self._kinds: list[int] = []
        self._left: list[int] = []
        self._owed = 0

    def advance(self, view: Buffer) -> int:
        """Read what is new in `view`, which holds the message from its first byte."""
        size = len(view)
        if self.done:
            return self._pos
        if not self._looked:
            if size < 8:
                return 8
            if size < _HEAD or _read_i32(view, 13)[0] == POINTS:
                cloud = self._cloud(view, size)
                if cloud:
                    return cloud
            self._looked = size >= _HEAD
        if not self._begun:
            code, count = _read_pair(view, 0)
            if code == LIST and count == 4:
                if size < 12:
                    return 12
                if _read_i32(view, 8)[0] == 0:
                    return self._sound(view, size)
            self._begun = True
            self._pos = 8
            self._open(code & UNIT_MASK, count)
        end = self._walk(view, size)
        if end < size and self.done and not self._looked and may_be_cloud(view):
            self.done = False
            return size + 1
        return end

    def _cloud(self, view: Buffer, size: int) -> int:
        """The bytes of a PointCloud, or of its header while that is not all there; 0 for a message
        that is none, or that has to be read as a Bottle because it may be one that ends here.
        """
        if size >= _HEAD:
            cloud = cloud_size(view)
            if cloud:
                self._pos, self._owed = cloud, 0
                self._check(cloud)
                self.done = cloud <= size
            return cloud
        code, count = _read_pair(view, 0)
        kind = code & UNIT_MASK
        width = self._widths.get(kind, 4 if kind in (STRING, BLOB) or kind in ONLY_4 else 0)
        if kind and not width and count:  # no Bottle has such elements
            return _HEAD if size < 12 or may_be_cloud(view) else 0
        if kind == 0 and size >= 12 and not self._is_tag(_read_i32(view, 8)[0]):
            return _HEAD if may_be_cloud(view) else 0
        longer = 8 + count * (width or 5) >= _HEAD
        return _HEAD if longer or is_likely_cloud(view) else 0

    def _is_tag(self, kind: int) -> bool:
        """Return whether an element of a list can be of that kind."""
        known = kind in self._widths or kind in ONLY_4 or kind in (STRING, BLOB)
        return known or LIST <= kind < 2 * DICT

    def _walk(self, view: Buffer, size: int) -> int:
        kinds, left = self._kinds, self._left
        pos = self._pos
        while kinds:
            if not left[-1]:
                kinds.pop()
                left.pop()
                continue
            kind = kinds[-1]
            if kind == 0:
                start = pos + 4
                if start > size:
                    return self._wait(pos, 0)
                kind = _read_i32(view, pos)[0]
            else:
                start = pos
            width = self._widths.get(kind)
            if width is None and kind in ONLY_4:
                self._widths = WIDTHS_4
                width = WIDTHS_4[kind]
            if width is not None:
                if kinds[-1]:  # all of them at once
                    self._owed -= left[-1] * width
                    pos += left[-1] * width
                    left[-1] = 0
                else:
                    self._owed -= 5
                    pos = start + width
                    left[-1] -= 1
                continue
            if kind in (STRING, BLOB):
                least = 5 if start != pos else 4
                if start + 4 > size:
                    return self._wait(pos, start + 4 - pos - least)
                length = _read_i32(view, start)[0]
                if length < 0:
                    raise DecodeError(f"a length of {length} at byte {start}")
                self._owed -= least
                pos = start + 4 + length
                left[-1] -= 1
                self._check(pos)
                continue
            if not LIST <= kind < 2 * DICT:
                raise DecodeError(f"unknown element tag {kind} at byte {pos}: not a Bottle")
            if kind & DICT:
                if start + 8 > size:
                    return self._wait(pos, 7)
                kind, count = _read_pair(view, start)
                start += 4
            else:
                if start + 4 > size:
                    return self._wait(pos, 3)
                count = _read_i32(view, start)[0]
                if kind == LIST and count == 4 and start != pos:
                    if start + 8 > size:
                        return self._wait(pos, 7)
                    if _read_i32(view, start + 4)[0] == 0:
                        if pos + 40 > size:
                            return self._wait(pos, 35)
                        self._owed -= 5
                        left[-1] -= 1
                        pos += sound_size(bytes(view[pos : pos + 40]))
                        self._check(pos)
                        continue
            self._owed -= 5
            left[-1] -= 1
            pos = start + 4
            self._pos = pos
            self._open(kind & UNIT_MASK, count)
        self._pos = pos
        self._check(pos)
        self.done = pos <= size
        return pos

    def _wait(self, pos: int, more: int) -> int:
        """Stop at `pos`: at least what is owed is still to come, and `more` if that is known."""
        self._pos = pos
        self._check(pos)
        return pos + self._owed + more

    def _open(self, kind: int, count: int) -> None:
        if count < 0:
            raise DecodeError(f"a list with {count} elements at byte {self._pos - 4}")
        if len(self._kinds) > MAX_DEPTH:
            raise DecodeError(f"lists nested more than {MAX_DEPTH} deep")
        if count and kind in ONLY_4:
            self._widths = WIDTHS_4
        if count and kind and kind not in self._widths and kind != STRING and kind != BLOB:
            raise DecodeError(f"unknown list code {kind} at byte {self._pos - 8}")
        self._kinds.append(kind)
        self._left.append(count)
        self._owed += count * (self._widths.get(kind, 4) if kind else 5)
        self._check(self._pos)

    def _check(self, pos: int) -> None:
        if pos + self._owed > self.limit:
            raise DecodeError(
                f"the message has at least {pos + self._owed} bytes, more than the limit of "
                f"{self.limit}"
            )

    def _sound(self, view: Buffer, size: int) -> int:
        """A Sound announces a list of four and then has a 0 where no Bottle has one."""
        if size < 40:
            return 40
        self._pos = sound_size(view)
        self._check(self._pos)
        self.done = self._pos <= size
        return self._pos
