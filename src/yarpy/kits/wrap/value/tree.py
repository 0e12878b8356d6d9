"""Python values as JSON with tags, and back: what frames and Wrapyfi's texts have in common.

    (1, 2)           {"__wrapyfi__": ["tuple", [1, 2]]}
    an array         {"__wrapyfi__": ["numpy.ndarray", {"b": 0}]}        in a frame: buffer 0
    an array         {"__wrapyfi__": ["numpy.ndarray", "k05VTVBZ..."]}   in a text: base64 of .npy

Rules: nothing is ever unpickled. An unknown tag is the dict that it stands in. What a text of
Wrapyfi has no tag for is a TypeError there, while frames carry it: bytes, complex numbers, keys
that are no strings, messages of YARP, pictures as JPEG.
"""

from __future__ import annotations

import binascii
import json
import sys
from base64 import b64decode, b64encode
from collections.abc import Callable, Sequence
from datetime import datetime
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from yarpy.data import codec
from yarpy.data.python.array import array_of
from yarpy.data.python.loaded import loaded
from yarpy.data.sig.image import Image
from yarpy.data.sig.jpeg import decode as decode_jpeg
from yarpy.errors import DecodeError
from yarpy.kits.wrap.value.npy import from_npy, to_npy
from yarpy.limit import TREE_DEPTH, Quota, check_hashes, check_json, limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

Buffer: TypeAlias = bytes | bytearray | memoryview

TAG: Final = "__wrapyfi__"
PLAIN: Final = frozenset((str, int, float, bool, type(None)))
_TEXT: Final = frozenset((str,))

#: tags of Wrapyfi whose payload is an array as .npy, whatever library it came from
_ARRAYS: Final = frozenset(
    ("numpy.ndarray", "TensorflowTensor", "JAXTensor", "MXNetTensor", "CuPyArray")
)
#: ... and those whose payload is a pickle, of which only the files of torch are read
_PICKLED: Final = frozenset(("TraxArray", "PandasData", "PyArrowArray", "PaddleTensor"))
_TORCH: Final = "PytorchTensor"


# ------------------------------------------------------------------------------------ to JSON


class Jpeg:
    """A picture that is a JPEG file already."""

    __slots__ = ("data",)

    def __init__(self, data: bytes) -> None:
        self.data = data


class TreeEncoder:
    """Makes trees. With `buffers` arrays and bytes go there, without they are text. What is of a
    type in `plain` is its own tree."""

    plain = PLAIN

    def __init__(self, buffers: list[NDArray[Any]] | None) -> None:
        self.buffers = buffers

    def encode(self, value: Any, depth: int = 0) -> Any:
        """Return the value for `json.dumps`. Raises TypeError, ValueError for what cannot be
        sent."""
        kind, plain = type(value), self.plain
        if kind in plain:
            return value
        if depth > TREE_DEPTH:
            raise ValueError(f"a value that is nested more than {TREE_DEPTH} levels deep")
        below = depth + 1
        if kind is list or isinstance(value, tuple):
            tree = [one if type(one) in plain else self.encode(one, below) for one in value]
            return tree if kind is list else {TAG: ["tuple", tree]}
        if isinstance(value, dict):
            return self._encode_dict(value, below)
        return self._encode_other(value, below)

    def _encode_dict(self, value: dict[Any, Any], below: int) -> Any:
        plain = TAG not in value and _TEXT.issuperset(map(type, value))
        if self.buffers is None or plain:  # JSON makes strings of keys, as Wrapyfi has it
            return {key: self.encode(item, below) for key, item in value.items()}
        pairs = [[self.encode(k, below), self.encode(v, below)] for k, v in value.items()]
        return tagged("dict", pairs)

    def _encode_other(self, value: Any, below: int) -> Any:
        if isinstance(value, (set, frozenset)):
            tag = "set" if self.buffers is None or isinstance(value, set) else "frozenset"
            return tagged(tag, [self.encode(item, below) for item in value])
        if isinstance(value, datetime):
            return tagged("datetime", value.isoformat())
        to_wire = getattr(value, "to_wire", None)
        if to_wire is not None and not isinstance(value, (list, type)) and self.buffers is not None:
            return tagged("yarp", self._buffer(b"".join(codec.encode(value))))
        numpy = loaded("numpy")
        if numpy is not None and isinstance(value, (numpy.ndarray, numpy.generic)):
            return self._encode_numpy(value, numpy)
        if isinstance(value, bool | int | float | str):
            return _plainly(value)
        if isinstance(value, list):
            return [self.encode(item, below) for item in value]
        if self.buffers is not None:
            if type(value) is Jpeg:
                return tagged("jpeg", self._buffer(value.data))
            if isinstance(value, (bytes, bytearray, memoryview)):
                return tagged("bytes", self._buffer(value))
            if isinstance(value, complex):
                return {TAG: ["complex", value.real, value.imag]}
            array = array_of(value)
            if array is not None:
                return self._encode_numpy(array, sys.modules["numpy"])
        raise TypeError(
            f"{type(value).__module__}.{type(value).__qualname__} cannot be sent: numbers, texts, "
            "bytes, lists, tuples, dicts, sets, dates, arrays and the types of yarpy can"
        )

    def _encode_numpy(self, value: Any, numpy: Any) -> Any:
        if isinstance(value, numpy.datetime64):
            return tagged("numpy.datetime64", str(value))
        if type(value) is numpy.float64:
            return float(value)
        if self.buffers is None:
            return tagged("numpy.ndarray", b64encode(to_npy(numpy.asarray(value))).decode())
        if isinstance(value, numpy.generic):
            return tagged("numpy.generic", self._array(numpy.asarray(value)))
        return tagged("numpy.ndarray", self._array(value))

    def _array(self, array: NDArray[Any]) -> dict[str, int]:
        assert self.buffers is not None
        if array.dtype.hasobject or array.dtype.names:
            raise TypeError(f"an array of {array.dtype} cannot be sent: it holds no numbers")
        self.buffers.append(array)
        return {"b": len(self.buffers) - 1}

    def _buffer(self, data: Buffer) -> dict[str, int]:
        import numpy as np

        return self._array(np.frombuffer(data, "u1"))


def tagged(tag: str, payload: Any) -> dict[str, list[Any]]:
    """A value with its tag."""
    return {TAG: [tag, payload]}


def _plainly(value: Any) -> Any:
    """A bool, int, float or str of some subclass (an enumeration, a Vocab) as the plain one."""
    for kind in (bool, int, float, str):
        if isinstance(value, kind):
            return kind.__str__(value) if kind is str else kind(value)
    return value


# ---------------------------------------------------------------------------------- from JSON


_WRONG: Final = (
    *(ValueError, TypeError, LookupError, OverflowError, RecursionError, AttributeError),
    MemoryError,
)


def from_text(text: str | bytes) -> Any:
    """The value of a JSON text with tags. Raises DecodeError."""
    try:
        alone = array_of_text(text)
        if alone is not None:
            return untag(alone)
        check_json(text)
        return json.loads(text, object_hook=untag)
    except DecodeError:
        raise
    except _WRONG as error:
        raise DecodeError(f"not JSON, or with tags that do not fit: {error}") from error


def decode_tree(tree: Any, buffers: Sequence[NDArray[Any]]) -> Any:
    """The value of a tree with these buffers. Raises DecodeError."""
    try:
        return TreeDecoder(buffers).value(tree)
    except DecodeError:
        raise
    except _WRONG as error:
        raise DecodeError(f"a tree with tags that do not fit: {error}") from error


class TreeDecoder:
    """Makes values of one message's tree. What its tags unpack shares the limits of a message, and
    a buffer is named once: a reference takes less room than what it would make a copy of."""

    def __init__(self, buffers: Sequence[NDArray[Any]] = ()) -> None:
        self._buffers = buffers
        self._named: set[int] = set()

    @cached_property
    def _pixels(self) -> Quota:
        return Quota(limits().picture, "bytes of pixels (YARPY_MAX_PICTURE)")

    @cached_property
    def _elements(self) -> Quota:
        return Quota(limits().elements, "elements (YARPY_MAX_ELEMENTS)")

    def value(self, tree: Any) -> Any:
        """The value of a tree. Raises as `untag`."""
        if type(tree) is list:
            return [self.value(item) for item in tree]
        if type(tree) is dict:
            found = {key: self.value(item) for key, item in tree.items()}
            return self.untag(found) if TAG in found else found
        return tree

    def untag(self, found: dict[str, Any]) -> Any:
        """A dict as the value that its tag stands for; itself if it has none. Raises DecodeError,
        and what Python raises for a tag that does not fit."""
        content = found.get(TAG)
        if type(content) is not list or len(found) != 1:
            return found
        if len(content) < 2 or type(content[0]) is not str:
            return found
        return self._untagged(found, content)

    def _untagged(self, whole: dict[str, Any], content: list[Any]) -> Any:
        tag, payload = content[0], content[1]
        if tag in _ARRAYS:
            return self._buffer(payload) if type(payload) is dict else from_npy(_bytes(payload))
        if tag == _TORCH:
            from yarpy.kits.wrap.value.tensor import as_floats, read

            return as_floats(read(_bytes(payload)))
        if tag in _PICKLED:
            raise DecodeError(
                f"a {tag} comes as a pickle, which runs code of its sender when it is read: "
                "send it as a numpy array"
            )
        if tag in _HASHED:
            check_hashes(key for key, _ in payload) if tag == "dict" else check_hashes(payload)
        make = _MAKERS.get(tag)
        if make is not None:
            return make(payload)
        if tag == "numpy.generic":
            return self._buffer(payload)[()]
        if tag == "bytes":
            return self._buffer(payload).tobytes()
        if tag == "yarp":
            return self._message(self._buffer(payload).data)
        if tag == "jpeg":
            return self._picture(self._buffer(payload).data)
        if tag == "complex":
            return complex(payload, content[2])
        if tag == "numpy.datetime64":
            import numpy as np

            return np.datetime64(payload)
        return whole

    def _message(self, data: memoryview) -> Any:
        found = codec.decode(data)
        self._elements.take(_counted(found))
        return found

    def _picture(self, data: memoryview) -> Image:
        wire = decode_jpeg(data, self._pixels.left)
        self._pixels.take(len(wire))
        return Image.from_wire(wire)

    def _buffer(self, place: Any) -> NDArray[Any]:
        """The buffer that a tree names."""
        index = place["b"]
        if type(index) is not int or not 0 <= index < len(self._buffers):
            raise DecodeError(f"the frame has no buffer {index!s:.80}")
        if index in self._named:
            raise DecodeError(f"the frame names its buffer {index} twice")
        self._named.add(index)
        return self._buffers[index]


#: a dict of a text as the value that its tag stands for: without buffers nothing is counted
untag: Final = TreeDecoder().untag

_MAKERS: Final[dict[str, Callable[[Any], Any]]] = {
    "tuple": tuple,
    "set": set,
    "frozenset": frozenset,
    "datetime": datetime.fromisoformat,
    "dict": dict,
}
_HASHED: Final = frozenset(("set", "frozenset", "dict"))
OWN: Final = frozenset(_MAKERS)  # tags that no library has to be asked about


def _counted(value: Any) -> int:
    """The elements of a message, with those of the lists in it."""
    return len(value) + sum(map(_counted, value)) if isinstance(value, list) else 0


def _bytes(text: Any) -> bytes:
    try:
        return b64decode(text, validate=True)
    except (binascii.Error, ValueError) as error:
        raise DecodeError(f"an array that is no base64: {error}") from error


# ------------------------------------------------------------------------------ Wrapyfi's text


def to_text(value: Any) -> str:
    """Wrapyfi's NativeObject: JSON with tags, arrays in base64. Raises TypeError, ValueError."""
    tree = TreeEncoder(None).encode(value)
    return text_of_array(tree) or json.dumps(tree)


# The text of an array alone: base64 is put between these, and taken from there, at once; a reader
# and a writer of JSON look at each of its millions of characters.
_BEFORE: Final = f'{{"{TAG}": ["numpy.ndarray", "'
_BEHIND: Final = '"]}'


def text_of_array(tree: Any) -> str | None:
    """Return the JSON of the tree of an array, as `json.dumps` makes it; None for any other."""
    content = tree.get(TAG) if type(tree) is dict and len(tree) == 1 else None
    if type(content) is not list or len(content) != 2 or content[0] != "numpy.ndarray":
        return None
    data = content[1]
    return f"{_BEFORE}{data}{_BEHIND}" if type(data) is str and _is_bare(data) else None


def array_of_text(text: str | bytes) -> dict[str, Any] | None:
    """Return the tree of an array that such a JSON text is; None for any other."""
    if isinstance(text, bytes):
        if not text.startswith(_BEFORE.encode()):
            return None
        text = text.decode("utf-8", "surrogateescape")
    if not text.startswith(_BEFORE) or not text.endswith(_BEHIND):
        return None
    data = text[len(_BEFORE) : -len(_BEHIND)]
    return {TAG: ["numpy.ndarray", data]} if _is_bare(data) else None


def _is_bare(data: str) -> bool:
    """Return whether a text is its own JSON, as far as base64 may be in it."""
    return data.isascii() and '"' not in data and "\\" not in data
