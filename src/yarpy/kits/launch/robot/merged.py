"""Files of a robot as one tree: each `xi:include` is replaced by the root of its file.

Rules: only files are read. The address is relative to the file that includes; what cannot be read,
includes itself, or is too much is a problem at its place, and left out. Tags that are enabled and
disabled decide whether an include counts.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Final

from yarpy.errors import DecodeError
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.element import BadFile, Element, parse
from yarpy.kits.launch.document.problem import Problem, Where
from yarpy.limit import (
    APPLICATION_DEPTH,
    APPLICATION_FILE,
    ROBOT_ELEMENTS,
    ROBOT_FILES,
)
from yarpy.platform.refusal import reason

INCLUDE: Final = "xi:include"
ALL: Final = "enable_all"  # the tag that enables whatever has to be enabled
_ATTRIBUTES: Final = ("href", "enabled_by", "disabled_by")


class Merge:
    """Reads a file and those in it; `problems` and `files` tell of them."""

    def __init__(self, enabled: Collection[str] = (), disabled: Collection[str] = ()) -> None:
        self.problems: list[Problem] = []
        self.files: list[str] = []
        self._enabled = {*enabled}
        self._disabled = {*disabled}
        self._count = 0

    def tree(self, path: Path) -> Element:
        """Return the root of a file, with all includes in it. Raises BadFile."""
        root = self._read(path)
        self._include(root, path, [path.resolve()], 0)
        return root

    def _read(self, path: Path) -> Element:
        if len(self.files) >= ROBOT_FILES:
            raise BadFile(Where(str(path)), f"more than {ROBOT_FILES} files of one robot")
        self.files.append(str(path))
        try:
            with open(path, "rb") as file:
                data = file.read(APPLICATION_FILE + 1)
        except OSError as error:
            raise BadFile(Where(str(path)), f"it cannot be read: {reason(error)}") from None
        return parse(data, str(path))

    def _include(self, element: Element, path: Path, stack: Sequence[Path], depth: int) -> None:
        """Replace the includes in an element. Raises BadFile if there is too much of it."""
        self._count += 1
        if self._count > ROBOT_ELEMENTS:
            text = f"with its includes, the robot has more than {ROBOT_ELEMENTS} tags"
            raise BadFile(element.where, text)
        if depth >= APPLICATION_DEPTH:
            raise BadFile(element.where, f"tags are more than {APPLICATION_DEPTH} deep")
        children: list[Element] = []
        for child in element.children:
            if child.tag != INCLUDE:
                self._include(child, path, stack, depth + 1)
                children.append(child)
            elif (found := self._included(child, path, stack, depth + 1)) is not None:
                children.append(found)
        element.children = children

    def _included(
        self, element: Element, path: Path, stack: Sequence[Path], depth: int
    ) -> Element | None:
        for name in element.attributes:
            if name not in _ATTRIBUTES and not name.startswith("xmlns"):
                more = advice(name, _ATTRIBUTES)
                self._say(element, f'the attribute "{name}" of <{INCLUDE}> is ignored{more}')
        href = element.attributes.get("href", "")
        if not href:
            self._say(element, f'<{INCLUDE}> has no attribute "href"', True)
            return None
        if not self._counts(element):
            return None
        if "/" not in href:
            self._say(element, f'C++ YARP does not find "{href}": write "./{href}"')
        file = path.parent / href
        if file.resolve() in stack:
            chain = " -> ".join(one.name for one in [*stack, file])
            self._say(element, f"the files include each other in a circle: {chain}", True)
            return None
        try:
            root = self._read(file)
        except BadFile as error:
            if len(self.files) >= ROBOT_FILES:
                raise
            self._say(element, f'"{href}" is left out: {error}', True)
            return None
        self._include(root, file, [*stack, file.resolve()], depth)
        return root

    def _counts(self, element: Element) -> bool:
        on = True
        if "enabled_by" in element.attributes:
            tags = self._tags(element, "enabled_by")
            on = ALL in self._enabled or bool(self._enabled & tags)
        if "disabled_by" in element.attributes:
            on = on and not self._disabled & self._tags(element, "disabled_by")
        return on

    def _tags(self, element: Element, name: str) -> set[str]:
        tags = element.attributes[name].replace("(", " ").replace(")", " ").split()
        for tag in tags:
            if tag[0].isdigit():
                self._say(
                    element, f'{name}: C++ YARP does not know tags with a digit first, "{tag}"'
                )
        return {*tags}

    def _say(self, element: Element, text: str, fatal: bool = False) -> None:
        self.problems.append(Problem(element.where, text, fatal))


def tags(text: str) -> list[str]:
    """Return the tags of an option, `(a b)` as C++ wants them, or `a b`. Raises DecodeError for
    brackets that do not match."""
    words = text.strip()
    if words.startswith("(") and words.endswith(")"):
        words = words[1:-1]
    if "(" in words or ")" in words:
        raise DecodeError(f'"{text}" is no list of tags: write "(a b)"')
    return words.split()
