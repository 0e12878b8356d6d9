"""Constraints: `not e_ball and (e_line or e_go)`, true or false depending on events.

Rules: pure. Words are events, except for true, false, and, or, not; `not` binds closest, then
`and`, then `or`, as in Lua; parentheses group. (C++ YARP reads the same text, but treats
parentheses as blanks and replaces events inside longer words; write what both read alike.)
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final, TypeAlias

from yarpy.errors import LocalProtocolError
from yarpy.limit import CONSTRAINT_DEPTH

RESERVED: Final = frozenset(("true", "false", "and", "or", "not"))

_TOKEN: Final = re.compile(r"[()]|[^\s()]+")
_LONGEST: Final = 10_000  # characters

Has: TypeAlias = Callable[[str], bool]


class Constraint:
    """A parsed constraint. The empty one is always true.

    Raises LocalProtocolError for a text that is not a constraint.
    """

    def __init__(self, text: str) -> None:
        self.text = text.strip()
        self._tokens = _TOKEN.findall(self.text) if len(self.text) <= _LONGEST else []
        self._next = 0
        if len(self.text) > _LONGEST:
            raise LocalProtocolError(f"a constraint has at most {_LONGEST} characters")
        self._holds = self._either(0) if self._tokens else _always
        if self._next < len(self._tokens):
            raise self._wrong(f'"{self._tokens[self._next]}" is superfluous')

    def holds(self, has: Has) -> bool:
        """Return whether the constraint is true. `has` says whether an event of that name is
        set."""
        return self._holds(has)

    def _wrong(self, what: str) -> LocalProtocolError:
        shown = self.text if len(self.text) <= 80 else f"{self.text[:77]}..."
        return LocalProtocolError(
            f'the constraint "{shown}" cannot be read: {what}; write events with and, or, not, ( )'
        )

    # -- reading ----------------------------------------------------------------------------------

    def _take(self, word: str) -> bool:
        if self._next < len(self._tokens) and self._tokens[self._next] == word:
            self._next += 1
            return True
        return False

    def _either(self, depth: int) -> Callable[[Has], bool]:
        parts = [self._both(depth)]
        while self._take("or"):
            parts.append(self._both(depth))
        return parts[0] if len(parts) == 1 else lambda has: any(part(has) for part in parts)

    def _both(self, depth: int) -> Callable[[Has], bool]:
        parts = [self._one(depth)]
        while self._take("and"):
            parts.append(self._one(depth))
        return parts[0] if len(parts) == 1 else lambda has: all(part(has) for part in parts)

    def _one(self, depth: int) -> Callable[[Has], bool]:
        if depth > CONSTRAINT_DEPTH:
            raise self._wrong(f"more than {CONSTRAINT_DEPTH} levels")
        if self._take("not"):
            inner = self._one(depth + 1)
            return lambda has: not inner(has)
        if self._take("("):
            inner = self._either(depth + 1)
            if not self._take(")"):
                raise self._wrong('a ")" is missing')
            return inner
        word = self._tokens[self._next] if self._next < len(self._tokens) else ""
        if word in ("", "and", "or", ")"):
            before = f' after "{self._tokens[self._next - 1]}"' if self._next else ""
            raise self._wrong(f"an event is missing{before}")
        self._next += 1
        if word in ("true", "false"):
            return _always if word == "true" else _never
        return lambda has: has(word)


def _always(has: Has) -> bool:
    return True


def _never(has: Has) -> bool:
    return False
