"""Values as messages of YARP, and messages of YARP as values.

Rules: what a port brings back equal is what a port writes: YARP's own types, and lists, dicts and
arrays with a description (`data.python.described`). Else (sets, dates, numbers of numpy) it is
a frame, as the Bottle `yarpy/1 header blob ...`. A reader tells them, and Wrapyfi's texts, by the
bytes.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.failure import error_of, raised
from yarpy.data.python.array import NUMBERS, is_array, is_blob
from yarpy.data.python.described import is_needed
from yarpy.data.sig.jpeg import encode as to_jpeg
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.kits.wrap.middleware import Failure, Heard, Item, Received
from yarpy.kits.wrap.value import frame
from yarpy.kits.wrap.value.array import Picture
from yarpy.kits.wrap.value.native import NOT_NATIVE, SURE, survives
from yarpy.kits.wrap.value.shape import Scalar, Shape
from yarpy.kits.wrap.value.tree import Jpeg, from_text, to_text
from yarpy.wire.message import Message

WORD: Final = "yarpy/1"
_WORD: Final = WORD.encode()


def native(item: Item) -> Any:
    """Return the value that a port writes for an item. Raises TypeError, ValueError if there is
    none."""
    shape = item.shape
    if type(shape) is Picture and shape.image.jpeg is not None:
        return framed(item)
    found = shape.native(item.plain)
    return found if found is not NOT_NATIVE else _spelled(item)


def _spelled(item: Item) -> Any:
    """The value that a port brings back equal, by a description; else a frame."""
    plain = item.plain
    return plain if _is_described(plain) and _is_exact(plain, 0) else framed(item)


def _is_described(value: Any) -> bool:
    """Return whether a port writes it with a description, so that every reader gets its type."""
    if isinstance(value, (list, tuple, dict)):
        return is_needed(value)
    return type(value) is complex or (is_array(value) and is_blob(value))


def _is_exact(value: Any, depth: int) -> bool:
    """Return whether a description says everything of a value: also its type."""
    kind = type(value)
    if kind is int:
        return bool(-_INT64 <= value < _INT64)
    if kind in _EXACT:
        return True
    if depth > _DEEP:
        return False
    if kind is list or kind is tuple:
        return all(_is_exact(item, depth + 1) for item in value)
    if kind is dict:
        inside = all(_is_exact(item, depth + 1) for item in value.values())
        return inside and all(type(key) is str for key in value)
    return is_array(value) and value.ndim > 0 and value.dtype.str in NUMBERS


_EXACT: Final = frozenset((str, float, bool, bytes, complex, type(None)))
_INT64: Final = 1 << 63
_DEEP: Final = 40  # levels; a description has room for some more


def framed(item: Item) -> Any:
    """The frame of an item as a Bottle."""
    return bottle(frame.Frame(jpeg_of(item) or item.plain, item.count, item.time, item.source))


def bottle(found: frame.Frame) -> list[Any]:
    """A frame as a Bottle."""
    header, *blocks = frame.to_parts(found)
    return [WORD, bytes(header).decode(), *blocks]


def wrapyfi(item: Item) -> Any:
    """Return the value that Wrapyfi sends: pictures as they are, everything else as a list of
    one text."""
    if isinstance(item.shape, Picture):
        return native(item)
    return [to_text(item.plain)]


FORMS: Final = {"native": native, "frame": framed, "wrapyfi": wrapyfi}


def form_of(encoding: str, shape: Shape) -> Callable[[Item], Any]:
    """Return the function that makes a port's value of items of this shape."""
    if encoding != "native" or (type(shape) is Picture and shape.image.jpeg is not None):
        return FORMS[encoding]
    spelled = shape.native

    def form(item: Item) -> Any:
        found = spelled(item.plain)
        return found if found is not NOT_NATIVE else _spelled(item)

    return form


def jpeg_of(item: Item) -> Jpeg | None:
    """The JPEG of an item whose hint asks for one."""
    shape = item.shape
    if not isinstance(shape, Picture) or shape.image.jpeg is None:
        return None
    found: Jpeg = item.form("jpeg", _jpeg)
    return found


def _jpeg(item: Item) -> Jpeg:
    assert isinstance(item.shape, Picture) and item.shape.image.jpeg is not None
    return Jpeg(to_jpeg(item.plain, item.shape.image.jpeg))


# ------------------------------------------------------------------------------------ receiving


def frame_of(message: Message) -> frame.Frame | None:
    """The frame in a message, None if it is something else. Raises DecodeError."""
    if message.spelling == "binary":
        data = message.payload
        if bytes(data[16:23]) != _WORD and bytes(data[12:19]) != _WORD:
            return None
    value = message.value
    if not isinstance(value, (list, tuple)) or len(value) < 2 or value[0] != WORD:
        return None
    if not isinstance(value[1], str):
        raise DecodeError("the header of the frame is no text")
    blocks = value[2:]
    if not all(isinstance(block, (bytes, bytearray, memoryview)) for block in blocks):
        raise DecodeError("what follows the header of the frame is no blob")
    return frame.from_parts([value[1].encode("utf-8", "surrogateescape"), *blocks])


def received(message: Message, shape: Shape, middleware: str = "") -> Received:
    """A message as the value that `shape` says. Raises DecodeError."""
    data = message.payload
    if type(data) is memoryview and data.readonly:
        # It lies in memory of its sender's: what a method returns belongs to the caller, who may
        # draw into a picture, and keep a thousand of them.
        data = message.payload = bytearray(data)
    if message.spelling == "binary" and len(data) >= _HEAD.size:
        # As nearly always neither a frame nor a text of Wrapyfi: one look at the first bytes.
        code, count, first, second = _HEAD.unpack_from(data)
        if first != len(_WORD) and second != len(_WORD) and (code != _TEXTS or count != 1):
            value = shape.read(message)
            if type(value) is not shape.exact:
                value = shape.load(value)
            return Heard(value, message.envelope, message.source, middleware)
    found = frame_of(message)
    if found is not None:
        value, source = shape.load(found.value), found.source or message.source
        return Received(value, found.count, found.time, source, middleware)
    return Heard(_native(message, shape), message.envelope, message.source, middleware)


def answered(message: Message, shape: Shape) -> Any:
    """The value alone, of an answer that is no failure. Raises DecodeError."""
    found = frame_of(message)
    return _native(message, shape) if found is None else shape.load(found.value)


def _native(message: Message, shape: Shape) -> Any:
    text = text_of(message)
    if text is not None and (text[:1] == '"' or not _is_text(shape)):
        try:
            return shape.load(from_text(text))
        except DecodeError:
            pass  # not one of Wrapyfi's
    return shape.load(shape.read(message))


def _is_text(shape: Shape) -> bool:
    return isinstance(shape, Scalar) and shape.kind is str


def text_of(message: Message) -> str | None:
    """The only element of a list, if that is a text, as Wrapyfi sends it. Texts by themselves, and
    the lists of `native`, are spelled otherwise."""
    if message.spelling != "binary" or bytes(message.payload[:8]) != _ONE_TEXT:
        return None
    found: str = message.as_(str)
    return found


_TEXTS: Final = 256 + 4  # how a list of texts begins
_ONE_TEXT: Final = _TEXTS.to_bytes(4, "little") + (1).to_bytes(4, "little")
_HEAD: Final = Struct("<4i")


# ------------------------------------------------------------------------------------ questions


def question(name: str, args: list[Any], kwargs: dict[str, Any]) -> list[Any]:
    """The question of a client: `look 1.0 fast`, as any program may ask; a frame of the arguments
    if YARP has no types for them."""
    if not kwargs and (SURE.issuperset(map(type, args)) or all(map(survives, args))):
        return [name, *args]
    return bottle(frame.Frame([args, kwargs]))


def failure(found: Failure) -> Bottle:
    """Return the answer by which a server of YARP says that something went wrong."""
    return raised(found.type, found.text)


def failure_of(value: Any) -> Failure | None:
    """The failure that an answer tells of."""
    if not isinstance(value, list) or len(value) < 2 or not isinstance(value[0], Vocab):
        return None
    error = error_of(value)
    if error is not None:
        return Failure(error.type, error.text)
    if value[0] != "fail":
        return None
    kind, colon, text = str(value[1]).partition(": ")
    return Failure(kind, text) if colon and kind.isidentifier() else Failure("", str(value[1]))
