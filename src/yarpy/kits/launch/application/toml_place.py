"""The positions of the words of a TOML file: Python's parser keeps no lines and columns.

    places = Places(text, "demo.toml")
    places.of("programs.talker", "needs")      the key `needs` of the table [programs.talker]

Rules: pure. The file is gone through once, whatever is asked then, and the first time is what
counts. A key that is not found is where its table is, and a table that is not found in the file.
"""

from __future__ import annotations

import re
from functools import cached_property
from typing import Final

from yarpy.kits.launch.document.problem import Where

_HEADER: Final = re.compile(r"\s*+\[++([^\]]*+)\]")
_WORDS: Final = re.compile(r"\"([^\"]*+)\"|'([^']*+)'")
_MARKS: Final = " \t\"'"
_DEEPEST: Final = 8  # tables in tables whose places are kept


class Places:
    """The places in a text, which `file` has."""

    def __init__(self, text: str, file: str) -> None:
        self._lines, self._file = text.splitlines(), file

    def of(self, table: str, key: str) -> Where:
        """Return the place of a key of a table, or of the table if `key` is ""."""
        name = f"{table}.{key}".strip(".")
        found = self._names.get(name) or self._names.get(table)
        return Where(self._file, *found) if found else Where(self._file)

    def spelled(self, text: str) -> Where | None:
        """Return the place of a text in quotes; None if it is spelled in another way."""
        found = self._texts.get(text)
        return Where(self._file, *found) if found else None

    @cached_property
    def _names(self) -> dict[str, tuple[int, int]]:
        """Lines and columns of tables and keys, by their whole names."""
        found: dict[str, tuple[int, int]] = {}
        table: list[str] = []
        for number, line in enumerate(self._lines, 1):
            if header := _HEADER.match(line):
                table = [one.strip(_MARKS) for one in header[1].split(".", _DEEPEST)]
                _note(found, [], table, number, 1)
                continue
            told, sign, _ = line.partition("=")
            key = told.strip()
            if sign and key and key[0] not in "#{[,":
                column = len(told) - len(told.lstrip()) + 1
                _note(found, table, [one.strip(_MARKS) for one in key.split(".", _DEEPEST)],
                      number, column + (key[0] in "\"'"))  # fmt: skip
        return found

    @cached_property
    def _texts(self) -> dict[str, tuple[int, int]]:
        """Lines and columns of texts in quotes."""
        found: dict[str, tuple[int, int]] = {}
        for number, line in enumerate(self._lines, 1):
            for text in _WORDS.finditer(line):
                found.setdefault(text[1] or text[2] or "", (number, text.start() + 2))
        return found


def _note(
    found: dict[str, tuple[int, int]], table: list[str], names: list[str], line: int, column: int
) -> None:
    """Note where these names are told, each in the one before it."""
    for count in range(1, len(names) + 1):
        found.setdefault(".".join([*table, *names[:count]]), (line, column))
