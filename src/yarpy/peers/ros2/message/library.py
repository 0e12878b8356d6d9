"""Library of ROS 2: type names to Python classes, also of the version that a peer has.

Rules: a type has one class for each of its hashes. A definition is asked for once, and kept. Types
are written package/msg/Type, package/srv/Type, or package/Type where it is plain which is meant.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

from yarpy.errors import DecodeError, UnknownType
from yarpy.peers.ros.message.definition import (
    Definition,
    ServiceDefinition,
    resolve,
    split_full_text,
)
from yarpy.peers.ros.message.factory import make
from yarpy.peers.ros.message.library import Service
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros.message.parse import MessageText
from yarpy.peers.ros.message.source import Source, Texts
from yarpy.peers.ros2.message import cdr_reader, cdr_writer
from yarpy.peers.ros2.message.action import (
    MESSAGES,
    SERVICES,
    action_name,
    part_of,
    plain_name,
    texts_of,
)
from yarpy.peers.ros2.message.hash import full_name, message_hash, service_hash
from yarpy.peers.ros2.message.parse import parse_message, parse_service
from yarpy.peers.ros2.message.source import (
    DISTROS,
    Rosbags,
    Shipped,
    Standard,
    distro,
    installed,
)

_MET: Final = 1000  # types of peers that are kept


class Service2(Service):
    """A service of ROS 2."""

    @property
    def md5sum(self) -> str:
        """Its hash, which the definition of ROS 1 has another one for."""
        return service_hash(self.definition)


@dataclass(frozen=True, eq=False)
class Action:
    """An action type: the classes of what it is declared with, and the services and the message by
    which nodes speak of it."""

    name: str  # package/action/Name
    Goal: type[Message]
    Result: type[Message]
    Feedback: type[Message]
    SendGoal: Service2
    GetResult: Service2
    FeedbackMessage: type[Message]

    def __repr__(self) -> str:
        return f"<action {self.name}>"


class Library:
    """Classes by type name, from texts that `sources` have."""

    def __init__(self, sources: Sequence[Source] | None = None) -> None:
        self.sources = list(standard_sources() if sources is None else sources)
        self._definitions: dict[str, Definition] = {}
        self._services: dict[str, Service2] = {}
        self._actions: dict[str, Action] = {}
        self._classes: dict[tuple[str, str], type[Message]] = {}
        self._others: dict[str, Library] = {}
        self._kept: dict[tuple[str, str], type[Message] | Service2] = {}

    def message(self, name: str) -> type[Message]:
        """The class of a message type. UnknownType, DecodeError."""
        plain = plain_name(name)
        found = self._definitions.get(plain)
        if found is None:
            found = self._resolved(self._parsed(plain, ""))
        return self._class(self._definitions.setdefault(plain, found))

    def service(self, name: str) -> Service2:
        """A service type. UnknownType, DecodeError."""
        plain = plain_name(name)
        found = self._services.get(plain)
        if found is None:
            text = self._text(plain, "srv", "")
            halves = [self._resolved(half) for half in parse_service(text, plain)]
            definition = ServiceDefinition(plain, text, *halves)
            found = Service2(definition, *map(self._class, halves))
        return self._services.setdefault(plain, found)

    def action(self, name: str) -> Action:
        """An action type, package/action/Name or package/Name. UnknownType, DecodeError."""
        whole = action_name(name)
        if whole not in self._actions:
            goal, result, feedback, told = (self.message(f"{whole}_{part}") for part in MESSAGES)
            send, get = (self.service(f"{whole}_{part}") for part in SERVICES)
            found = Action(whole, goal, result, feedback, send, get, told)
            self._actions.setdefault(whole, found)
        return self._actions[whole]

    def load(self, name: str) -> type[Message] | Service2 | Action:
        """The message, or the service if there is no such message; an action if the name says
        so. UnknownType, DecodeError."""
        if "/action/" in name:
            part = part_of(name)
            if part is None:
                return self.action(name)
            return self.service(name) if part[1] in SERVICES else self.message(name)
        if "/srv/" in name:
            return self.service(name)
        try:
            return self.message(name)
        except UnknownType as error:
            if "/msg/" in name:
                raise
            try:
                return self.service(name)
            except UnknownType:
                raise error from None

    def message_of(self, name: str, full_text: str) -> type[Message]:
        """The class of a type whose texts somebody brings along, such as a pickled message."""
        texts = Texts(split_full_text(name, full_text), f"the definition of {name}")
        return self._class(Library([texts, *self.sources]).message(name)._definition)

    def having(self, name: str, hash_: str, kind: str = "msg") -> type[Message] | Service2:
        """The version of a type that a peer has, by its hash: ours, or that of another
        distribution. UnknownType says both hashes."""
        kept = self._kept.get((plain_name(name), hash_))
        if kept is not None:
            return kept
        load = Library.message if kind == "msg" else Library.service
        ours = ""
        for library in (self, *self._of_others()):
            try:
                found = load(library, name)
            except UnknownType:
                if library is self and not self._of_others():
                    raise
                continue
            except DecodeError:
                continue
            sum_ = hash_of(found)
            if sum_ == hash_:
                return found
            ours = ours or sum_
        if not ours:
            load(self, name)
        raise UnknownType(
            f"{full_name(plain_name(name), kind)} is {hash_} there and {ours} here: the "
            "definitions differ; put that of the peer into a package of AMENT_PREFIX_PATH"
        )

    def keep(self, found: type[Message] | Service2) -> None:
        """Remember a type that a peer has described."""
        name = found.name if isinstance(found, Service2) else found._type
        self._kept[name, hash_of(found)] = found
        while len(self._kept) > _MET:
            self._kept.pop(next(iter(self._kept)), None)

    def _of_others(self) -> list[Library]:
        """The same library, with the types of other distributions before all others."""
        if not any(isinstance(source, Rosbags) for source in self.sources):
            return []
        for name in DISTROS:
            if name not in self._others and not any(
                isinstance(source, Rosbags) and source.name == name for source in self.sources
            ):
                self._others[name] = Library([Rosbags(name), Standard(), Shipped()])
        return [*self._others.values()]

    def _class(self, definition: Definition) -> type[Message]:
        key = definition.name, definition.md5sum
        found = self._classes.get(key)
        if found is None:
            used = {each.struct: self._class(each) for each in definition.all_used()}
            found = make(definition, used, restore, cdr_reader, cdr_writer)
            found = self._classes.setdefault(key, found)
            while len(self._classes) > _MET:
                self._classes.pop(next(iter(self._classes)), None)
        return found

    def _resolved(self, parsed: MessageText) -> Definition:
        return resolve(parsed, self._parsed, self._definitions, sum_=message_hash)

    def _parsed(self, name: str, within: str) -> MessageText:
        return parse_message(self._text(name, "msg", within), name)

    def _text(self, name: str, kind: str, within: str) -> str:
        for source in self.sources:
            text = source.find(name, kind)
            if text is not None:
                return text
        part = part_of(name)
        if part is not None and (part[1] in SERVICES) == (kind == "srv"):
            found = texts_of(part[0], self._text(part[0].replace("/action/", "/"), "action", ""))
            return found[name]
        what = {"srv": "service", "action": "action"}.get(kind, "message")
        needed = f", which {within} contains," if within else ""
        asked = "; ".join(map(str, self.sources)) or "nobody"
        raise UnknownType(
            f"no definition of the {what} {full_name(name, kind)}{needed} was found. Asked: "
            f"{asked}. Put share/{full_name(name, kind)}.{kind} below a folder of AMENT_PREFIX_PATH"
        )


def hash_of(kind: type[Message] | Service) -> str:
    """The type hash of a class of messages, or of a service."""
    return kind.md5sum if isinstance(kind, Service) else kind._md5sum


def standard_sources() -> tuple[Source, ...]:
    """The packages of this process's environment, rosbags, and what yarpy brings."""
    return installed(os.environ), Rosbags(distro(os.environ)), Standard(), Shipped()


@cache
def default_library() -> Library:
    """The library of this process: the types that its environment has when it is first asked."""
    return Library()


def restore(name: str, full_text: str, data: bytearray) -> Message:
    """A message that was copied or pickled."""
    return default_library().message_of(name, full_text).from_ros(data)
