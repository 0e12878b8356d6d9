"""Errors of values that do not fit their types, with the path of the field.

Rules: TypeError for a value of another kind, OverflowError for a number beyond its type; both begin
with package/Type.field.field[2]. Nothing is rounded or cut: fractions are no integers, numbers no
strings.
"""

from __future__ import annotations

from struct import Struct as Packing
from struct import error as struct_error
from typing import TYPE_CHECKING, Any

from yarpy.data.embedded import with_article
from yarpy.peers.ros.message.message import TIMES, attribute, parts_of
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def fault(struct: Struct, message: Any) -> Exception | None:
    """The error for the first field that cannot be sent; None if all can."""
    try:
        _check(struct, message, struct.name)
    except (TypeError, OverflowError) as error:
        return error
    return None


def wrong_length(path: str, items: Any, wanted: int) -> None:
    raise TypeError(f"{path}: {wanted} elements are wanted, here are {len(items)}")


def array_of(items: Any, dtype: np.dtype[Any], path: str) -> NDArray[Any]:
    """Numbers as an array of a type, without a copy if they are one, or bytes for uint8."""
    import numpy as np

    if isinstance(items, (bytes, bytearray, memoryview)):
        if dtype.itemsize != 1:
            raise TypeError(f"{path}: expected {dtype.name} numbers, got bytes")
        return np.frombuffer(items, dtype)
    try:
        given = np.asarray(items)
    except ValueError as error:
        raise TypeError(f"{path}: expected {dtype.name} numbers: {error}") from None
    if given.ndim != 1:
        raise TypeError(f"{path}: expected a list of numbers, got {_shape(given, items)}")
    if not given.size:
        return given.astype(dtype)
    kind = given.dtype.kind
    if kind not in {"f": "fiub", "b": "b"}.get(dtype.kind, "iub"):
        raise TypeError(f"{path}: expected {dtype.name} numbers, got {_kinds(given, items)}")
    if dtype.kind in "iu" and kind in "iu":
        bounds = np.iinfo(dtype)
        if int(given.min()) < bounds.min or int(given.max()) > bounds.max:
            raise OverflowError(f"{path}: a number that does not fit in {dtype.name}")
    return given.astype(dtype, copy=False)


def check_primitive(kind: Primitive, value: Any, path: str) -> None:
    """Raise if a value is not of this kind, or does not fit in it."""
    if kind.name == "string":
        if not isinstance(value, str):
            raise TypeError(f"{path}: expected a string, got {described(value)}")
        try:
            value.encode("utf-8", "surrogateescape")
        except UnicodeEncodeError as error:
            raise TypeError(f"{path}: text that cannot be sent: {error}") from None
        return
    if not kind.is_number:
        parts = parts_of(value)
        for at, name in enumerate(("secs", "nsecs")):
            if parts is None and not hasattr(value, name):
                raise TypeError(f"{path}: expected {kind} or seconds, got {described(value)}")
            part = getattr(value, name) if parts is None else parts[at]
            _fit("I" if kind.name == "time" else "i", kind, part, f"{path}.{name}")
        return
    _fit(kind.letters, kind, value, path)


def _fit(letter: str, kind: Primitive, value: Any, path: str) -> None:
    if letter == "?":
        return  # whatever is true or false
    try:
        Packing("<" + letter).pack(value)
    except OverflowError:
        raise OverflowError(f"{path}: {value!r} does not fit in {kind.name}") from None
    except struct_error:
        if isinstance(value, int) or hasattr(value, "__index__"):
            raise OverflowError(f"{path}: {value} does not fit in {kind.name}") from None
        raise TypeError(f"{path}: expected {kind.name}, got {described(value)}") from None


def _check(kind: Type, value: Any, path: str) -> None:
    if isinstance(kind, Struct):
        parts = parts_of(value) if kind.name in TIMES else None
        for at, field in enumerate(kind.fields):
            name = attribute(field)
            if parts is None and not hasattr(value, name):
                wanted = f"{kind} or seconds" if kind.name in TIMES else kind
                raise TypeError(f"{path}: expected {wanted}, got {described(value)}")
            part = getattr(value, name) if parts is None else parts[at]
            _check(field.type, part, f"{path}.{field.name}")
    elif isinstance(kind, ListOf):
        _check_list(kind, value, path)
    elif isinstance(kind, Primitive):
        check_primitive(kind, value, path)


def _check_list(kind: ListOf, value: Any, path: str) -> None:
    if isinstance(value, str) or not hasattr(value, "__len__") or not hasattr(value, "__iter__"):
        raise TypeError(f"{path}: expected a list, got {described(value)}")
    if kind.length is not None and len(value) != kind.length:
        wrong_length(path, value, kind.length)
    if isinstance(kind.element, Primitive) and kind.element.is_number:
        import numpy as np

        array_of(value, np.dtype("<" + kind.element.letters), path)
        return
    for index, item in enumerate(value):
        _check(kind.element, item, f"{path}[{index}]")


def described(value: Any) -> str:
    if value is None or isinstance(value, (int, float, str)):
        return repr(value)[:80]
    return with_article(getattr(value, "_type", type(value).__name__))


def _shape(given: NDArray[Any], items: Any) -> str:
    return f"the shape {given.shape}" if given.ndim else described(items)


def _kinds(given: NDArray[Any], items: Any) -> str:
    if given.dtype.kind in "fiub":
        return f"{given.dtype.name} numbers"
    other = next((item for item in items if not isinstance(item, (int, float))), items)
    return described(other)
