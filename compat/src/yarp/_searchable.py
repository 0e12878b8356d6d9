"""Searchable: Bottle, Property, lists in a Value, ResourceFinder, all searched by key.

Rules: a key that is not there gives a null Value or a null Bottle, as in C++; nothing is raised.
"""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._value import MISSING, Value


class Searchable:
    """The common part. Subclasses say what they hold in `_find` and `_group`."""

    def _find(self, key: str) -> Any:
        """The native value of a key, or MISSING."""
        raise NotImplementedError

    def _group(self, key: str) -> yarpy.Bottle | None:
        """The whole list of a key."""
        raise NotImplementedError

    def find(self, key: str) -> Value:
        """The value of a key."""
        return Value._of(self._find(key))

    def findGroup(self, key: str, comment: str = "") -> Any:
        """The list `key value ...` as a Bottle."""
        from yarp._bottle import Bottle

        group = self._group(key)
        return Bottle._of(yarpy.Bottle() if group is None else group, is_null=group is None)

    def check(self, key: str, fallback: Value | str = "", comment: str = "") -> Any:
        """Return whether there is such a key; with a Value as second, its value or that."""
        if isinstance(fallback, Value):
            found = self._find(key)
            return fallback if found is MISSING else Value._of(found)
        return self._find(key) is not MISSING or self._group(key) is not None

    def isNull(self) -> bool:
        """Return whether this stands for something that was not found."""
        return False

    def toString(self) -> str:
        """The text of it all."""
        raise NotImplementedError

    def toString_c(self) -> str:
        """The same as `toString`."""
        return self.toString()
