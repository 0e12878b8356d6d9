"""The short ways to JSON and back, for the small messages that come often.

Rules: what is said here is what `json.py` says of the same value, only sooner; None, or NOT_PLAIN,
is for values that it has to look at itself. Nothing is nested, every number is finite, and every
type is the very one, not a subclass of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from math import isfinite
from typing import Any, Final

from yarpy.data.bottle import Bottle

NOT_PLAIN: Final = object()

_NUMBERS: Final = frozenset((int, float))
_KINDS: Final = frozenset(("list", "dict"))  # words that say what a list becomes
_MOST: Final = 1 << 63


def plain_json(value: Any) -> str | None:
    """The JSON of a list or a dict of numbers and texts, or of one of these."""
    kind = type(value)
    if kind is list or kind is tuple or kind is Bottle:
        if _NUMBERS.issuperset(map(type, value)):
            text = list.__repr__(value if kind is not tuple else [*value])
            return None if "n" in text else text  # nan, inf
        first = value[0]
        if type(first) is str and first in _KINDS:
            return None
        words = _words(value)
        return None if words is None else f"[{', '.join(words)}]"
    if kind is dict:
        words = _words(value.values())
        if words is None or not all(type(key) is str for key in value):
            return None
        pairs = zip(map(_quote(), value), words, strict=True)
        return f"{{{', '.join([f'{key}: {word}' for key, word in pairs])}}}"
    found = _words((value,))
    return None if found is None else found[0]


def _words(values: Iterable[Any]) -> list[str] | None:
    """The JSON of each."""
    quote = _quote()
    found = []
    for value in values:
        kind = type(value)
        if kind is str:
            found.append(quote(value))
        elif kind is int or (kind is float and isfinite(value)):
            found.append(repr(value))
        elif kind is bool:
            found.append('"true"' if value else '"false"')
        else:
            return None
    return found


@cache
def _quote() -> Callable[[str], str]:
    from json.encoder import encode_basestring

    return encode_basestring


def plain_value(found: Any) -> Any:
    """The value that a message has for what `json` has read, or NOT_PLAIN."""
    several = type(found) is list
    for value in found if several else (found,):
        kind = type(value)
        if kind is float or kind is bool:
            continue
        if kind is int:
            if not -_MOST <= value < _MOST:
                return NOT_PLAIN
        elif kind is not str or not value.isascii():
            return NOT_PLAIN
    return Bottle(found) if several else found
