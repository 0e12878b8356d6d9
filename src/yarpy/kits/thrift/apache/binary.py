"""TBinaryProtocol: numbers as they are, the most significant byte first.

    message   80 01 00 KIND, name, i32 number, a struct        field    sort, i16 number, value
    struct    fields, 00        string    i32 length, bytes    list     sort, i32 count, elements

Rules: pure functions of bytes. Lengths and counts are held against what is there before anything is
made of them. Messages without a version, which libraries older than 0.2 sent, are refused.
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

VERSION: Final = 0x80010000
_I16: Final = Packing(">h")
_I32: Final = Packing(">i")
_U32: Final = Packing(">I")
_I64: Final = Packing(">q")
_DOUBLE: Final = Packing(">d")
_FIELD: Final = Packing(">bh")
_SEQUENCE: Final = Packing(">bi")
_MAPPING: Final = Packing(">bbi")

#: the bytes of a value, where all of a sort have as many
SIZES: Final = {
    protocol.BOOL: 1, protocol.BYTE: 1, protocol.DOUBLE: 8, protocol.I16: 2, protocol.I32: 4,
    protocol.I64: 8, protocol.UUID: 16,
}  # fmt: skip


class BinaryWriter:
    """Writes to `out`. Numbers that do not fit raise `struct.error`."""

    name: ClassVar[str] = "binary"

    def __init__(self) -> None:
        self.out = bytearray()

    def head(self, head: Head) -> None:
        """The beginning of a message."""
        self.out += _U32.pack(VERSION | head.kind)
        self.blob(head.name.encode("utf-8", "surrogateescape"))
        self.out += _I32.pack(head.number)

    def begin(self) -> None:
        """A struct begins."""

    def stop(self) -> None:
        """A struct ends."""
        self.out.append(0)

    def field(self, sort: int, number: int) -> None:
        """A field, before its value."""
        self.out += _FIELD.pack(sort, number)

    def truth_field(self, value: bool, number: int) -> None:
        """A whole field of bool."""
        self.field(protocol.BOOL, number)
        self.truth(value)

    def sequence(self, sort: int, count: int) -> None:
        """A list or a set, before its elements."""
        self.out += _SEQUENCE.pack(sort, count)

    def mapping(self, key: int, value: int, count: int) -> None:
        """A map, before its pairs."""
        self.out += _MAPPING.pack(key, value, count)

    def truth(self, value: bool) -> None:
        self.out.append(1 if value else 0)

    def i8(self, value: int) -> None:
        self.out += value.to_bytes(1, "big", signed=True)

    def i16(self, value: int) -> None:
        self.out += _I16.pack(value)

    def i32(self, value: int) -> None:
        self.out += _I32.pack(value)

    def i64(self, value: int) -> None:
        self.out += _I64.pack(value)

    def double(self, value: float) -> None:
        self.out += _DOUBLE.pack(value)

    def blob(self, data: Buffer) -> None:
        """A string or bytes."""
        self.out += _I32.pack(len(data))
        self.out += data

    def uuid(self, data: bytes) -> None:
        """Sixteen bytes."""
        self.out += data

    def numbers(self, array: Any) -> bool:
        """Write the elements of an array of numbers at once; False if that cannot be."""
        self.out += array.astype(array.dtype.newbyteorder(">"), copy=False).tobytes()
        return True


class BinaryReader(Reader):
    """Reads the bytes `data` from `at` on. Raises DecodeError."""

    def head(self) -> Head:
        """The beginning of a message."""
        version = self.unsigned()
        if version & 0xFFFF0000 != VERSION:
            raise DecodeError("a message of TBinaryProtocol begins with 80 01: is it strict?")
        size = self.i32()
        if not 0 <= size <= THRIFT_NAME:
            raise DecodeError(f"the name of a method has at most {THRIFT_NAME} bytes")
        name = str(self.take(size), "utf-8", "surrogateescape")
        return Head(version & 0xFF, name, self.i32())

    def begin(self) -> None:
        """A struct begins."""
        self.enter()

    def field(self) -> tuple[int, int]:
        """The sort and the number of the next field; STOP, 0 at the end of the struct."""
        sort = self.take(1)[0]
        if not sort:
            self.leave()
            return protocol.STOP, 0
        return sort, self.i16()

    def sequence(self) -> tuple[int, int]:
        """The sort and the number of the elements that follow."""
        sort, count = _SEQUENCE.unpack(self.take(5))
        return sort, self.count(count, SIZES.get(sort, 1))

    def mapping(self) -> tuple[int, int, int]:
        """The sorts of keys and values, and the number of pairs that follow."""
        key, value, count = _MAPPING.unpack(self.take(6))
        return key, value, self.count(count, SIZES.get(key, 1) + SIZES.get(value, 1))

    def unsigned(self) -> int:
        found: int = _U32.unpack(self.take(4))[0]
        return found

    def truth(self) -> bool:
        return self.take(1)[0] != 0

    def i8(self) -> int:
        return int.from_bytes(self.take(1), signed=True)

    def i16(self) -> int:
        found: int = _I16.unpack(self.take(2))[0]
        return found

    def i32(self) -> int:
        found: int = _I32.unpack(self.take(4))[0]
        return found

    def i64(self) -> int:
        found: int = _I64.unpack(self.take(8))[0]
        return found

    def double(self) -> float:
        found: float = _DOUBLE.unpack(self.take(8))[0]
        return found

    def blob(self) -> memoryview:
        """The bytes of a string."""
        return self.take(self.i32())

    def array(self, letter: str, count: int) -> Any:
        """Return so many numbers as an array of that letter of the struct module."""
        import numpy as np

        dtype = np.dtype(">" + letter)
        data = self.take(count * dtype.itemsize)
        return np.frombuffer(data, dtype).astype(dtype.newbyteorder("<"))

    def skip_numbers(self, sort: int, count: int) -> bool:
        size = SIZES.get(sort)
        if size is None:
            return False
        self.take(size * count)
        return True
