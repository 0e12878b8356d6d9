"""Scan: where does a message end that comes without a length, as over TBufferedTransport?

Rules: fed with what has come so far, again and again; no byte is looked at twice, nothing is made
of what is passed over, and what cannot be a message is refused at its first wrong byte. What is
within a struct is kept on a stack of our own, at most THRIFT_LEVELS high.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Final, TypeAlias

from yarpy.data.value import Buffer
from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache import binary, compact, protocol
from yarpy.limit import THRIFT_LEVELS, THRIFT_NAME

_Steps: TypeAlias = Generator[int, None, None]
_VARINTS: Final = frozenset((protocol.I16, protocol.I32, protocol.I64))
_FIXED: Final = {
    protocol.BYTE: 1, protocol.DOUBLE: 8, protocol.UUID: 16, protocol.BOOL: 1,
}  # fmt: skip


class Scan:
    """Call `advance` with the bytes of the message that have come, again and again, until `done`.

    Every call returns the least number of bytes that the message can have; if that is more than
    have come, call again when so many are there. Once `done`, it is the length of the message.
    DecodeError if this is not one.
    """

    def __init__(self, spelling: str) -> None:
        self.done = False
        self._at = 0
        self._view: Buffer = b""
        # What is open: of a struct (0, 0, -1), of a container its sorts and the values to come.
        self._stack: list[list[int]] = []
        self._steps = self._compact() if spelling == "compact" else self._binary()

    def advance(self, view: Buffer) -> int:
        """See the class."""
        self._view = view
        try:
            return next(self._steps)
        except StopIteration:
            self.done = True
            return self._at
        finally:
            self._view = b""

    def _need(self, size: int) -> _Steps:
        """Wait until so many bytes are there."""
        while len(self._view) < self._at + size:
            yield self._at + size

    def _pass(self, size: int) -> _Steps:
        """Pass over so many bytes."""
        if size < 0:
            raise DecodeError(f"a length of {size} bytes")
        yield from self._need(size)
        self._at += size

    def _number(self, size: int) -> Generator[int, None, int]:
        yield from self._need(size)
        found = int.from_bytes(self._view[self._at : self._at + size], signed=True)
        self._at += size
        return found

    def _varint(self) -> Generator[int, None, int]:
        found = shift = 0
        while True:
            if len(self._view) <= self._at:
                yield self._at + 1
            byte = self._view[self._at]
            self._at += 1
            found |= (byte & 0x7F) << shift
            if byte < 0x80:
                return found
            shift += 7
            if shift > 63:
                raise DecodeError("a number of more than ten bytes")

    def _open(self, first: int, second: int, count: int) -> None:
        if count < -1:
            raise DecodeError(f"a container of {count} elements")
        if len(self._stack) >= THRIFT_LEVELS:
            raise DecodeError(f"structs and containers are nested more than {THRIFT_LEVELS} deep")
        self._stack.append([first, second, count])

    def _binary(self) -> _Steps:
        yield from self._pass(4)
        size = yield from self._number(4)
        if size > THRIFT_NAME:
            raise DecodeError(f"the name of a method has at most {THRIFT_NAME} bytes")
        yield from self._pass(size)
        yield from self._pass(4)
        self._open(0, 0, -1)
        while self._stack:
            sort = self._next()
            if sort is None:
                sort = yield from self._number(1)
                if sort == protocol.STOP:
                    self._stack.pop()
                    continue
                yield from self._pass(2)
            elif sort == protocol.STOP:
                continue
            fixed = binary.SIZES.get(sort)
            if fixed is not None:
                yield from self._pass(fixed)
            elif sort == protocol.STRING:
                yield from self._pass((yield from self._number(4)))
            elif sort == protocol.STRUCT:
                self._open(0, 0, -1)
            elif sort == protocol.MAP:
                key = yield from self._number(1)
                value = yield from self._number(1)
                count = yield from self._number(4)
                self._open(key, value, max(2 * count, -2))
            elif sort in (protocol.SET, protocol.LIST):
                inner = yield from self._number(1)
                count = yield from self._number(4)
                fixed = binary.SIZES.get(inner)
                if fixed is not None:
                    yield from self._pass(fixed * count)
                else:
                    self._open(inner, inner, max(count, -2))
            else:
                raise DecodeError(f"{sort} is no type of Thrift")

    def _next(self) -> int | None:
        """The sort of the value that comes next; None: a struct's field says it; STOP: a container
        is over."""
        top = self._stack[-1]
        if top[2] == -1:
            return None
        if top[2] == 0:
            self._stack.pop()
            return protocol.STOP
        top[2] -= 1
        sort, top[0], top[1] = top[0], top[1], top[0]
        if sort == protocol.STOP:
            raise DecodeError("a container of no type")
        return sort

    def _compact(self) -> _Steps:
        yield from self._pass(2)
        yield from self._varint()
        size = yield from self._varint()
        if size > THRIFT_NAME:
            raise DecodeError(f"the name of a method has at most {THRIFT_NAME} bytes")
        yield from self._pass(size)
        self._open(0, 0, -1)
        while self._stack:
            sort = self._next()
            if sort is None:
                first = (yield from self._number(1)) & 0xFF
                if not first & 0x0F:
                    self._stack.pop()
                    continue
                if not first >> 4:
                    yield from self._varint()
                sort = _sort(first & 0x0F)
                if sort == protocol.BOOL:
                    continue
            elif sort == protocol.STOP:
                continue
            if sort in _VARINTS:
                yield from self._varint()
            elif sort in _FIXED:
                yield from self._pass(_FIXED[sort])
            elif sort == protocol.STRING:
                yield from self._pass((yield from self._varint()))
            elif sort == protocol.STRUCT:
                self._open(0, 0, -1)
            elif sort == protocol.MAP:
                count = yield from self._varint()
                if count:
                    both = (yield from self._number(1)) & 0xFF
                    self._open(_sort(both >> 4), _sort(both & 0x0F), 2 * count)
            else:
                first = (yield from self._number(1)) & 0xFF
                count = first >> 4
                if count == 15:
                    count = yield from self._varint()
                inner = _sort(first & 0x0F)
                if inner in _FIXED:
                    yield from self._pass(_FIXED[inner] * count)
                else:
                    self._open(inner, inner, count)


def _sort(type_: int) -> int:
    found = compact.SORTS.get(type_)
    if found is None:
        raise DecodeError(f"{type_} is no type of TCompactProtocol")
    return found
