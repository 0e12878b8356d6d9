"""Native values: a port writes them as they are, because YARP brings them back equal.

Rules: what is not native (NOT_NATIVE) travels in a frame. Whole numbers beyond 64 bits, None, keys
that are no texts and dicts in dicts are not.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from yarpy.data.bottle import Bottle

NOT_NATIVE: Final = object()
INT64: Final = 1 << 63
SURE: Final = frozenset((str, float, bool, bytes))  # whatever their value, they come back
_PLAIN: Final = SURE | {int}
_TEXT: Final = frozenset((str,))


def survives(value: Any) -> bool:
    """Return whether an element of a list comes back from YARP equal to what it was."""
    kind = type(value)
    if kind in SURE:
        return True
    if kind is int:
        return bool(-INT64 <= value < INT64)
    if kind is list or kind is Bottle:
        return _survive(value)
    if kind is dict:  # a dict in a list has a kind of its own; one in that has not
        return all(type(key) is str and _flat(item) for key, item in value.items())
    return False


def _survive(values: Iterable[Any]) -> bool:
    """Return whether each of the values survives."""
    for value in values:
        kind = type(value)
        if kind is int:
            if not -INT64 <= value < INT64:
                return False
        elif kind not in SURE and not survives(value):
            return False
    return True


def _flat(value: Any) -> bool:
    """The same for what has no dict in it."""
    kind = type(value)
    if kind is list or kind is Bottle:
        return all(map(_flat, value))
    return kind is not dict and survives(value)


def native_list(items: list[Any]) -> Any:
    """Return what a port writes for a list: itself, but not one of a single text, which is how
    Wrapyfi sends everything."""
    if len(items) == 1 and type(items[0]) is str:
        return NOT_NATIVE
    return items if _survive(items) else NOT_NATIVE


def native_dict(plain: Any) -> Any:
    """Return what a port writes for a dict: a list of pairs, since a dict in a dict would lose its
    kind. With nothing in it that might need a description it is a Bottle, which is asked for
    none."""
    values = plain.values()
    if not _TEXT.issuperset(map(type, plain)) or not _survive(values):
        return NOT_NATIVE
    pairs = map(list, plain.items())
    return Bottle(pairs) if _PLAIN.issuperset(map(type, values)) else [*pairs]
