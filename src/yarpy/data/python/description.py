"""Description: what stands behind a message that says more in Python than YARP has kinds for.

    elements ... (yarpy.type DESCRIPTION SIZE)        the last element of a list

Rules: what stands before it is what any program of YARP reads; as a Property it is one more key.
SIZE, an int32, is how many bytes of the message this element takes, so that whoever reads looks at
the end first. Numbers, words and lists alone are in it: nothing in it names code.
"""

from __future__ import annotations

from functools import lru_cache
from struct import Struct
from typing import Final

from yarpy.data.value import INT32, INT64, LIST, STRING, Buffer

KEY: Final = "yarpy.type"
#: types of ours by their word, and where each is
OWN: Final = {
    "image": ("sig.image", "Image"),
    "matrix": ("sig.matrix", "Matrix"),
    "vector": ("sig.vector", "Vector"),
    "stamp": ("stamp", "Stamp"),
    "sound": ("sig.sound", "Sound"),
    "pointcloud": ("sig.pointcloud", "PointCloud"),
}
BLOBS: Final = frozenset(("sound", "pointcloud"))  # whose message is no Bottle

_PAIR = Struct("<ii")
_LONG = Struct("<iq")
#: a mixed list of three, the first a string of this length
_BEGIN: Final = Struct("<4i").pack(LIST, 3, STRING, len(KEY)) + KEY.encode()
_LEAST: Final = len(_BEGIN) + 8 + 8  # with an empty list
#: bytes of the smallest message that has one
SMALLEST: Final = 8 + _LEAST


def described(elements: Buffer) -> bytes:
    """The last element of a message. `elements` is the description: a list with its tag."""
    size = len(_BEGIN) + len(elements) + 8
    return _BEGIN + elements + _PAIR.pack(INT32, size)


def place(view: Buffer) -> int:
    """Return the byte at which the description of a message begins; 0 if there is none."""
    size = len(view)
    if size < SMALLEST:
        return 0
    tag, length = _PAIR.unpack_from(view, size - 8)
    if tag != INT32 or not _LEAST <= length <= size - 8:
        return 0
    start: int = size - length
    return start if view[start : start + len(_BEGIN)] == _BEGIN else 0


def content(view: Buffer, start: int) -> memoryview:
    """The description itself, a list with its tag, of an element that begins at `start`."""
    return memoryview(view)[start + len(_BEGIN) : -8]


def of_array(dtype: str, shape: tuple[int, ...]) -> bytes:
    """The description `(array "<f4" 2 3)`."""
    pieces = [_PAIR.pack(LIST, 2 + len(shape)), _word("array"), _word(dtype)]
    for length in shape:
        small = length <= 0x7FFFFFFF
        pieces.append(_PAIR.pack(INT32, length) if small else _LONG.pack(INT64, length))
    return b"".join(pieces)


@lru_cache(maxsize=64)
def array_type(content: bytes) -> tuple[str, tuple[int, ...]] | None:
    """Return type and shape of what `of_array` wrote; None for any other description. A program
    reads the same one again and again."""
    start = 8 + len(_ARRAY) + 8
    if len(content) < start or content[8 : 8 + len(_ARRAY)] != _ARRAY:
        return None
    end = start + max(0, _PAIR.unpack_from(content, start - 8)[1])
    sizes = content[end:]
    if len(sizes) % _PAIR.size:
        return None
    dtype = content[start:end].decode("latin-1")
    shape = tuple(size for _, size in _PAIR.iter_unpack(sizes))
    if min(shape, default=0) < 0 or not dtype.isascii() or of_array(dtype, shape) != content:
        return None
    return dtype, shape


def _word(text: str) -> bytes:
    return _PAIR.pack(STRING, len(text)) + text.encode()


_ARRAY: Final = _word("array")
