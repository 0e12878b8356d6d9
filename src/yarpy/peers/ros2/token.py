"""Tokens: how nodes, publishers, subscribers and services are seen, by us and by tools of ROS 2.

    @ros2_lv/0/ZID/0/0/NN/%/%/listener                                       a node
    @ros2_lv/0/ZID/0/10/MS/%/%/listener/%chatter/TYPE/HASH/::,10:,:,:,,      a subscriber of it

Rules: a token lives as long as the Zenoh session that declared it. What is no such text is a
DecodeError, whatever it is: anybody may declare tokens. Fields behind the last are ignored, as ROS
does. The 16 bytes by which messages name their publisher (GID) are a hash of its token.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final

from yarpy.errors import DecodeError, UnknownPlugin
from yarpy.limit import ROS2_TOKEN
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos, parse_qos

SPACE: Final = "@ros2_lv"
NODE: Final = "NN"
PUBLISHER: Final = "MP"
SUBSCRIBER: Final = "MS"
SERVER: Final = "SS"
CLIENT: Final = "SC"
ENDPOINTS: Final = (PUBLISHER, SUBSCRIBER, SERVER, CLIENT)

_NUMBER = re.compile(r"\d{1,20}", re.ASCII)
_NODE_FIELDS: Final = 9
_FIELDS: Final = 13


@dataclass(frozen=True, slots=True)
class Token:
    """`zid` is the session; `nid` numbers its nodes, `id` all that it declares. Of a node `key` is
    None. `extra`: a field behind the last."""

    domain: int
    zid: str
    nid: int
    id: int
    kind: str
    node: Node
    key: Key | None = None
    qos: Qos = field(default_factory=Qos)
    extra: str = ""

    @property
    def whose(self) -> tuple[str, int]:
        """The key of its node, which no other node has."""
        return self.zid, self.nid

    def __str__(self) -> str:
        words = (SPACE, self.domain, self.zid, self.nid, self.id, self.kind, "%")
        found = "/".join([*map(str, words), _folded(self.node.namespace), self.node.name])
        if self.key is None:
            return found
        key = self.key
        found += f"/{_folded(key.name)}/{key.type}/{key.hash}/{self.qos}"
        return f"{found}/{self.extra}" if self.extra else found


def _folded(name: str) -> str:
    return name.replace("/", "%")


def parse_token(text: str) -> Token:
    """Parse a token. Raises DecodeError."""
    fields = text.split("/") if len(text) <= ROS2_TOKEN else []
    if len(fields) < _NODE_FIELDS or fields[0] != SPACE or not all(fields):
        raise DecodeError(f"{text[:80]!r} is no token of ROS 2")
    _, domain, zid, nid, id_, kind, _, namespace, name = fields[:_NODE_FIELDS]
    numbers = []
    for number in (domain, nid, id_):
        if not _NUMBER.fullmatch(number):
            raise DecodeError(f"a token of ROS 2 with {number[:40]!r} for a number")
        numbers.append(int(number))
    node = Node(namespace.replace("%", "/"), name)
    if kind == NODE:
        return Token(numbers[0], zid, numbers[1], numbers[2], kind, node)
    if kind not in ENDPOINTS or len(fields) < _FIELDS:
        raise DecodeError(f"{text[:80]!r} is no token of ROS 2")
    topic, type_, hash_, qos = fields[_NODE_FIELDS:_FIELDS]
    key = Key(numbers[0], topic.replace("%", "/"), type_, hash_)
    extra = "/".join(fields[_FIELDS:])
    return Token(numbers[0], zid, numbers[1], numbers[2], kind, node, key, parse_qos(qos), extra)


def gid(token: str) -> bytes:
    """The 16 bytes that stand for an endpoint. Raises UnknownPlugin without the library xxhash."""
    try:
        from xxhash import xxh3_128_intdigest
    except ImportError as error:
        raise UnknownPlugin(f"ROS 2 needs xxhash ({error}): `pip install 'yarpy[ros2]'`") from error
    number = xxh3_128_intdigest(token.encode())
    low, high = number & ((1 << 64) - 1), number >> 64
    return low.to_bytes(8, "little") + high.to_bytes(8, "little")
