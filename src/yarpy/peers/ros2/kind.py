"""The type of a topic or service: what the user says, what the graph says, what is written.

Rules: pure. Where a peer has another version of a type that somebody here knows, that one is taken;
where nobody knows it, the error says both. Nodes of Humble have no hashes: there the name decides.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any, Final

from yarpy.data.sig.vector import Vector
from yarpy.errors import DecodeError, UnknownType, YarpError
from yarpy.peers.ros.message.convert.native import are_numbers, type_for
from yarpy.peers.ros.message.library import Service
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros2.key import NO_HASH, Key
from yarpy.peers.ros2.message.hash import dds_name, full_name, is_hash, ros_name
from yarpy.peers.ros2.message.library import Library, default_library, hash_of
from yarpy.peers.ros2.message.source import Rosbags, Standard, installed
from yarpy.peers.ros2.token import Token

MESSAGE: Final = "msg"
SERVICE: Final = "srv"
MOST_ASKED: Final = 4  # nodes, for the types of one topic or service


@cache
def humble() -> Library:
    """The types of Humble, which says of none which version it is."""
    return Library([installed(os.environ), Rosbags("humble"), Standard()])


def named(name: str, kind: str, seen: Iterable[Token] = (), old: bool = False) -> Any:
    """The type that a user names; of the version that others have at the same topic, if somebody
    here knows that. `old`: for Humble. Raises UnknownType, DecodeError."""
    if old:
        return _load(humble(), name, kind)
    ours = _load(default_library(), name, kind)
    dds = dds_name(_plain(ours), kind)
    for token in seen:
        key = token.key
        if key is not None and key.type == dds and key.hash != hash_of(ours):
            try:
                return default_library().having(_plain(ours), key.hash, kind)
            except UnknownType:
                continue  # it hears nothing of us, as the watch says
    return ours


def learned(
    seen: Iterable[Token], kind: str, ask: Callable[[Token, str, str], Any]
) -> tuple[Any, Key] | None:
    """The type of the first token that one is known of, and its key; None without tokens. `ask`
    asks its node, of so many tokens at most: each may keep us waiting. Raises UnknownType if
    neither knows any of their types."""
    problem: YarpError | None = None
    asked = 0
    for token in seen:
        key = token.key
        if key is None:
            continue
        try:
            name, found = ros_name(key.type)
            if found != kind:
                continue
            if key.hash == NO_HASH:
                return _unversioned(name, kind), key
            if is_hash(key.hash):
                try:
                    return default_library().having(name, key.hash, kind), key
                except UnknownType as error:
                    if asked >= MOST_ASKED:
                        raise
                    asked += 1
                    return _asked(ask, token, name, kind, error), key
        except (UnknownType, DecodeError) as error:
            problem = problem or error
    if problem is not None:
        raise problem
    return None


def _unversioned(name: str, kind: str) -> Any:
    """The type of a peer that does not say which version it has: that of Humble."""
    try:
        return _load(humble(), name, kind)
    except UnknownType as error:
        try:
            _load(default_library(), name, kind)
        except UnknownType:
            raise error from None
        raise UnknownType(
            f"{error}. The other side says no type hash, as nodes of Humble: if it means the "
            f"definition that is known here, add ~{full_name(name, kind)} to the target"
        ) from error


def _asked(
    ask: Callable[[Token, str, str], Any], token: Token, name: str, kind: str, before: UnknownType
) -> Any:
    try:
        return ask(token, name, kind)
    except UnknownType as error:
        raise UnknownType(f"{before}; {error}") from before


def chosen(value: object) -> type[Message]:
    """The type that a value naturally becomes, for a topic that nobody gave another. Raises
    DecodeError."""
    while isinstance(value, list) and len(value) == 1:
        value = value[0]
    if isinstance(value, Message) and is_hash(value._md5sum):
        return type(value)  # of ROS 2 already, perhaps one that only a file defines
    name = type_for(Vector([*value]) if are_numbers(value) else value)  # type: ignore[misc]
    if name is None:
        raise DecodeError(
            f"{type(value).__name__} may become many types of ROS 2, and nobody subscribes yet who "
            "says which: write ros2://TOPIC~package/msg/Type"
        )
    try:
        return default_library().message(name)
    except UnknownType:
        raise DecodeError(f"{name} is no type of ROS 2 that is known here") from None


def key_of(domain: int, name: str, kind: Any, old: bool) -> Key:
    """Return the key under which messages of a type go, or questions to a service. `old`: for
    Humble."""
    what = SERVICE if isinstance(kind, Service) else MESSAGE
    return Key(domain, name, dds_name(_plain(kind), what), NO_HASH if old else hash_of(kind))


def shown(key: Key) -> str:
    """A type and its hash, for people."""
    try:
        name, kind = ros_name(key.type)
    except DecodeError:
        return f"{key.type} ({key.hash})"
    return f"{full_name(name, kind)} ({key.hash})"


def has_bytes(kind: Any) -> bool:
    """Return whether messages of a type have a list of bytes of any length, as pictures do."""
    return any(
        str(field.type) == "uint8[]"
        for struct in (kind._definition.struct, *kind._used)
        for field in struct.fields
    )


def _load(library: Library, name: str, kind: str) -> Any:
    return library.message(name) if kind == MESSAGE else library.service(name)


def _plain(kind: Any) -> str:
    found: str = kind.name if isinstance(kind, Service) else kind._type
    return found
