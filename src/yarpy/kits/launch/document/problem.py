"""Places in files, and problems there.

Rules: pure values, which print as compilers print them: `file:line:column: warning: text`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Where:
    """A place in a file; lines and columns count from 1, 0 for one that is not known."""

    file: str = ""
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        return ":".join(
            [self.file, *(str(number) for number in (self.line, self.column) if number)]
        )


NOWHERE: Final = Where()


@dataclass(frozen=True, slots=True)
class Problem:
    """Something in a file that does not do what it seems to. `fatal`: the application cannot run
    as long as it is there."""

    where: Where
    text: str
    fatal: bool = False

    def __str__(self) -> str:
        return f"{self.where}: {'error' if self.fatal else 'warning'}: {self.text}"
