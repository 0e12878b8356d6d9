"""Code: a Python function that is written line by line and compiled once.

Rules: nothing that came from outside is ever part of the text but names of fields, which the parser
checked. Everything else (classes, formats, paths in errors) is a global of the function, behind a
name that begins with `_`; no field has such a name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from struct import Struct
from typing import Any


class Code:
    """`line` adds a line, `name` gives a value a name to be used in lines."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.globals: dict[str, Any] = {}
        self.letters: list[str] = []
        self.terms: list[str] = []
        self._depth = 0
        self._variables = 0

    def line(self, text: str) -> None:
        self.lines.append(" " * self._depth + text)

    def indent(self, by: int) -> None:
        self._depth += by

    def name(self, value: Any, hint: str = "") -> str:
        name = f"_{hint or 'g'}{len(self.globals)}"
        self.globals[name] = value
        return name

    def variable(self) -> str:
        """A local variable that is not used yet."""
        self._variables += 1
        return f"_v{self._variables}"

    def number(self, letters: str, *terms: str) -> None:
        """Add numbers to the run that is packed or unpacked with a single call."""
        self.letters.append(letters)
        self.terms += terms

    def run(self) -> tuple[Struct, Sequence[str]] | None:
        """The run so far, and begin a new one; None if there is none."""
        if not self.letters:
            return None
        found = Struct("<" + "".join(self.letters)), self.terms
        self.letters, self.terms = [], []
        return found

    def compiled(self, name: str, arguments: str) -> Callable[..., Any]:
        """The function of all lines."""
        body = "\n ".join(self.lines or ["pass"])
        found: dict[str, Any] = {}
        exec(
            compile(f"def {name}({arguments}):\n {body}\n", f"<{name}>", "exec"),
            self.globals,
            found,
        )
        function: Callable[..., Any] = found[name]
        return function
