"""TCompactProtocol: numbers in as few bytes as they need.

    message   82, version and kind, number, name, a struct     field    delta and type, value
    integer   zigzag, seven bits a byte, the least first       list     count and type, elements

Rules: as `binary`. A bool that is a field is in the byte of its type. Doubles have the least
significant byte first, as all libraries write them.
"""

from __future__ import annotations

from struct import Struct as Packing
from typing import Any, ClassVar, Final

from yarpy.data.value import Buffer
from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache import protocol
from yarpy.kits.thrift.apache.protocol import Head
from yarpy.kits.thrift.apache.reader import Reader
from yarpy.limit import THRIFT_NAME

MAGIC: Final = 0x82
VERSION: Final = 1
_TRUE: Final = 1
_FALSE: Final = 2
_DOUBLE: Final = Packing("<d")

_TYPES: Final = {
    protocol.BOOL: _TRUE, protocol.BYTE: 3, protocol.I16: 4, protocol.I32: 5, protocol.I64: 6,
    protocol.DOUBLE: 7, protocol.STRING: 8, protocol.LIST: 9, protocol.SET: 10, protocol.MAP: 11,
    protocol.STRUCT: 12, protocol.UUID: 13,
}  # fmt: skip
#: the sort of a type
SORTS: Final = {**{type_: sort for sort, type_ in _TYPES.items()}, _FALSE: protocol.BOOL}
#: the bytes of a value, where all of a sort have as many
SIZES: Final = {protocol.BOOL: 1, protocol.BYTE: 1, protocol.DOUBLE: 8, protocol.UUID: 16}
_RANGES: Final = {"h": 16, "i": 32, "q": 64}


class CompactWriter:
    """Writes to `out`. Numbers that do not fit raise OverflowError."""

    name: ClassVar[str] = "compact"

    def __init__(self) -> None:
        self.out = bytearray()
        self._last: list[int] = []  # the numbers of the last fields, of each struct within

    def head(self, head: Head) -> None:
        """The beginning of a message."""
        self.out += bytes((MAGIC, VERSION | head.kind << 5))
        self._varint(head.number & 0xFFFFFFFF)
        self.blob(head.name.encode("utf-8", "surrogateescape"))

    def begin(self) -> None:
        """A struct begins."""
        self._last.append(0)

    def stop(self) -> None:
        """A struct ends."""
        self._last.pop()
        self.out.append(0)

    def field(self, sort: int, number: int) -> None:
        """A field, before its value."""
        self._field(_TYPES[sort], number)

    def truth_field(self, value: bool, number: int) -> None:
        """A whole field of bool."""
        self._field(_TRUE if value else _FALSE, number)

    def _field(self, type_: int, number: int) -> None:
        delta = number - self._last[-1]
        self._last[-1] = number
        if 0 < delta <= 15:
            self.out.append(delta << 4 | type_)
        else:
            self.out.append(type_)
            self._zigzag(number, 16)

    def sequence(self, sort: int, count: int) -> None:
        """A list or a set, before its elements."""
        if count < 15:
            self.out.append(count << 4 | _TYPES[sort])
        else:
            self.out.append(0xF0 | _TYPES[sort])
            self._varint(count)

    def mapping(self, key: int, value: int, count: int) -> None:
        """A map, before its pairs."""
        self._varint(count)
        if count:
            self.out.append(_TYPES[key] << 4 | _TYPES[value])

    def truth(self, value: bool) -> None:
        self.out.append(_TRUE if value else _FALSE)

    def i8(self, value: int) -> None:
        self.out += value.to_bytes(1, "big", signed=True)

    def i16(self, value: int) -> None:
        self._zigzag(value, 16)

    def i32(self, value: int) -> None:
        self._zigzag(value, 32)

    def i64(self, value: int) -> None:
        self._zigzag(value, 64)

    def double(self, value: float) -> None:
        self.out += _DOUBLE.pack(value)

    def blob(self, data: Buffer) -> None:
        """A string or bytes."""
        self._varint(len(data))
        self.out += data

    def uuid(self, data: bytes) -> None:
        """Sixteen bytes."""
        self.out += data

    def numbers(self, array: Any) -> bool:
        """Write the elements of an array of numbers at once; False if that cannot be."""
        if array.dtype.kind == "f" or array.dtype.itemsize == 1:
            self.out += array.astype(array.dtype.newbyteorder("<"), copy=False).tobytes()
            return True
        return False

    def _zigzag(self, value: int, bits: int) -> None:
        if not -(1 << bits - 1) <= value < 1 << bits - 1:
            raise OverflowError(f"{value} does not fit in {bits} bits")
        self._varint(value << 1 ^ value >> bits - 1)

    def _varint(self, value: int) -> None:
        value &= (1 << 64) - 1
        out = self.out
        while value > 0x7F:
            out.append(value & 0x7F | 0x80)
            value >>= 7
        out.append(value)


class CompactReader(Reader):
    """Reads the bytes `data` from `at` on. Raises DecodeError."""

    def __init__(self, data: Buffer, at: int = 0) -> None:
        super().__init__(data, at)
        self._last: list[int] = []
        self._truth: bool | None = None  # the field of bool whose value comes next

    def head(self) -> Head:
        """The beginning of a message."""
        magic, second = self.take(2)
        if magic != MAGIC or second & 0x1F != VERSION:
            raise DecodeError("a message of TCompactProtocol begins with 82 and version 1")
        number = self._varint(32)
        size = self._varint(32)
        if size > THRIFT_NAME:
            raise DecodeError(f"the name of a method has at most {THRIFT_NAME} bytes")
        name = str(self.take(size), "utf-8", "surrogateescape")
        return Head(second >> 5, name, number - (number >> 31 << 32))

    def begin(self) -> None:
        """A struct begins."""
        self.enter()
        self._last.append(0)

    def field(self) -> tuple[int, int]:
        """The sort and the number of the next field; STOP, 0 at the end of the struct."""
        first = self.take(1)[0]
        if not first & 0x0F:
            self._last.pop()
            self.leave()
            return protocol.STOP, 0
        delta, type_ = first >> 4, first & 0x0F
        number = self._last[-1] + delta if delta else self._zigzag(16)
        self._last[-1] = number
        sort = self._sort(type_)
        if sort == protocol.BOOL:
            self._truth = type_ == _TRUE
        return sort, number

    def sequence(self) -> tuple[int, int]:
        """The sort and the number of the elements that follow."""
        first = self.take(1)[0]
        sort, count = self._sort(first & 0x0F), first >> 4
        if count == 15:
            count = self._varint(32)
        return sort, self.count(count, SIZES.get(sort, 1))

    def mapping(self) -> tuple[int, int, int]:
        """The sorts of keys and values, and the number of pairs that follow."""
        count = self._varint(32)
        if not count:
            return protocol.STOP, protocol.STOP, 0
        both = self.take(1)[0]
        key, value = self._sort(both >> 4), self._sort(both & 0x0F)
        return key, value, self.count(count, SIZES.get(key, 1) + SIZES.get(value, 1))

    def _sort(self, type_: int) -> int:
        sort = SORTS.get(type_)
        if sort is None:
            raise DecodeError(f"{type_} is no type of TCompactProtocol")
        return sort

    def truth(self) -> bool:
        found = self._truth
        if found is not None:
            self._truth = None
            return found
        return self.take(1)[0] == _TRUE

    def i8(self) -> int:
        return int.from_bytes(self.take(1), signed=True)

    def i16(self) -> int:
        return self._zigzag(16)

    def i32(self) -> int:
        return self._zigzag(32)

    def i64(self) -> int:
        return self._zigzag(64)

    def double(self) -> float:
        found: float = _DOUBLE.unpack(self.take(8))[0]
        return found

    def blob(self) -> memoryview:
        """The bytes of a string."""
        return self.take(self._varint(32))

    def array(self, letter: str, count: int) -> Any:
        """Return so many numbers as an array of that letter of the struct module."""
        import numpy as np

        dtype = np.dtype("<" + letter)
        if letter == "?":
            return np.frombuffer(self.take(count), "u1") == _TRUE
        if letter in "bBd":
            return np.frombuffer(self.take(count * dtype.itemsize), dtype).copy()
        bits = _RANGES[letter]
        return np.fromiter((self._zigzag(bits) for _ in range(count)), dtype, count)

    def _zigzag(self, bits: int) -> int:
        found = self._varint(bits)
        return found >> 1 ^ -(found & 1)

    def _varint(self, bits: int) -> int:
        data, at = self.data, self.at
        found = shift = 0
        size = len(data)
        while at < size:
            byte = data[at]
            at += 1
            found |= (byte & 0x7F) << shift
            if byte < 0x80:
                if found >> bits:
                    raise DecodeError(f"a number of more than {bits} bits")
                self.at = at
                return found
            shift += 7
            if shift > 63:
                raise DecodeError("a number of more than ten bytes")
        self.take(size - self.at + 1)  # which says that it is cut off
        raise AssertionError

    def skip_numbers(self, sort: int, count: int) -> bool:
        if sort == protocol.BOOL:
            for _ in range(count):
                self.truth()
        elif sort in SIZES:
            self.take(SIZES[sort] * count)
        elif sort in (protocol.I16, protocol.I32, protocol.I64):
            for _ in range(count):
                self._varint(64)
        else:
            return False
        return True
