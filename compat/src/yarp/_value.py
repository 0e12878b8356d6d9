"""Value: one element of a Bottle, or what a key stands for.

Rules: conversions that make no sense give 0, "" or None, as in C++; integers are cut to the width
that is asked for. Lists and dictionaries are references: what is added to them is added to the
Bottle that they came from.
"""

from __future__ import annotations

from typing import Any, Final

import yarpy
from yarp._portable import Portable
from yarp._vocab64 import Word64, code64, word64
from yarpy.data.text import plain_text

TAG_LIST: Final = 256
TAG_DICT: Final = 512


class _Missing:
    """The value of what was not found."""


MISSING: Final = _Missing()


def int32(value: Any) -> int:
    """An argument as int32. Raises TypeError, OverflowError as the bindings do."""
    return whole(value, 32)


def whole(value: Any, bits: int) -> int:
    """An integer argument of so many bits."""
    if isinstance(value, float) or not hasattr(value, "__index__"):
        raise TypeError(f"an integer is needed, not {value!r}")
    number = int(value.__index__())
    if not -(1 << bits - 1) <= number < 1 << bits - 1:
        raise OverflowError(f"{number} does not fit in {bits} bits")
    return number


def number(value: Any) -> float:
    """An argument as a float. Raises TypeError."""
    if isinstance(value, str | bytes) or not hasattr(value, "__float__"):
        if not hasattr(value, "__index__"):
            raise TypeError(f"a number is needed, not {value!r}")
        return float(value.__index__())
    return float(value)


def text(value: Any) -> str:
    """An argument as text. Raises TypeError."""
    if not isinstance(value, str):
        raise TypeError(f"a string is needed, not {value!r}")
    return value


def vocab(*words: Any) -> yarpy.Vocab:
    """A vocab of a code, a word, or letters one by one."""
    if len(words) > 1 or isinstance(words[0], str):
        return yarpy.Vocab("".join(map(text, words)))
    return yarpy.Vocab.from_code(int32(words[0]))


def vocab64(x: Any) -> Word64:
    """A word of up to eight letters, of a code or the word."""
    return Word64(x[:8]) if isinstance(x, str) else Word64(word64(whole(x, 64)))


def parsed(words: str) -> yarpy.Bottle:
    """Return the values of a text in YARP's notation; none, if its lists are too deep."""
    try:
        return yarpy.Bottle.from_text(text(words))
    except yarpy.DecodeError:
        return yarpy.Bottle()


class Value(Portable):
    """One value. `Value(3)`, `Value(2.5)`, `Value("text")`, `Value("set", True)` for a vocab."""

    _native: Any

    def __init__(self, x: Any = None, isVocab32: bool = False) -> None:
        if x is None:
            self._native = None
        elif isinstance(x, Value):
            self._native = x._native
        elif isinstance(x, str):
            self._native = yarpy.Vocab(x) if isVocab32 else x
        elif isinstance(x, float):
            self._native = x
        else:
            self._native = vocab(x) if isVocab32 else int32(x)

    @classmethod
    def _of(cls, native: Any) -> Value:
        self = cls.__new__(cls)
        self._native = native
        return self

    # -- what kind it is ----------------------------------------------------------------------

    def isNull(self) -> bool:
        """Return whether it stands for something that was not found."""
        return self._native is MISSING

    def isBool(self) -> bool:
        return isinstance(self._native, bool)

    def isInt8(self) -> bool:
        return type(self._native) is yarpy.Int8

    def isInt16(self) -> bool:
        return type(self._native) is yarpy.Int16

    def isInt32(self) -> bool:
        return type(self._native) is int and -(1 << 31) <= self._native < 1 << 31

    def isInt64(self) -> bool:
        return type(self._native) is yarpy.Int64 or (
            type(self._native) is int and not self.isInt32()
        )

    def isFloat32(self) -> bool:
        return type(self._native) is yarpy.Float32

    def isFloat64(self) -> bool:
        return type(self._native) is float

    def isString(self) -> bool:
        return type(self._native) is str

    def isVocab32(self) -> bool:
        return isinstance(self._native, yarpy.Vocab | bool)

    def isVocab64(self) -> bool:
        """Return whether it was made by `addVocab64`; what has come over a port is a string."""
        return type(self._native) is Word64

    def isBlob(self) -> bool:
        return isinstance(self._native, bytes | bytearray | memoryview)

    def isList(self) -> bool:
        return isinstance(self._native, list | tuple)

    def isDict(self) -> bool:
        return isinstance(self._native, dict)

    def isLeaf(self) -> bool:
        return True

    isInt = isInt32
    isDouble = isFloat64
    isVocab = isVocab32

    def _outgoing(self) -> Any:
        return yarpy.Bottle() if self._native is None else yarpy.Bottle([self._native])

    def _take(self, message: yarpy.Message) -> None:
        words = message.as_(yarpy.Bottle)
        self._native = words[0] if len(words) == 1 else words

    # -- what it is ---------------------------------------------------------------------------

    def asBool(self) -> bool:
        """True for integers and vocabs other than 0 alone."""
        value = self._native
        if isinstance(value, float):
            return False
        return value.code != 0 if isinstance(value, yarpy.Vocab) else self._whole(64) != 0

    def asInt8(self) -> int:
        return self._whole(8)

    def asInt16(self) -> int:
        return self._whole(16)

    def asInt32(self) -> int:
        value = self._native
        if type(value) is int and -0x80000000 <= value <= 0x7FFFFFFF:  # as most are
            return value
        return self._whole(32)

    def asInt64(self) -> int:
        return self._whole(64)

    def asFloat32(self) -> float:
        return float(yarpy.Float32(self.asFloat64()))

    def asFloat64(self) -> float:
        value = self._native
        if type(value) is float:
            return value
        if isinstance(value, float) or (isinstance(value, int) and not isinstance(value, bool)):
            return float(value)
        return float(self._code())

    def asString(self) -> str:
        if isinstance(self._native, str | bool):
            return plain_text(self._native)
        return ""

    def asVocab32(self) -> int:
        value = self._native
        if isinstance(value, float):
            return 0
        return yarpy.Vocab(value).code if type(value) is str else self._whole(32)

    def asVocab64(self) -> int:
        """The number of a word of up to eight letters, or an integer as it is."""
        value = self._native
        if isinstance(value, float):
            return 0
        return code64(plain_text(value)) if isinstance(value, str) else self._whole(64)

    def asBlob(self) -> bytes | None:
        return bytes(self._native) if self.isBlob() else None

    def asBlobLength(self) -> int:
        return len(self._native) if self.isBlob() else 0

    def asList(self) -> Any:
        """The list as a Bottle over the same elements, or None."""
        from yarp._bottle import Bottle

        return Bottle._of(self._native) if self.isList() else None

    def asDict(self) -> Any:
        """The dictionary as a Property over the same values, or None."""
        from yarp._property import Property

        return Property._of(self._native) if self.isDict() else None

    def asSearchable(self) -> Any:
        """A list or a dictionary, or None."""
        return self.asList() or self.asDict()

    asInt = asInt32
    asDouble = asFloat64
    asVocab = asVocab32

    # -- as a list ----------------------------------------------------------------------------

    def find(self, key: str) -> Value:
        """The value of a key in a list or dictionary."""
        inner = self.asSearchable()
        found: Value = Value._of(MISSING) if inner is None else inner.find(key)
        return found

    def findGroup(self, key: str, comment: str = "") -> Any:
        """The list of a key in a list or dictionary."""
        from yarp._bottle import Bottle

        inner = self.asSearchable()
        return Bottle._of(yarpy.Bottle(), is_null=True) if inner is None else inner.findGroup(key)

    def check(self, key: str, fallback: Value | str = "", comment: str = "") -> Any:
        """Return whether a list or dictionary has a key; see Bottle.check."""
        inner = self.asSearchable()
        if inner is not None:
            return inner.check(key, fallback, comment)
        return fallback if isinstance(fallback, Value) else False

    # -- the rest -----------------------------------------------------------------------------

    def toString(self) -> str:
        """Its text, without quotes or brackets around it."""
        return "" if self._native is None or self._native is MISSING else plain_text(self._native)

    toString_c = toString

    def __repr__(self) -> str:
        return f"<yarp.Value {self.toString()}>"

    def fromString(self, str: str) -> None:
        """Read one value of YARP's notation."""
        self._native = Value.makeValue(str)._native

    def getCode(self) -> int:
        """The tag of its kind: `BOTTLE_TAG_INT32` ...; -1 if it is nothing."""
        return code_of(self._native)

    def isEqual(self, alt: Value) -> bool:
        return self.getCode() == alt.getCode() and self.toString() == alt.toString()

    def notEqual(self, alt: Value) -> bool:
        return not self.isEqual(alt)

    def clone(self) -> Value:
        """A copy that shares nothing."""
        return Value._of(copied(self._native))

    def create(self) -> Value:
        """A blank value."""
        return Value()

    def _whole(self, bits: int) -> int:
        """The low bits of a number; vocabs have no fewer than 32."""
        value = self._native
        if isinstance(value, float):
            # What does not fit is the least there is, as processors have it.
            most = 1 << 63 if bits == 64 else 1 << 31
            found = int(value) if -most - 1 < value < most else -most
        elif isinstance(value, int) and not isinstance(value, bool):
            found = int(value)
        else:
            found = self._code() if bits >= 32 else 0
        half = 1 << bits - 1
        return (found + half & (1 << bits) - 1) - half

    def _code(self) -> int:
        """The number of a vocab, 0 for everything else."""
        value = self._native
        if isinstance(value, yarpy.Vocab):
            return value.code
        return ord("1") if value is True else 0

    @staticmethod
    def getNullValue() -> Value:
        return Value._of(MISSING)

    @staticmethod
    def makeInt8(x: int) -> Value:
        return Value._of(yarpy.Int8(whole(x, 8)))

    @staticmethod
    def makeInt16(x: int) -> Value:
        return Value._of(yarpy.Int16(whole(x, 16)))

    @staticmethod
    def makeInt32(x: int) -> Value:
        return Value._of(int32(x))

    @staticmethod
    def makeInt64(x: int) -> Value:
        return Value._of(yarpy.Int64(whole(x, 64)))

    @staticmethod
    def makeFloat32(x: float) -> Value:
        return Value._of(yarpy.Float32(number(x)))

    @staticmethod
    def makeFloat64(x: float) -> Value:
        return Value._of(number(x))

    @staticmethod
    def makeString(str: str) -> Value:
        return Value._of(text(str))

    @staticmethod
    def makeVocab32(*v: Any) -> Value:
        return Value._of(vocab(*v))

    @staticmethod
    def makeBlob(data: bytes, length: int = -1) -> Value:
        return Value._of(bytes(data) if length < 0 else bytes(data)[:length])

    @staticmethod
    def makeList(txt: str = "") -> Value:
        return Value._of(parsed(txt))

    @staticmethod
    def makeValue(txt: str) -> Value:
        """The value that `txt` spells; several make a list."""
        words = parsed(txt)
        return Value._of(words[0] if len(words) == 1 else words)

    makeInt = makeInt32
    makeDouble = makeFloat64
    makeVocab = makeVocab32


def code_of(native: Any) -> int:
    """The tag of a native value."""
    match native:
        case None:
            return 0
        case bool() | yarpy.Vocab():
            return 9
        case yarpy.Int8():
            return 32
        case yarpy.Int16():
            return 64
        case yarpy.Int64():
            return 17
        case int():
            return 1 if -(1 << 31) <= native < 1 << 31 else 17
        case yarpy.Float32():
            return 128
        case float():
            return 10
        case str():
            return 4
        case bytes() | bytearray() | memoryview():
            return 12
        case dict():
            return TAG_LIST + TAG_DICT
        case list() | tuple():
            kinds = {code_of(item) for item in native}
            kind = kinds.pop() if len(kinds) == 1 else TAG_LIST
            return TAG_LIST + (kind if kind < TAG_LIST else 0)
    return -1


def copied(native: Any) -> Any:
    """A value that shares no list or dictionary with another."""
    if isinstance(native, list | tuple):
        return yarpy.Bottle(copied(item) for item in native)
    if isinstance(native, dict):
        return yarpy.Property.from_bottle(
            copied(yarpy.Property(native).group(key)) for key in native
        )
    return native
