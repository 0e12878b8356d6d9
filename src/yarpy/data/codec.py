"""Python values to payloads and back: the one interface of links and ports to this package.

    encode(obj), encode_text(obj)                the two spellings of anything that can be sent
    decode(view), decode_text(line)              the natural value of what came
    decode_as(view, type_), decode_text_as(...)  ... or of a type of your choice
    Walker                                       the end of a message that has no length

    sent                                        as
    list, tuple, Bottle                         Bottle
    dict, Property                              Property
    int, float, str, bool, bytes, Vocab ...     Value (a list of one that is never specialised)
    None                                        the null Value, an empty message
    dataclass, complex, and what else is in     with a description: `python.described`
    lists, tuples and dicts: arrays, None ...
    Stamp, Vector, Matrix, Image, Sound ...     their own layout; as text, what is no Bottle is a
                                                blob of it with its description
    arrays of numpy, torch, DLPack, buffers     see `yarpy.data.python.array`
    anything with `to_wire() -> blocks`         what that returns

Rules: decoding raises DecodeError or Truncated, nothing else. What cannot be read is tried as a
message of YARP 4.0 (`yarpy.data.yarp4`); ours are those of 3.x. Sending something unknown is a
TypeError that says what can be sent. Large data are not copied, on the way out or in.
"""

from __future__ import annotations

import reprlib
from collections.abc import Callable
from struct import Struct
from typing import Any, Final, Protocol, TypeVar, cast

from yarpy import registry
from yarpy.data.bottle import Bottle, Numbers, Property, read_bottle
from yarpy.data.embedded import instead, with_article
from yarpy.data.python import described, description, restored, typed
from yarpy.data.python.array import array_of, scalar
from yarpy.data.python.array import blocks as array_blocks
from yarpy.data.python.loaded import loaded
from yarpy.data.python.place import located
from yarpy.data.reader import KEPT, SMALL, read_fresh, read_planned
from yarpy.data.sig.cloud_head import HEAD as CLOUD_HEAD
from yarpy.data.sig.cloud_head import POINTS, cloud_size, may_be_cloud
from yarpy.data.sig.cloud_head import SIZES as CLOUD_KINDS
from yarpy.data.sig.image import Image
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.text import print_text, text_of
from yarpy.data.value import (
    FIXED,
    FLOAT32,
    FLOAT64,
    GROUP_MASK,
    LIST,
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
from yarpy.data.walker import Walker
from yarpy.data.writer import dict_elements, list_blocks, long_blocks, value_blocks
from yarpy.data.yarp4 import older
from yarpy.errors import DecodeError

__all__ = [
    "Walker",
    "decode",
    "decode_as",
    "decode_leading",
    "decode_text",
    "decode_text_as",
    "encode",
    "encode_text",
]

T = TypeVar("T")

_read_head = Struct("<ii").unpack_from
_read_i32 = Struct("<i").unpack_from

_MAT: Final = 0x0074616D
_KEY: Final = description.KEY.encode()
_EMPTY: Final = Struct("<ii").pack(LIST, 0)
_CLOUD: Final = CLOUD_HEAD.size
_SOUND: Final = Struct("<3i").pack(LIST, 4, 0)
_READ_SMALL: Final = (LIST, LIST + STRING)
LISTS: Final = frozenset((list, tuple, Bottle))  # what `list_blocks` encodes, with a step less
_BYTES: Final = frozenset((bytes, bytearray, memoryview))
_SCALARS: Final = frozenset((str, int, float, bool, bytes))
_OWN_TEXT: Final = (list, tuple, dict, Stamp, str, int, float, bytes)


# ---------------------------------------------------------------------------------- sending


def encode(obj: Any) -> Blocks:
    """The payload in the binary spelling: blocks to be sent one after the other."""
    kind = type(obj)
    if kind in LISTS:
        return list_blocks(obj, any_list)
    if kind in _SCALARS:
        return value_blocks(obj)
    to_wire = getattr(obj, "to_wire", None)
    if to_wire is not None and kind is not type:
        blocks = to_wire()
        if type(blocks) is not tuple or not _BYTES.issuperset(map(type, blocks)):
            _check_blocks(blocks, kind)
            return tuple(blocks)
        return cast(Blocks, blocks)
    if isinstance(obj, dict):
        try:
            needed = described.is_needed(obj)
            return described.blocks(obj) if needed else list_blocks(dict_elements(obj))
        except TypeError as error:
            raise located(obj, error) from None
    if isinstance(obj, (list, tuple)):
        return list_blocks(obj, any_list)
    if obj is None:
        return (_EMPTY,)
    numpy = loaded("numpy")
    if numpy is not None and isinstance(obj, (numpy.ndarray, numpy.generic)):
        if isinstance(obj, numpy.ndarray) and obj.ndim:
            return array_blocks(obj)
        if obj.dtype.kind != "c":
            return value_blocks(scalar(obj))
        obj = obj.item()
    if isinstance(obj, complex) or described.is_record(obj):
        try:
            return described.blocks(obj)
        except TypeError as error:
            raise located(obj, error) from None
    if not isinstance(obj, (str, int, float, bytes, bytearray, memoryview)):
        array = array_of(obj)
        if array is not None:
            return encode(array)
    try:
        return value_blocks(obj)
    except TypeError:
        if hasattr(obj, "as_") and hasattr(obj, "spelling"):
            raise TypeError(
                "a received Message cannot be sent; its value can: message.value"
            ) from None
        can = instead(obj) or (
            "lists, dicts, dataclasses, int, float, complex, str, bool, bytes, Vocab, arrays, "
            "yarpy.data objects and anything with a method to_wire() can"
        )
        raise TypeError(f"{with_article(kind.__name__)} cannot be sent; {can}") from None


def _check_blocks(blocks: object, kind: type) -> None:
    """Raise TypeError for what a `to_wire` returned that is no blocks of bytes."""
    try:
        if not isinstance(blocks, (list, tuple)):
            raise TypeError
        for block in blocks:
            memoryview(block)
    except TypeError:
        raise TypeError(
            f"{kind.__name__}.to_wire() has to return blocks of bytes, such as (data,), and "
            f"returned {reprlib.repr(blocks)}"
        ) from None


def any_list(items: Any) -> Blocks:
    """The message of a list or tuple for which `list_blocks` has no short way."""
    try:
        return described.blocks(items) if described.is_needed(items) else long_blocks(items)
    except TypeError as error:
        raise located(items, error) from None


def encode_text(obj: Any) -> bytes:
    """The payload in the text spelling: one line of Bottle text, without its end.

    A Stamp has its own text. What is no Bottle (Sound, PointCloud) is a blob of its bytes with a
    description behind it, which tells people what it is and is read back; from C++ it is an empty
    line.
    """
    if isinstance(obj, (list, tuple, dict)) and described.is_needed(obj):
        return encode_as_text(b"".join(encode(obj)))
    if isinstance(obj, (list, tuple)):
        text = print_text(obj)
    elif isinstance(obj, dict):
        text = text_of(obj)
    elif isinstance(obj, Stamp):
        text = obj.to_text()
    elif isinstance(obj, (str, int, float, bytes)):
        text = print_text([obj])
    else:
        return encode_as_text(b"".join(encode(obj)))
    return text.encode("utf-8", "surrogateescape")


def encode_as_text(message: Buffer) -> bytes:
    """The text spelling of a message that is in the binary one. A user's own layout, which nobody
    could read out of it, is an empty line."""
    try:
        text = print_text(listed(message))
    except DecodeError:
        text = ""
    return text.encode("utf-8", "surrogateescape")


def listed(message: Buffer) -> Bottle:
    """The list that a message is; of a Sound or a PointCloud, which are none, a blob of it with its
    description. Raises DecodeError."""
    if bytes(message[:12]) == _SOUND or cloud_size(message):
        message = b"".join(described.blocks(decode(message)))
    return read_bottle(message)


def has_own_text(obj: object) -> bool:
    """Return whether the text spelling is made from the object, not from its binary spelling."""
    if not isinstance(obj, _OWN_TEXT):
        return False
    return not isinstance(obj, (list, tuple, dict)) or not described.is_needed(obj)


# ---------------------------------------------------------------------------------- receiving


class Question(Protocol):
    """A payload that is to be answered."""

    def note_yarp4(self) -> None:
        """Its floats are those of YARP 4.0."""


def decode(view: Buffer, question: Question | None = None) -> Any:
    """The natural value of a payload.

    A Bottle; a single value if it was sent as one; a Vector over the received bytes for a list of
    floats; an Image; a Sound; a PointCloud; what its description says, if it has one. DecodeError
    or Truncated if it is none of these.
    """
    try:
        if len(view) < 12:
            return read_bottle(view)
        code, count = _read_head(view)
        if code == LIST:
            if count > 1:
                planned = read_planned(Bottle, view, count)
                if planned is not None:
                    return planned[0]
            if len(view) >= description.SMALLEST:
                start = description.place(view)
                if start:
                    return restored.restore(view, start)
            if count == 1:
                tag = _read_i32(view, 8)[0]
                if tag in CLOUD_KINDS and cloud_size(view):
                    return _cloud(view)
                bottle = read_bottle(view)
                return bottle if tag & GROUP_MASK else bottle[0]
            if count == 4 and len(view) >= 16:
                tag, word = _read_head(view, 8)
                if tag == VOCAB32 and word == _MAT:
                    image = Image.found(view)
                    if image is not None:
                        return image
                elif tag == 0:
                    from yarpy.data.sig.sound import Sound

                    return Sound.from_wire(view)
        elif len(view) >= _CLOUD and _read_i32(view, 13)[0] == POINTS and cloud_size(view):
            return _cloud(view)
        elif count and (code == LIST + FLOAT64 or code == LIST + FLOAT32):
            return Vector.from_wire(view)
        if code in _READ_SMALL and len(view) <= SMALL:  # as nearly always, with a step less
            small = view if type(view) is bytes else bytes(view)
            return read_fresh(Bottle, Property.from_bottle, small, Numbers.over)[0]
        return read_bottle(view)
    except DecodeError:
        if cloud_size(view):  # 256 wide
            return _cloud(view)
        other = older(view)
        if other is None:
            raise
    if question is not None:
        question.note_yarp4()
    return _decode_older(other)


def _cloud(view: Buffer) -> Any:
    from yarpy.data.sig.pointcloud import PointCloud

    return PointCloud.from_wire(view)


def _decode_older(view: Buffer) -> Any:
    """The value of a message that came from YARP 4.0."""
    code, count = _read_head(view)
    if count and (code == LIST + FLOAT64 or code == LIST + FLOAT32):
        return Vector.from_wire(view)
    bottle = read_bottle(view)
    single = code == LIST and count == 1 and not _read_i32(view, 8)[0] & GROUP_MASK
    return bottle[0] if single else bottle


def decode_leading(buffer: bytes) -> tuple[Any, int] | None:
    """The natural value of the message that `buffer` begins with, and the bytes it takes.

    None if it is incomplete, or is not of the usual kinds: lists, those of one kind, single values.
    """
    if not 12 <= len(buffer) <= SMALL:
        return None
    code, count = _read_head(buffer)
    if (code != LIST or count == 1) and len(buffer) >= _CLOUD and cloud_size(buffer):
        return None
    if 12 < len(buffer) < _CLOUD and buffer[12] < 2 and may_be_cloud(buffer):
        return None
    if code - LIST in KEPT and count > 0:  # numbers alone, whose length their count says
        end = 8 + count * FIXED[code - LIST][1]
        return (decode(buffer[:end]), end) if 12 <= end <= len(buffer) else None
    if code == LIST and count > 0:
        planned = read_planned(Bottle, buffer, count)
        if planned is not None:
            return planned if count > 1 else (planned[0][0], planned[1])
        if count == 4:  # which may be an Image or a Sound
            return None
    if len(buffer) >= description.SMALLEST and buffer.find(_KEY) >= 0:
        return None  # perhaps a description; `in` would try to make a number of the key first
    try:
        found = read_fresh(Bottle, Property.from_bottle, buffer)
    except DecodeError:
        return None
    if code != LIST or count != 1 or _read_i32(buffer, 8)[0] & GROUP_MASK:
        return found
    return found[0][0], found[1]


def decode_text(line: bytes | str) -> Any:
    """The Bottle of a line, or what its description says; what is not Bottle text is left out."""
    bottle = Bottle.from_text(line)
    if bottle and isinstance(bottle[-1], list):
        return restored.restore_text(bottle)
    return bottle


def named(type_: Any) -> Any:
    """Return the type of that name (`yarpy.types`); what is no text, as it is. Raises
    UnknownPlugin."""
    return registry.types.load(type_) if isinstance(type_, str) else type_


def decode_as(view: Buffer, type_: type[T], question: Question | None = None) -> T:
    """The payload as an object of `type_`; else a DecodeError that says what came instead.

    `type_` is Bottle, list, tuple, Property, dict, str, int, float, bool, bytes, Vocab (and the odd
    widths), a type of this package, numpy.ndarray, `object` for the natural value, a dataclass, a
    TypedDict, a NamedTuple, `dict[str, numpy.ndarray]` and the like, or any class with
    `from_wire(view)`. Numbers convert where nothing is lost in kind (int to float), a word is
    accepted as a Vocab and a Vocab as a word, because YARP programs do not tell them apart.
    """
    try:
        return _decode_as(view, type_)
    except DecodeError:
        other = older(view)
        if other is None:
            raise
    if question is not None:
        question.note_yarp4()
    return _decode_as(other, type_)


def _decode_as(view: Buffer, type_: type[T]) -> T:
    if type_ is not Bottle:
        start = description.place(view)
        if start:
            return cast(T, typed.convert(restored.restore(view, start), type_))
    convert = _CONVERTERS.get(type_)
    if convert is not None:
        return cast(T, convert(view))
    from_wire = getattr(type_, "from_wire", None)
    if from_wire is not None:
        try:
            return cast(T, from_wire(view))
        except DecodeError as error:
            image = Image.found(view) if getattr(type_, "takes_images", False) else None
            if image is not None and image.array.ndim == 2:
                return cast(T, cast(Any, type_)(image.array))
            raise _other(type_.__name__, view, error) from None
    if type_ is object or type_ is Any:
        return cast(T, decode(view))
    if typed.is_typed(type_):
        return cast(T, typed.convert(decode(view), type_))
    if not isinstance(type_, type):
        raise TypeError(
            f"messages are read as a type, such as yarpy.Image or dict, not {reprlib.repr(type_)}"
        )
    if type_.__name__ == "ndarray" and type_.__module__ == "numpy":
        return cast(T, _to_array(view))
    for base in (Bottle, Property, Vocab, str, int, float, bytes, list, tuple, dict):
        if issubclass(type_, base):
            make = getattr(type_, "_make", type_)  # named tuples have their own constructor
            try:
                return cast(T, make(_CONVERTERS[base](view)))
            except (ValueError, TypeError, LookupError, OverflowError) as error:
                if isinstance(error, DecodeError):
                    raise
                raise DecodeError(f"expected {with_article(type_.__name__)}: {error}") from error
    raise TypeError(
        f"messages cannot be read as {type_.__name__}; give it a class method from_wire(view)"
    )


def decode_text_as(line: bytes | str, type_: type[T]) -> T:
    """The line as an object of `type_`, as `decode_as` does."""
    if type_ is Stamp:
        return cast(T, Stamp.from_text(line))
    bottle = Bottle.from_text(line)
    if type_ is Bottle:
        return cast(T, bottle)
    value = decode_text(line)
    if type_ is object or type_ is Any:
        return cast(T, value)
    if isinstance(value, Bottle):
        return decode_as(b"".join(list_blocks(value)), type_)
    return cast(T, typed.convert(value, type_))


def _single(view: Buffer, wanted: str) -> Any:
    """The only element of a message."""
    bottle = read_bottle(view)
    if len(bottle) != 1:
        raise DecodeError(f"expected {wanted}, got {_describe(bottle)}")
    return bottle[0]


def _describe(bottle: Bottle) -> str:
    text = print_text(bottle[:12])
    return f"a list of {len(bottle)}: {text[:80]}" if len(bottle) != 1 else text[:80]


def _wrong(wanted: str, value: Any) -> DecodeError:
    return DecodeError(f"expected {wanted}, got {_describe(Bottle([value]))}")


def _other(wanted: str, view: Buffer, error: DecodeError) -> DecodeError:
    """The error for a message of another type, or `error` if it is a message of none."""
    try:
        bottle = read_bottle(view)
    except DecodeError:
        return error
    return DecodeError(f"expected {with_article(wanted)}, got {_describe(bottle)} ({error})")


def _to_dict(view: Buffer) -> dict[str, Any]:
    found = dict(Property.from_bytes(view))
    if not found:
        bottle = read_bottle(view)
        if not all(isinstance(item, (list, dict)) for item in bottle):
            raise DecodeError(f"expected pairs of key and value, got {_describe(bottle)}")
    return found


def _to_str(view: Buffer) -> str:
    value = _single(view, "a string")
    if isinstance(value, str):
        return str.__str__(value)
    raise _wrong("a string", value)


def _to_int(view: Buffer) -> int:
    value = _single(view, "an integer")
    if isinstance(value, int) and not isinstance(value, bool):
        return int(value)
    raise _wrong("an integer", value)


def _to_float(view: Buffer) -> float:
    value = _single(view, "a number")
    if isinstance(value, (float, int)) and not isinstance(value, bool):
        return float(value)
    raise _wrong("a number", value)


def _narrow(view: Buffer, kind: Any) -> object:  # as an `int`, compiled, it would be a plain one
    try:
        return kind(_to_int(view))
    except OverflowError as error:
        raise DecodeError(f"expected {with_article(kind.__name__)}: {error}") from None


def _to_bool(view: Buffer) -> bool:
    value = _single(view, "true or false")
    if isinstance(value, bool):
        return value
    raise _wrong("true or false", value)


def _to_bytes(view: Buffer) -> bytes:
    value = _single(view, "a blob")
    if isinstance(value, bytes):
        return value
    raise _wrong("a blob", value)


def _to_vocab(view: Buffer) -> Vocab:
    value = _single(view, "a vocab")
    if isinstance(value, str):
        return Vocab(value)
    raise _wrong("a vocab", value)


def _to_vector(view: Buffer) -> Vector:
    if len(view) >= 8:
        code, count = _read_head(view)
        if code in _VECTOR_CODES and (count or code != LIST):
            return Vector.from_wire(view)
    bottle = read_bottle(view)
    if all(isinstance(item, (int, float)) and not isinstance(item, bool) for item in bottle):
        return Vector(bottle)
    raise DecodeError(f"expected a vector of numbers, got {_describe(bottle)}")


_VECTOR_CODES: Final = frozenset(LIST + tag for tag in (1, 10, 17, 32, 64, 128))


def _to_array(view: Buffer) -> Any:
    """A numpy array, over the received bytes: from an Image, a Matrix, a Sound or a Vector."""
    natural = decode(view)
    if isinstance(natural, Numbers):
        return natural.array
    if isinstance(natural, (Bottle, int, float)):
        if len(view) >= 8 and _read_head(view) == (LIST, 3):
            from yarpy.data.sig.matrix import Matrix

            return Matrix.from_wire(view).array
        return _to_vector(view).array
    array = getattr(natural, "array", None)
    if array is None:
        raise _wrong("an array", natural)
    return array


_CONVERTERS: Final[dict[Any, Callable[[Buffer], Any]]] = {
    Bottle: read_bottle,
    list: lambda view: list(read_bottle(view)),
    tuple: lambda view: tuple(read_bottle(view)),
    Property: Property.from_bytes,
    dict: _to_dict,
    str: _to_str,
    int: _to_int,
    float: _to_float,
    bool: _to_bool,
    bytes: _to_bytes,
    Vocab: _to_vocab,
    Int8: lambda view: _narrow(view, Int8),
    Int16: lambda view: _narrow(view, Int16),
    Int64: lambda view: _narrow(view, Int64),
    Float32: lambda view: Float32(_to_float(view)),
    Vector: _to_vector,
}
