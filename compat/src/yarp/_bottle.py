"""Bottle: a list of values.

Rules: it wraps a yarpy.Bottle, and so do the lists inside it, which are references.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import yarpy
from yarp._portable import Portable, message_of
from yarp._searchable import Searchable
from yarp._value import MISSING, Value, copied, int32, number, parsed, text, vocab, vocab64, whole

if TYPE_CHECKING:
    from yarp._property import Property


NativeBottle = yarpy.Bottle
_blank = object.__new__  # as `Value._of`, without a call in between


class Bottle(Portable, Searchable):
    """A list of numbers, strings, vocabs and further lists. `Bottle("set pos 3")` reads text."""

    npos = (1 << 64) - 1

    _native: yarpy.Bottle
    _null: bool = False

    def __init__(self, text: str | Bottle = "") -> None:
        if text == "":
            self._native = NativeBottle()
        elif isinstance(text, Bottle):
            self._native = copied(text._native)
        elif isinstance(text, str):
            self._native = parsed(text)
        else:
            raise TypeError(f"a Bottle is made of text or of another Bottle, not of {text!r}")

    @classmethod
    def _of(cls, native: Any, is_null: bool = False) -> Self:
        self = cls.__new__(cls)
        self._native = native if isinstance(native, yarpy.Bottle) else yarpy.Bottle(native)
        self._null = is_null
        return self

    def _outgoing(self) -> Any:
        return self._native

    def _take(self, message: yarpy.Message) -> None:
        self._native[:] = message.as_(NativeBottle)

    @classmethod
    def _from(cls, message: yarpy.Message) -> Self:
        self = _blank(cls)
        self._native = message.as_(NativeBottle)
        return self

    # -- what is in it ------------------------------------------------------------------------

    def size(self) -> int:
        """The number of elements."""
        return len(self._native)

    def get(self, index: int) -> Value:
        """The element at an index; a null Value if there is none."""
        native = self._native
        value = _blank(Value)
        try:
            value._native = native[index] if 0 <= index < len(native) else MISSING
        except TypeError:
            raise TypeError(f"an index is an integer, not {index!r}") from None
        return value

    def pop(self) -> Value:
        """The last element, which is taken off."""
        return Value._of(self._native.pop()) if self._native else Value._of(MISSING)

    def tail(self) -> Bottle:
        """All but the first element."""
        return Bottle._of(self._native[1:])

    def isNull(self) -> bool:
        return self._null

    def _find(self, key: str) -> Any:
        return self._native.find(key, MISSING)

    def _group(self, key: str) -> yarpy.Bottle | None:
        return self._native.group(key)

    # -- adding -------------------------------------------------------------------------------

    def add(self, value: Value) -> None:
        """Add a Value."""
        self._native.append(copied(value._native))

    def addInt8(self, x: int) -> None:
        self._native.append(yarpy.Int8(whole(x, 8)))

    def addInt16(self, x: int) -> None:
        self._native.append(yarpy.Int16(whole(x, 16)))

    def addInt32(self, x: int) -> None:
        plain = type(x) is int and -0x80000000 <= x <= 0x7FFFFFFF  # the quick way for most
        self._native.append(x if plain else int32(x))

    def addInt64(self, x: int) -> None:
        self._native.append(yarpy.Int64(whole(x, 64)))

    def addFloat32(self, x: float) -> None:
        self._native.append(yarpy.Float32(number(x)))

    def addFloat64(self, x: float) -> None:
        self._native.append(x if type(x) is float else number(x))

    def addString(self, str: str) -> None:
        self._native.append(text(str))

    def addVocab32(self, *x: Any) -> None:
        """Add a vocab: a code, a word, or letters one by one."""
        self._native.append(vocab(*x))

    def addVocab(self, x: int) -> None:
        self._native.append(yarpy.Vocab.from_code(int32(x)))

    def addVocab64(self, x: Any) -> None:
        """Add a word of up to eight letters, or the one of a code; it is sent as a string."""
        self._native.append(vocab64(x))

    def addList(self) -> Bottle:
        """Add an empty list, and return it to be filled."""
        inner = yarpy.Bottle()
        self._native.append(inner)
        return Bottle._of(inner)

    def addDict(self) -> Property:
        """Add an empty dictionary, and return it to be filled."""
        from yarp._property import Property

        inner = yarpy.Property()
        self._native.append(inner)
        return Property._of(inner)

    addInt = addInt32
    addDouble = addFloat64

    # -- all of it ----------------------------------------------------------------------------

    def clear(self) -> None:
        """Take everything out."""
        self._native.clear()

    def append(self, alt: Bottle) -> None:
        """Add the elements of another Bottle."""
        self._native.extend(copied(alt._native))

    def copy(self, alt: Bottle, first: int = 0, len: int = npos) -> None:
        """Become `len` elements of another Bottle, from `first` on."""
        self._native[:] = copied(alt._native[first : first + len])

    def fromString(self, text: str) -> None:
        """Become what the text says."""
        self._native[:] = parsed(text)

    def fromBinary(self, buf: bytes | str, len: int | None = None) -> None:
        """Become what these bytes say; nothing, if they are not a Bottle."""
        data = buf.encode("utf-8", "surrogateescape") if isinstance(buf, str) else bytes(buf)
        try:
            self._native[:] = yarpy.Bottle.from_bytes(data[:len])
        except yarpy.DecodeError:
            self._native.clear()

    def toBinary(self) -> bytes:
        """The message as bytes. (The C++ binding gives what comes before the first zero.)"""
        return self._native.to_bytes()

    def toString(self) -> str:
        """YARP's notation."""
        return self._native.to_text()

    toString_c = toString

    def __repr__(self) -> str:
        return f"<yarp.Bottle {self.toString()}>"

    def isEqual(self, alt: Bottle) -> bool:
        return self.toString() == alt.toString()

    def notEqual(self, alt: Bottle) -> bool:
        return not self.isEqual(alt)

    def hasChanged(self) -> None:
        """Nothing to do here."""

    def getSpecialization(self) -> int:
        """0: elements say themselves what they are."""
        return 0

    def write(self, writer: Any, textMode: bool = False) -> bool:
        """Write to a connection, or into something that reads."""
        if hasattr(writer, "_put"):
            return super().write(writer)
        return Portable.copyPortable(self, writer)

    def read(self, reader: Any, textMode: bool = False) -> bool:
        """Read from a connection, or what something writes."""
        if hasattr(reader, "_fill"):
            return super().read(reader)
        try:
            self._take(message_of(reader))
        except yarpy.DecodeError:
            return False
        return True

    @staticmethod
    def getNullBottle() -> Bottle:
        return Bottle._of(yarpy.Bottle(), is_null=True)

    @staticmethod
    def describeBottleCode(code: int) -> str:
        """A tag in words."""
        words = {1: "int", 4: "string", 9: "vocab", 10: "float", 12: "blob"}
        if code & 256:
            inner = words.get(code & 0xFF)
            return f"list of {inner}" if inner else "list"
        return words.get(code, "int")
