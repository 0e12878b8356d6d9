"""Unions and exceptions: structs that Apache's protocols, and Python, treat in a way of their own.

Rules: on YARP's wire they are structs with all of their fields.
"""

from __future__ import annotations

from typing import ClassVar

from yarpy.kits.thrift.structure import Struct


class Union(Struct):
    """The base of all unions: one field is set, the others are None."""

    _sort: ClassVar[str] = "union"


class Error(Struct, Exception):
    """The base of all exceptions.

    One that a method may throw goes to clients of Apache's protocols as it is; those of YARP's wire
    hear its text.
    """

    _sort: ClassVar[str] = "exception"

    def __str__(self) -> str:
        """Return its message, or all of its fields."""
        text = getattr(self, "message", None)
        return text if isinstance(text, str) and text else repr(self)
