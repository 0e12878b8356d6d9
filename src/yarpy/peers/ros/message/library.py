"""Library: type names to Python classes, and the classes of types that peers describe.

Rules: a type has one class, whoever described it: types are the same if name and checksum are. The
classes of peers' types are kept up to a number and a size, the oldest go first.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from gc import collect
from hashlib import sha256
from typing import Any, Final
from weakref import finalize

from yarpy.errors import DecodeError, UnknownType
from yarpy.limit import ROS_ALL_DECLARATIONS
from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.definition import Definition, ServiceDefinition
from yarpy.peers.ros.message.factory import make
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros.message.source import Source

_MET: Final = 1000
#: of all peers' types: characters of their definitions, and four thousand for each field
_MET_SIZE: Final = 1 << 26
_ALIVE_SIZE: Final = 1 << 28  # those that connections use, too

_Key = tuple[str, str]


@dataclass(frozen=True, eq=False)
class Service:
    """A service type: the classes of its two halves, and what connections say about it."""

    definition: ServiceDefinition
    Request: type[Message]
    Response: type[Message]

    @property
    def name(self) -> str:
        return self.definition.name

    @property
    def md5sum(self) -> str:
        return self.definition.md5sum

    @property
    def full_text(self) -> str:
        return self.definition.full_text

    def request(self, *arguments: Any) -> Message:
        """Return the request that arguments stand for: an object of its type, a dict of some of its
        fields, a list of all of them, or the fields. Raises TypeError, DecodeError."""
        if len(arguments) != 1:
            return self.Request.from_bottle([*arguments])
        (only,) = arguments
        if isinstance(only, Message):
            own = self.Request
            if (only._type, only._md5sum) != (own._type, own._md5sum):
                raise TypeError(f"{self.name} is asked with {own._type}, not {only._type}")
            return only
        try:
            return self.Request.from_bottle(only)
        except DecodeError as error:
            try:
                return self.Request.from_bottle([only])
            except DecodeError:
                raise error from None

    def __repr__(self) -> str:
        return f"<service {self.name}>"


def load_type(what: str | os.PathLike[str]) -> type[Message] | Service:
    """Return the class of a message, or a Service, by its name or its file. Raises UnknownType,
    DecodeError, OSError."""
    return default_library().load(what)


class Library:
    """Classes by type name, from definitions that `sources` have (see `Catalogue`)."""

    def __init__(self, sources: Sequence[Source] | None = None) -> None:
        self.catalogue = Catalogue(sources)
        self._classes: dict[_Key, type[Message]] = {}
        self._met: dict[_Key, type[Message]] = {}
        self._alive: dict[int, int] = {}  # sizes of those of peers, by their identities
        self._services: dict[_Key, Service] = {}
        self._texts: dict[tuple[str, bytes], type[Message]] = {}

    def load(self, what: str | os.PathLike[str]) -> type[Message] | Service:
        """The class of a message `package/Type`, or the Service of that name if there is no such
        message; or of a `.msg` or `.srv` file. UnknownType, DecodeError, OSError."""
        if os.fspath(what).endswith((".msg", ".srv")):
            found = self.catalogue.read(what)
            if isinstance(found, Definition):
                return self._class(found, self._classes)
            return self._service(found, self._classes)
        name = os.fspath(what)
        try:
            return self.message(name)
        except UnknownType:
            if self.catalogue.has(name, "srv"):
                return self.service(name)
            if self.catalogue.has(name, "msg"):  # but not a type that it contains
                raise
            raise self.catalogue.unknown(name, ["msg", "srv"]) from None

    def message(self, name: str) -> type[Message]:
        """The class of a message type. UnknownType, DecodeError."""
        return self._class(self.catalogue.message(name), self._classes)

    def service(self, name: str) -> Service:
        """A service type. UnknownType, DecodeError."""
        return self._service(self.catalogue.service(name), self._classes)

    def message_of(
        self, name: str, full_text: str, most: int = ROS_ALL_DECLARATIONS
    ) -> type[Message]:
        """The class of a type as a peer describes it (`type` and `message_definition` of its
        connection), of at most so many fields. UnknownType, DecodeError."""
        key = name, sha256(full_text.encode("utf-8", "surrogatepass")).digest()
        found = self._texts.get(key)
        if found is None:
            found = self._class(self.catalogue.message_of(name, full_text, most), self._met)
            self._texts[key] = found
            _trim(self._texts)
        return found

    def service_of(self, name: str, full_text: str, most: int = ROS_ALL_DECLARATIONS) -> Service:
        """A service type as a peer describes it. UnknownType, DecodeError."""
        return self._service(self.catalogue.service_of(name, full_text, most), self._met)

    def _service(
        self, definition: ServiceDefinition, classes: dict[_Key, type[Message]]
    ) -> Service:
        halves = [self._class(half, classes) for half in (definition.request, definition.response)]
        service = Service(definition, *halves)
        if classes is self._met:
            return service
        return self._services.setdefault((service.name, service.md5sum), service)

    def _class(self, definition: Definition, classes: dict[_Key, type[Message]]) -> type[Message]:
        key = definition.name, definition.md5sum
        found = self._classes.get(key) or self._met.get(key)
        if found is None:
            used = {each.struct: self._class(each, classes) for each in definition.all_used()}
            if classes is self._met:
                self._check_room(definition.name)
            found = classes.setdefault(key, make(definition, used, restore))
            if classes is self._met:
                self._alive[id(found)] = _size(found)
                finalize(found, self._alive.pop, id(found), None).atexit = False
            while sum(map(_size, [*self._met.values()])) > _MET_SIZE and len(self._met) > 1:
                self._met.pop(next(iter(self._met), key), None)
            _trim(self._met)
            kept = {*self._met.values(), *self._classes.values()}
            for text, known in [*self._texts.items()]:
                if known not in kept:
                    self._texts.pop(text, None)
        elif classes is self._classes:
            found = classes.setdefault(key, found)
        return found

    def _check_room(self, name: str) -> None:
        """Check that connections do not hold too many types of peers. Raises DecodeError."""
        if sum([*self._alive.values()]) > _ALIVE_SIZE:
            collect()  # classes know themselves, so they stay until somebody looks for such circles
            if sum([*self._alive.values()]) > _ALIVE_SIZE:
                raise DecodeError(
                    f"{name} is a type too many: those that others describe take "
                    f"{_ALIVE_SIZE >> 20} MiB here; give the port a type of its own"
                )


def _size(cls: type[Message]) -> int:
    """Return roughly how many bytes a class takes, with those that it uses."""
    names = sum(map(len, (kind._names for kind in {cls, *cls._used.values()})))
    return len(cls._full_text) + 4000 * names


def _trim(kept: dict[Any, Any]) -> None:
    """Let the oldest go, if there are too many."""
    while len(kept) > _MET:
        kept.pop(next(iter(kept), None), None)


@cache
def default_library() -> Library:
    """The library of this process: the types that its environment has when it is first asked."""
    return Library()


def restore(name: str, full_text: str, data: bytearray) -> Message:
    """A message that was copied or pickled."""
    return default_library().message_of(name, full_text).from_ros(data)
