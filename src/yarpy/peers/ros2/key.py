"""Keys: where a topic's messages and a service's questions go in Zenoh.

    0/robot1/chatter/std_msgs::msg::dds_::String_/RIHS01_df66...1a18

Rules: domain, name, type, hash. Whoever has another type or hash has another key, and hears nothing
of us: `token.py` finds out who that is. Humble has no hashes, but one word in their place.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Final, NamedTuple

from yarpy.errors import AddressError

#: what stands for the hash in Humble
NO_HASH: Final = "TypeHashNotSupported"
DOMAIN: Final = "ROS_DOMAIN_ID"
HIGHEST: Final = 232


class Key(NamedTuple):
    """`name` has a leading slash; `type` is spelled as by `dds_name`."""

    domain: int
    name: str
    type: str
    hash: str

    def __str__(self) -> str:
        return f"{self.domain}{self.name}/{self.type}/{self.hash}"


def domain(said: str | None, environment: Mapping[str, str] = os.environ) -> int:
    """The domain that somebody says, else that of ROS_DOMAIN_ID, else 0. Raises AddressError."""
    text = environment.get(DOMAIN, "") if said is None else said
    if not text:
        return 0
    if not (text.isascii() and text.isdigit() and len(text) < 4 and int(text) <= HIGHEST):
        raise AddressError(f'"{text[:80]}" is no domain of ROS: from 0 to {HIGHEST} ({DOMAIN})')
    return int(text)
