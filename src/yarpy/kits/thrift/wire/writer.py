"""Values to bytes, one after the other: for what `fast` leaves, and for naming what does not fit.

Rules: TypeError for a value of another kind, OverflowError for a number beyond its type, both begin
with the path: `Arm.joints[2].speed: expected a number, got 'fast'`. A fraction is no integer, a
number no string. Sets are written as Bottles have them, which C++ reads right (it writes them
wrong). `bottle`: lists of lists, too, which C++ would refuse.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from collections.abc import Set as AbstractSet
from struct import Struct as Packing
from struct import error as struct_error
from typing import TYPE_CHECKING, Any, Final

from yarpy.data import codec
from yarpy.data.embedded import with_article
from yarpy.data.value import BIG, LIST, VOCAB32, Buffer, Vocab
from yarpy.kits.thrift.kind import (
    BINARY,
    BOOL,
    SIZE,
    TEXT,
    VOCAB,
    External,
    Kind,
    ListOf,
    MapOf,
    Scalar,
    SetOf,
    is_enum,
    list_code,
)
from yarpy.limit import THRIFT_LISTS

if TYPE_CHECKING:
    import numpy as np

Add = Callable[[Buffer], Any]

OK: Final = 0x6B6F
FAIL: Final = 0x6C696166

#: of numpy, up to 1.26 and since
_TRUTHS: Final = ("bool_", "bool")

#: what is no Bottle as 3.9 has it
_SOUND: Final = "yarp::sig::Sound"

_PAIR: Final = Packing("<ii").pack
_I32: Final = Packing("<i").pack
#: numbers of short lists are packed without numpy
_SHORT: Final = 32


def put(kind: Kind, value: Any, add: Add, path: str, bottle: bool = False) -> None:
    """Write a value where it stands: its tag and payload; the fields of a struct, without header.
    TypeError, OverflowError."""
    _put(kind, value, add, path, bottle, 0)


def _put(kind: Kind, value: Any, add: Add, path: str, bottle: bool, depth: int) -> None:
    if isinstance(kind, Scalar):
        add(_I32(kind.code))
        add(payload(kind, value, path))
    elif isinstance(kind, (ListOf, SetOf)):
        _put_list(kind, value, add, path, bottle, depth + 1)
    elif isinstance(kind, MapOf):
        _put_map(kind, value, add, path, bottle, depth + 1)
    elif isinstance(kind, External):
        add(external(kind, value, path, bottle))
    elif is_enum(kind):
        add(_I32(kind._base.code))
        add(enum_payload(kind, value, path))
    else:
        if not isinstance(value, kind):
            raise TypeError(f"{path}: expected {with_article(kind.__name__)}, got {shown(value)}")
        for field in kind._specs():
            inner = f"{path}.{field.name}"
            item = getattr(value, field.attribute)
            if item is None and field.optional:
                item = field.first()
            if field.nested:
                _nested(field.kind, item, add, inner, bottle, depth + 1)
            else:
                _put(field.kind, item, add, inner, bottle, depth)


def _nested(kind: Kind, value: Any, add: Add, path: str, bottle: bool, depth: int) -> None:
    """A struct as a list of its own; anything else as it is."""
    if depth > THRIFT_LISTS:
        raise TypeError(f"{path}: more than {THRIFT_LISTS} lists within each other cannot be sent")
    if isinstance(kind, type) and not is_enum(kind):
        add(_PAIR(LIST, kind._flat()))
    _put(kind, value, add, path, bottle, depth)


def _put_list(
    kind: ListOf | SetOf, value: Any, add: Add, path: str, bottle: bool, depth: int
) -> None:
    element = kind.element
    code = list_code(element)
    if isinstance(element, Scalar) and (element.is_number or element is BOOL):
        if isinstance(kind, SetOf):
            value = sorted(sized(value, path))
        data = numbers(element, value, path)
        add(_PAIR(LIST + code, len(data) // Packing("<" + _letter(element)).size))
        add(data)
        return
    items = sized(value, path)
    if isinstance(kind, SetOf):
        items = sorted_items(items)
    bare = isinstance(element, Scalar) or is_enum(element)
    if bottle and not bare:
        code = 0
    add(_PAIR(LIST + code, len(items)))
    for at, item in enumerate(items):
        inner = f"{path}[{at}]"
        if isinstance(element, Scalar):
            add(payload(element, item, inner))
        elif is_enum(element):
            add(enum_payload(element, item, inner))
        else:
            _nested(element, item, add, inner, bottle, depth)


def _put_map(kind: MapOf, value: Any, add: Add, path: str, bottle: bool, depth: int) -> None:
    if not isinstance(value, Mapping):
        raise TypeError(f"{path}: expected a dict, got {shown(value)}")
    add(_PAIR(LIST, len(value)))
    for key in sorted_items(value):
        add(_PAIR(LIST, 2))
        _put(kind.key, key, add, f"{path}, key {key!r:.40}", bottle, depth + 1)
        _nested(kind.value, value[key], add, f"{path}[{key!r:.40}]", bottle, depth + 1)


def sized(value: Any, path: str) -> Any:
    """The elements, which can be counted. TypeError."""
    if isinstance(value, (str, bytes, Mapping)) or not hasattr(value, "__iter__"):
        raise TypeError(f"{path}: expected a list, got {shown(value)}")
    return value if hasattr(value, "__len__") else list(value)


def sorted_items(items: Any) -> Any:
    """The elements in the order of C++, if there is one."""
    try:
        return sorted(items)
    except TypeError:
        return list(items)


# ---------------------------------------------------------------------------------- single values


def payload(kind: Scalar, value: Any, path: str) -> bytes:
    """The bytes of a value without its tag."""
    if kind is TEXT:
        if not isinstance(value, str):
            raise TypeError(f"{path}: expected a string, got {shown(value)}")
        try:
            text = value.encode("utf-8", "surrogateescape")
        except UnicodeEncodeError as error:
            raise TypeError(f"{path}: text that cannot be sent: {error}") from None
        return _I32(len(text)) + text
    if kind is BINARY:
        data = blob(value, path)
        return _I32(len(data)) + data
    if kind is BOOL:
        return _I32(OK if truth(value, path) else FAIL)
    if kind is VOCAB:
        return _I32(word(value, path))
    if kind is SIZE and not isinstance(value, bool) and isinstance(value, int) and value < 0:
        raise OverflowError(f"{path}: {value} is negative: a size_t is not")
    return _number(kind, value, path)


def _number(kind: Scalar, value: Any, path: str) -> bytes:
    wants = "an integer" if kind.letter not in "fd" else "a number"
    if isinstance(value, bool) or type(value).__name__ in _TRUTHS:
        raise TypeError(f"{path}: expected {wants}, got {shown(value)}")
    try:
        return Packing("<" + kind.letter).pack(value)
    except OverflowError:
        raise OverflowError(f"{path}: {value!r:.40} does not fit in {kind}") from None
    except struct_error:
        if hasattr(value, "__index__"):
            raise OverflowError(f"{path}: {value!r:.40} does not fit in {kind}") from None
        raise TypeError(f"{path}: expected {wants}, got {shown(value)}") from None


def truth(value: Any, path: str) -> bool:
    if isinstance(value, bool) or type(value).__name__ in _TRUTHS:
        return bool(value)
    if isinstance(value, int) and value in (0, 1):
        return bool(value)
    raise TypeError(f"{path}: expected True or False, got {shown(value)}")


def word(value: Any, path: str) -> int:
    """The code of a vocab."""
    if isinstance(value, Vocab):
        return value.code
    if not isinstance(value, str):
        raise TypeError(f"{path}: expected a word, got {shown(value)}")
    if len(value.encode("utf-8", "surrogatepass")) > 4:
        raise OverflowError(f"{path}: {value!r:.40} is longer than the four bytes of a vocab")
    return Vocab(value).code


def blob(value: Any, path: str) -> bytes:
    if isinstance(value, (bytes, bytearray)):
        return bytes(value)
    if isinstance(value, memoryview):
        return value.tobytes()
    if hasattr(value, "__array_interface__") and value.dtype.itemsize == 1:
        return bytes(value.tobytes())
    raise TypeError(f"{path}: expected bytes, got {shown(value)}")


def enum_payload(kind: Any, value: Any, path: str) -> bytes:
    base: Scalar = kind._base
    if isinstance(value, str):
        names = ", ".join(kind.__members__)
        raise TypeError(f"{path}: expected {kind.__name__}.NAME ({names}), got {shown(value)}")
    if base is VOCAB:
        base = Scalar(kind.__name__, VOCAB32, "i")
    return _number(base, value, path)


def external(kind: External, value: Any, path: str, bottle: bool = False) -> bytes:
    """Encode a type with an encoding of its own: one element that is a list, unless it says
    otherwise. `bottle`: a Sound, too, as YARP 4.0 has it."""
    if bottle and kind.name == _SOUND and hasattr(value, "frequency"):
        return b"".join(codec.encode(value.to_bottle("4.0")))
    try:
        data = b"".join(codec.encode(value))
    except (TypeError, ValueError, OverflowError) as error:
        raise TypeError(f"{path}: expected {kind.name}, got {shown(value)} ({error})") from None
    python = kind.python.rpartition(".")[2]
    fits = isinstance(value, (list, tuple, dict)) or hasattr(value, "__array_interface__")
    if python and not fits and python not in [each.__name__ for each in type(value).__mro__]:
        raise TypeError(f"{path}: expected {with_article(python)}, got {shown(value)}")
    if kind.size == 1:
        return data
    if data[:8] != _PAIR(LIST, kind.size):
        raise TypeError(f"{path}: {kind.name} takes {kind.size} elements, got {shown(value)}")
    return data[8:]


# ---------------------------------------------------------------------------------- many numbers


def _letter(kind: Scalar) -> str:
    return "i" if kind is BOOL else kind.letter


def numbers(kind: Scalar, items: Any, path: str) -> bytes | memoryview:
    """The bytes of a list of numbers or truth values, without header; of a large array a view."""
    if isinstance(items, (list, tuple)) and len(items) <= _SHORT:
        if kind is not BOOL:
            try:
                if bool not in map(type, items):
                    return Packing(f"<{len(items)}{kind.letter}").pack(*items)
            except (struct_error, OverflowError):
                pass
        return b"".join(payload(kind, item, f"{path}[{at}]") for at, item in enumerate(items))
    import numpy as np

    dtype = np.dtype("?" if kind is BOOL else "<" + kind.letter)
    array = _array(items, dtype, path)
    if kind is BOOL:
        array = np.where(array, OK, FAIL).astype("<i4")
    if array.nbytes < BIG or not array.flags.c_contiguous:
        return array.tobytes()
    return array.data.cast("B")


def _array(items: Any, dtype: np.dtype[Any], path: str) -> np.ndarray[Any, Any]:
    import numpy as np

    if isinstance(items, (bytes, bytearray, memoryview)) and dtype.itemsize == 1:
        return np.frombuffer(items, dtype)
    if isinstance(items, (str, bytes, Mapping)) or not hasattr(items, "__iter__"):
        raise TypeError(f"{path}: expected a list of numbers, got {shown(items)}")
    if isinstance(items, AbstractSet) or not hasattr(items, "__len__"):
        items = list(items)
    try:
        given = np.asarray(items)
    except (ValueError, OverflowError) as error:
        raise TypeError(f"{path}: expected {dtype.name} numbers: {error}") from None
    if given.ndim != 1:
        what = f"the shape {given.shape}" if given.ndim else shown(items)
        raise TypeError(f"{path}: expected a list of numbers, got {what}")
    if not given.size:
        return given.astype(dtype)
    if given.dtype.kind not in {"f": "fiu", "b": "b"}.get(dtype.kind, "iu"):
        at, other = next(
            (
                (at, item)
                for at, item in enumerate(items)
                if isinstance(item, bool)
                or not isinstance(item, (int, float) if dtype.kind == "f" else int)
            ),
            (0, items[0]),
        )
        raise TypeError(f"{path}[{at}]: expected {dtype.name}, got {shown(other)}")
    if dtype.kind in "iu":
        bounds = np.iinfo(dtype)
        for limit in (given.min(), given.max()):
            if not bounds.min <= int(limit) <= bounds.max:
                at = int(np.flatnonzero(given == limit)[0])
                raise OverflowError(f"{path}[{at}]: {limit} does not fit in {dtype.name}")
    return given.astype(dtype, copy=False)


def shown(value: Any) -> str:
    """A value for an error."""
    if value is None or isinstance(value, (int, float, str, bytes)):
        return f"{value!r:.60}"
    return with_article(type(value).__name__)
