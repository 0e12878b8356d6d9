"""The configuration files of YARP ("ini" syntax) as a `Property`.

    name value value (a list) "two words"     a key and its values
    [section]                                 the following lines belong to a list of that name
    [type section]                            the same, and `section` joins the list `type`
    []                                        back to the top
    [include "file"]  [include section "file"]  [include type section "file"]
    [import context "file"]                   a file found in a context
    // comment      # comment      $VARIABLE ${VARIABLE} $(VARIABLE)

Rules (checked against C++ YARP): reading never fails on a file's content; a
missing included file is skipped with a warning. Beware, as in C++: `//` begins a comment even
inside a URL unless quoted, `a=b` without blanks is one key, and an open bracket or quote swallows
the rest of the file.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.data.text_reader import Balance
from yarpy.errors import DecodeError
from yarpy.limit import INI_DEPTH, INI_FILE

LONGEST = 1 << 20  # characters that the variables in a line may add to it

# Finds a file, by name, in a context ("" for none); None if there is none.
Find = Callable[[str, str], Path | None]

_NESTING = re.compile(r'[\\"(){}]')
# (names are bounded: in a file full of `${` each would otherwise search the whole rest)
_VARIABLE = re.compile(r"\\.|\$(?:\{([^}]{0,255}+)\}|\(([^)]{0,255}+)\)|([A-Za-z0-9_]{0,255}+))")


def read_ini(
    path: str | Path,
    environment: Mapping[str, str] | None = None,
    values: Mapping[str, object] | None = None,
    find: Find | None = None,
) -> Property:
    """Read a configuration file, or all `*.ini` of a directory in alphabetical order.

    environment, values: where `$NAME` is looked up first; then among the keys read before.
    find: how `[import]` finds files. Raises OSError when `path` itself cannot be read.
    """
    reader = _Reader(environment or {}, values or {}, find)
    reader.read(Path(path), [])
    return reader.result()


def parse_ini(
    text: str,
    environment: Mapping[str, str] | None = None,
    values: Mapping[str, object] | None = None,
    find: Find | None = None,
) -> Property:
    """The same from text; included files are relative to the working directory."""
    reader = _Reader(environment or {}, values or {}, find)
    reader.parse(text, [])
    return reader.result()


class _Reader:
    """Top level lists by name, and the section that is open."""

    def __init__(
        self, environment: Mapping[str, str], values: Mapping[str, object], find: Find | None
    ) -> None:
        self._environment = environment
        self._values = values
        self._find = find
        self._groups: dict[str, Bottle] = {}
        self._section: Bottle | None = None

    def result(self) -> Property:
        return Property.from_bottle(self._groups.values())

    def read(self, path: Path, parents: list[Path]) -> None:
        if path.is_dir():
            for file in sorted(path.glob("*.ini")):
                self.read(file, parents)
                self._section = None
            return
        with path.open("rb") as stream:
            data = stream.read(INI_FILE)
        self.parse(data.decode("utf-8", "surrogateescape"), [*parents, path])

    def parse(self, text: str, parents: list[Path]) -> None:
        for line, whole in _joined(text.removesuffix("\n").split("\n")):
            if whole:
                self._line(_without_comment(line), parents)
            else:
                self._put(line)  # never closed: taken as it is, and most of it is dropped

    def _line(self, line: str, parents: list[Path]) -> None:
        line = self._expand(line)
        if line.startswith("[") and "]" in line:
            self._open(line[1 : line.index("]")], parents)
        else:
            self._put(line)

    def _put(self, line: str) -> None:
        """Store `key value ...` in the open section, or at the top."""
        words = _words(line)
        if not words:
            return
        if len(words) > 1 and words[1] == "=":
            del words[1]
        if self._section is not None:
            self._section.append(words)
        else:
            self._groups[plain_text(words[0])] = words

    def _open(self, text: str, parents: list[Path]) -> None:
        self._section = None
        if not text:
            return
        names = [plain_text(word) for word in _words(text)]
        if names[:1] == ["include"] and len(names) > 1:
            self._include(names[1:], parents)
        elif names[:1] == ["import"] and len(names) > 2:
            path = self._find(names[2], names[1]) if self._find is not None else None
            self._merge(path or Path(names[2]), parents)
        elif len(names) == 2:
            self._section = self._enter(names[1], names[0])
        else:
            self._section = self._enter(text)

    def _enter(self, name: str, kind: str = "") -> Bottle:
        """The list of a section, which also joins the list of its kind."""
        if kind:
            self._groups.setdefault(kind, Bottle([kind])).append(name)
        return self._groups.setdefault(name, Bottle([name]))

    def _include(self, names: list[str], parents: list[Path]) -> None:
        path = _locate(names[-1], parents)
        if len(names) == 1:
            self._merge(path, parents)
            return
        section = self._enter(names[-2], names[-3] if len(names) > 2 else "")
        # The file is merged into the section's content, and the result becomes the section.
        inner = _Reader(self._environment, self._values, self._find)
        for item in section[1:]:
            if isinstance(item, Bottle) and item:
                inner._groups[plain_text(item[0])] = item
        inner._merge(path, parents)
        section[1:] = [inner._groups[key] for key in sorted(inner._groups)]

    def _merge(self, path: Path, parents: list[Path]) -> None:
        try:
            if len(parents) >= INI_DEPTH:
                raise OSError(f"included through {INI_DEPTH} other files")
            self.read(path, parents)
        except OSError as error:
            from yarpy.log import logger

            logger("yarpy.names").warning("cannot read from %s (%s)", path, error)
        self._section = None

    def _expand(self, line: str) -> str:
        if "$" not in line:
            return line
        left = LONGEST

        def value(match: re.Match[str]) -> str:
            nonlocal left
            text = self._value(match)
            left -= len(text)
            return text if left >= 0 else ""

        expanded = _VARIABLE.sub(value, line)
        if left < 0:
            from yarpy.log import logger

            logger("yarpy.names").warning(
                "the variables in a line expand to more than %d characters: the ones beyond that "
                "count as empty (%.60s)",
                LONGEST,
                line,
            )
        return expanded

    def _value(self, match: re.Match[str]) -> str:
        if match[0].startswith("\\"):
            return "$" if match[0] == "\\$" else match[0]
        name = match[1] or match[2] or match[3] or ""
        if name in self._environment:
            return self._environment[name]
        if name in self._values:
            return plain_text(self._values[name])
        if name in self._groups:
            return plain_text(self._groups[name][1]) if len(self._groups[name]) > 1 else ""
        return "1" if name == "__YARP__" else ""


def _words(text: str) -> Bottle:
    try:
        return Bottle.from_text(text)
    except DecodeError:  # hundreds of nested brackets
        return Bottle()


def _joined(lines: Iterable[str]) -> Iterator[tuple[str, bool]]:
    """Lines, joined at a backslash, an open bracket or an open quote; whether all were closed.

    Every character is read once, however many lines there are."""
    parts: list[str] = []
    balance = Balance()
    slashes = 0  # backslashes at the end of what has come
    closed = True
    for line in lines:
        line = line.removesuffix("\r")
        if not parts and _NESTING.search(line) is None:
            yield line, True
            continue
        last = len(line) - len(line.rstrip("\\"))
        slashes = slashes + last if last == len(line) else last
        folded = slashes % 2 == 1
        if folded:
            line = line[:-1]
            slashes -= 1
        parts.append(line)
        closed = balance.feed(line.encode("utf-8", "surrogateescape")) and not folded
        if closed:
            yield "".join(parts), True
            parts, balance, slashes = [], Balance(), 0
    if not closed:
        yield "".join(parts) + "\\" * folded, False


def _without_comment(line: str) -> str:
    """The line up to `//` outside quotes, or to a `#` at its start or after a blank."""
    quoted = False
    for place, char in enumerate(line):
        if char == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif line.startswith("//", place) or (
            char == "#" and (place == 0 or line[place - 1] in " \t")
        ):
            return line[:place]
    return line


def _locate(name: str, parents: Iterable[Path]) -> Path:
    """A file as named, or next to the files that include it."""
    path = Path(name)
    if path.is_absolute() or path.exists():
        return path
    for parent in reversed(list(parents)):
        beside = parent.parent / name
        if beside.exists():
            return beside
    return path
