"""Keys: where a topic's messages and a service's questions go in Zenoh.

    0/robot1/chatter/std_msgs::msg::dds_::String_/RIHS01_df66...1a18

Rules: domain, name, type, hash. Whoever has another type or hash has another key, and hears nothing
of us: `token.py` finds out who that is. Humble has no hashes, but one word in their place.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Final, NamedTuple

from yarpy.errors import AddressError, DecodeError

#: what stands for the hash in Humble
NO_HASH: Final = "TypeHashNotSupported"
DOMAIN: Final = "ROS_DOMAIN_ID"
HIGHEST: Final = 232

_KEY = re.compile(r"(\d{1,10})/(.+)/([^/]+)/([^/]+)", re.DOTALL)


class Key(NamedTuple):
    """`name` has a leading slash; `type` is spelled as by `dds_name`."""

    domain: int
    name: str
    type: str
    hash: str

    def __str__(self) -> str:
        return f"{self.domain}{self.name}/{self.type}/{self.hash}"


def parse_key(text: str) -> Key:
    """The parts of a key. Raises DecodeError."""
    found = _KEY.fullmatch(text)
    if found is None:
        raise DecodeError(f"{text[:80]!r} is no key of ROS 2")
    return Key(int(found[1]), f"/{found[2]}", found[3], found[4])


def domain(said: str | None, environment: Mapping[str, str] = os.environ) -> int:
    """The domain that somebody says, else that of ROS_DOMAIN_ID, else 0. Raises AddressError."""
    text = environment.get(DOMAIN, "") if said is None else said
    if not text:
        return 0
    if not (text.isascii() and text.isdigit() and len(text) < 4 and int(text) <= HIGHEST):
        raise AddressError(f'"{text[:80]}" is no domain of ROS: from 0 to {HIGHEST} ({DOMAIN})')
    return int(text)
