"""Numbers that the environment of a program gives, such as YARPY_CONNECTIONS.

Rules: what is no number is ignored, with one warning.
"""

from __future__ import annotations

import os
from functools import cache

from yarpy.log import logger

log = logger("yarpy.link")


def number(name: str, default: int) -> int:
    """Return the number that the environment variable `name` gives, or `default`."""
    return _read(name, os.environ.get(name, ""), default)


@cache
def _read(name: str, text: str, default: int) -> int:
    if text.isascii() and text.isdigit() and len(text) < 19:
        return int(text)
    if text:
        log.warning("%s=%.40r is not a number and is ignored", name, text)
    return default
