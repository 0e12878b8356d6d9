"""How large arriving data may get when unpacked: pictures, compressed messages, lists.

    YARPY_MAX_PICTURE     bytes of pixels, of a JPEG or PNG file or a depth image: 256 MiB
    YARPY_MAX_UNPACKED    bytes of any other message that was compressed: 64 MiB
    YARPY_MAX_ELEMENTS    elements of one message, with those of the lists in it: 4194304

Rules: these hold beside the largest message that a port takes, and for every connection, since the
peer may have chosen the monitor. They are checked before memory is taken. A setting that is not a
number is ignored, with a warning.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

_NAMES: Final = ("YARPY_MAX_PICTURE", "YARPY_MAX_UNPACKED", "YARPY_MAX_ELEMENTS")


@dataclass(frozen=True, slots=True)
class Limits:
    """`picture` and `unpacked` in bytes, `elements` of a list."""

    picture: int = 1 << 28
    unpacked: int = 1 << 26
    elements: int = 1 << 22


def limits() -> Limits:
    """The limits of this process, as its environment says now."""
    return _read(*(os.environ.get(name, "") for name in _NAMES))


@lru_cache(maxsize=8)
def _read(*texts: str) -> Limits:
    given = {}
    for name, field, text in zip(_NAMES, ("picture", "unpacked", "elements"), texts, strict=True):
        if text.isascii() and text.isdigit() and len(text) < 19:
            given[field] = int(text)
        elif text:
            from yarpy.log import logger

            logger("yarpy").warning(
                "%s=%.40r is not a number and is ignored: give bytes or elements in digits",
                name,
                text,
            )
    return Limits(**given)
