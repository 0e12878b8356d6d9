"""Catalogue: type names to definitions, from several sources asked in their order.

Rules: a definition is looked up once and kept. What nobody has is an UnknownType that says who was
asked and how to provide it. Of threads that look up the same type at once one wins, and all get the
same definition.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from yarpy.errors import DecodeError, UnknownType
from yarpy.limit import ROS_ALL_DECLARATIONS, ROS_FULL_TEXT
from yarpy.peers.ros.message.definition import (
    Definition,
    ServiceDefinition,
    resolve,
    split_full_text,
)
from yarpy.peers.ros.message.parse import (
    MessageText,
    parse_message,
    parse_service,
    peer_type_name,
    type_name,
)
from yarpy.peers.ros.message.source import (
    Folder,
    Packages,
    Rosbags,
    Source,
    Standard,
    Texts,
    read_text,
)


@dataclass(frozen=True, slots=True)
class Found:
    """A text, and who had it."""

    text: str
    source: Source


class Catalogue:
    """Definitions by name.

    `Catalogue()` looks where programs of ROS would, then in rosbags; `Catalogue([Folder("msgs"),
    *standard_sources()])` looks into a folder of yours before.
    """

    def __init__(
        self, sources: Sequence[Source] | None = None, most: int = ROS_ALL_DECLARATIONS
    ) -> None:
        self.sources = list(standard_sources() if sources is None else sources)
        self._most = most  # fields of a type
        self._messages: dict[str, Definition] = {}
        self._services: dict[str, ServiceDefinition] = {}

    def text(self, name: str, kind: str = "msg") -> Found:
        """The text of package/Type; UnknownType if no source has it. `kind` is "msg" or "srv"."""
        return self._text(type_name(name), kind, "")

    def has(self, name: str, kind: str) -> bool:
        """Return whether a source has a text of that name."""
        return any(source.find(type_name(name), kind) is not None for source in self.sources)

    def message(self, name: str) -> Definition:
        """A message type. UnknownType, or DecodeError for a text that is wrong."""
        return self._message(type_name(name))

    def _message(self, name: str) -> Definition:
        found = self._messages.get(name)
        if found is None:
            found = resolve(self._parsed(name, ""), self._parsed, self._messages, self._most)
        return self._messages.setdefault(name, found)

    def service(self, name: str) -> ServiceDefinition:
        """A service type. UnknownType, or DecodeError for a text that is wrong."""
        name = type_name(name)
        found = self._services.get(name)
        if found is None:
            found = self._service(name, self._text(name, "srv", "").text)
        return self._services.setdefault(name, found)

    def message_of(self, name: str, full: str, most: int = ROS_ALL_DECLARATIONS) -> Definition:
        """A message type from a full text, as a connection brings it, of at most so many fields.
        Types that the text lacks come from the sources. Nothing of it is kept here."""
        name = peer_type_name(name)
        return self._around(_split(name, full), name, most)._message(name)

    def service_of(
        self, name: str, full: str, most: int = ROS_ALL_DECLARATIONS
    ) -> ServiceDefinition:
        """A service type from a full text: request, `---`, response, then the types in them."""
        name = peer_type_name(name)
        texts = _split(name, full)
        return self._around(texts, name, most)._service(name, texts[name])

    def read(self, path: str | os.PathLike[str]) -> Definition | ServiceDefinition:
        """The type of a `.msg` or `.srv` file. The folder it lies in, or the one above `msg` and
        `srv`, is its package; messages of that package and of those beside it are found too."""
        file = Path(path).absolute()
        folder = file.parent
        if folder.name in ("msg", "srv"):
            folder = folder.parent
        name = type_name(f"{folder.name}/{file.stem}")
        text = read_text(file)
        near = Catalogue([Folder(folder), Folder(folder.parent), *self.sources])
        if file.suffix == ".srv":
            return near._service(name, text)
        return resolve(parse_message(text, name), near._parsed, near._messages)

    def _around(self, texts: dict[str, str], name: str, most: int) -> Catalogue:
        return Catalogue([Texts(texts, f"the definition of {name}"), *self.sources], most)

    def _service(self, name: str, text: str) -> ServiceDefinition:
        request, response = (
            resolve(half, self._parsed, self._messages, self._most)
            for half in parse_service(text, name)
        )
        return ServiceDefinition(name, text, request, response)

    def _parsed(self, name: str, within: str) -> MessageText:
        return parse_message(self._text(name, "msg", within).text, name)

    def _text(self, name: str, kind: str, within: str) -> Found:
        for source in self.sources:
            text = source.find(name, kind)
            if text is not None:
                return Found(text, source)
        raise self.unknown(name, [kind], within)

    def unknown(self, name: str, kinds: Sequence[str], within: str = "") -> UnknownType:
        """The error that nobody has the type, which would be one of these kinds."""
        what = " or ".join({"msg": "message", "srv": "service"}[kind] for kind in kinds)
        needed = f", which {within} contains," if within else ""
        asked = "; ".join(map(str, self.sources)) or "nobody"
        files = " or ".join(f"{name.replace('/', f'/{kind}/', 1)}.{kind}" for kind in kinds)
        return UnknownType(
            f"no definition of the {what} {name}{needed} was found. Asked: {asked}. Put "
            f"{files} into a folder of ROS_PACKAGE_PATH"
        )


def standard_sources() -> tuple[Source, ...]:
    """The packages of this process's environment, rosbags, and what yarpy brings."""
    return Packages.of(os.environ), Rosbags(), Standard()


def _split(name: str, full: str) -> dict[str, str]:
    if len(full) > ROS_FULL_TEXT:
        raise DecodeError(f"{name}: a definition of more than {ROS_FULL_TEXT} characters")
    return split_full_text(name, full)
