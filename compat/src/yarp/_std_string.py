"""std_string: a text that a call changes.

Rules: C++'s bindings take and return texts of Python; this is for programs that want a place where
a text goes.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from yarp._value import text


class std_string:
    """A text: `str(it)`, `it.c_str()`."""

    def __init__(self, value: Any = "") -> None:
        self._text = text(value)

    def c_str(self) -> str:
        """Return the text."""
        return self._text

    def assign(self, value: Any) -> None:
        """Replace it."""
        self._text = text(value)

    def size(self) -> int:
        return len(self._text)

    def empty(self) -> bool:
        return not self._text

    def _store(self, values: Iterable[Any]) -> None:
        """Take a result, as `store` gives it."""
        (self._text,) = map(text, values)

    __str__ = c_str
    __len__ = size

    def __eq__(self, other: object) -> bool:
        """Return whether it says the same as another one, or as a text of Python."""
        if not isinstance(other, (str, std_string)):
            return NotImplemented
        return self._text == str(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"yarp.std_string({self._text!r})"
