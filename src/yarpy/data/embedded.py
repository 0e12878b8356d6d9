"""Values in a Bottle that are none of its kinds: numpy's, and whatever has `to_wire`.

Rules: a numpy scalar is the Python number that it holds. An array, and an object with `to_wire()`,
is the list that its message is. numpy is not imported for it: who has an array has numpy.
"""

from __future__ import annotations

from enum import Enum
from typing import Any

from yarpy.data.python.loaded import loaded


def plain(value: Any) -> Any:
    """The Python number that a numpy scalar holds; any other value as it is."""
    numpy = loaded("numpy")
    if numpy is not None and isinstance(value, (numpy.generic, numpy.ndarray)) and not value.ndim:
        from yarpy.data.python import array

        return array.scalar(value)
    return value


def message_of(value: Any) -> bytes:
    """The message that a value is as an element, which is a list then; TypeError if it is none."""
    numpy = loaded("numpy")
    if numpy is not None and isinstance(value, numpy.ndarray):
        from yarpy.data.python import array

        return b"".join(array.blocks(value))
    if hasattr(value, "to_wire") and not isinstance(value, type):
        return b"".join(value.to_wire())
    from yarpy.data.python.array import array_of, blocks

    found = array_of(value)
    if found is not None and found.ndim:
        return b"".join(blocks(found))
    can = instead(value) or (
        "int, float, str, bool, bytes, Vocab, lists, dicts, numpy arrays and yarpy.data objects can"
    )
    raise TypeError(f"{with_article(type(value).__name__)} cannot be an element of a Bottle; {can}")


def instead(value: Any) -> str:
    """Return what can be sent of an object that cannot, as the end of an error; "" if that is not
    known. Only types are asked, since what an object's own methods do is not known."""
    if isinstance(value, type):
        return f"{value.__name__} is the class itself, and an object of it is made by calling it"
    if isinstance(value, Enum):
        return "its .value can"
    kind = type(value)
    for method, can in _INSTEAD.items():
        if hasattr(kind, method):
            return can
    return ""


#: a method that tells what an object is like, and what of it can be sent
_INSTEAD = {
    "isoformat": "its text can: .isoformat()",  # dates and times
    "__fspath__": "its text can: str(path)",
    "with_traceback": "its text can: str(error)",
    "as_integer_ratio": "a float can: float(number)",  # Decimal, Fraction
    "__code__": "what it returns can, when it is called",
    "keys": "a dict can: dict(it)",
    "__iter__": "a list can: list(it)",  # sets, ranges, generators, deques
}


def with_article(name: str) -> str:
    """`an Image`, `a list`: a type's name for error texts."""
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"
