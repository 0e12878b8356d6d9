"""The choice of the lines of a log that are shown: by program, level, component and words.

Rules: pure. Names are patterns as of the shell, or parts of names; what is searched for is a
regular expression. A line whose level nobody told is shown at every level.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import lru_cache

from yarpy.errors import LocalProtocolError
from yarpy.port.keep.log_line import LEVELS, LogLine


@dataclass(frozen=True, slots=True)
class Filter:
    """level: the least bad that is shown. program, component: patterns, "" for any. grep: what has
    to be in the text. Raises LocalProtocolError for an expression that is none."""

    level: str = "TRACE"
    program: str = ""
    component: str = ""
    grep: re.Pattern[str] | None = None

    def takes(self, line: LogLine) -> bool:
        """Return whether a line is shown."""
        if line.level and LEVELS.index(line.level) < LEVELS.index(self.level):
            return False
        if self.program and not matches(self.program, program_of(line.origin)):
            return False
        if self.component and not matches(self.component, line.component):
            return False
        return self.grep is None or self.grep.search(line.text) is not None


def expression(text: str) -> re.Pattern[str] | None:
    """Return a regular expression, None for "". Without capitals it finds those as well. Raises
    LocalProtocolError."""
    if not text:
        return None
    try:
        return re.compile(text, 0 if any(c.isupper() for c in text) else re.IGNORECASE)
    except re.error as error:
        raise LocalProtocolError(f'"{text}" is no regular expression: {error}') from error


@lru_cache(maxsize=4096)
def matches(pattern: str, name: str) -> bool:
    """Return whether a name has that part, or is as the pattern says."""
    if not any(mark in pattern for mark in "*?["):
        return pattern in name
    return fnmatchcase(name, pattern)


@lru_cache(maxsize=4096)
def program_of(origin: str) -> str:
    """Return the program in the name of a port that logs: /log/HOST/PROGRAM[LABEL]/PID.

    >>> program_of("/log/vm/arm.py[left]/77")
    'arm.py[left]'
    """
    parts = origin.split("/")
    return parts[-2] if len(parts) > 3 else origin
