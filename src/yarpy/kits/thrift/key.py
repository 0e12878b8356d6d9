"""Values of Thrift as keys of a dict and elements of a set, where Python needs what does not
change.

Rules: a list is a tuple, a set a frozenset, a map a Pairs; a struct is itself, and must not be
changed while it is a key. All of these are taken wherever a list, a set, a map or a struct is.
"""

from __future__ import annotations

from typing import Any


class Pairs(dict[Any, Any]):
    """A dict that can be a key; it must not be changed while it is one."""

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(frozenset(self.items()))


def frozen(value: Any) -> Any:
    """Return a value as it can be a key."""
    if hasattr(value, "__array_interface__") and hasattr(value, "tolist"):
        return tuple(value.tolist())
    if type(value) is list:
        return tuple(map(frozen, value))
    if type(value) is set:
        return frozenset(value)
    if type(value) is dict:
        return Pairs((key, frozen(item)) for key, item in value.items())
    return value


def fingerprint(value: Any) -> int:
    """Return a hash of any value, by what is in it."""
    if hasattr(value, "__array_interface__") and hasattr(value, "tolist"):
        return hash(tuple(value.tolist()))
    if isinstance(value, (list, tuple)):
        return hash(tuple(map(fingerprint, value)))
    if isinstance(value, (set, frozenset)):
        return hash(frozenset(value))
    if isinstance(value, dict):
        return hash(frozenset((key, fingerprint(item)) for key, item in value.items()))
    return hash(value)
