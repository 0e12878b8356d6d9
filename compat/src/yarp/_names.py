"""Which name service the ports of this program use: that of the configuration, or one inside; with
a source of names of the program in front of it (`Network.queryBypass`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import yarpy

Lookup = Callable[[str], yarpy.Contact | None]

_local: yarpy.NameClient | None = None
_front: _Front | None = None


class _Front:
    """A name service that looks names up elsewhere."""

    def __init__(self, lookup: Lookup) -> None:
        self._lookup = lookup

    def query(self, name: str) -> yarpy.Contact | None:
        return self._lookup(name)

    def __getattr__(self, name: str) -> Any:
        return getattr(_behind(), name)


def _behind() -> yarpy.NameClient:
    from yarpy.names.default import DEFAULT

    return DEFAULT.current() if _local is None else _local


def names() -> yarpy.NameClient | None:
    """The name client for what is opened now; None is yarpy's default."""
    front: Any = _front
    return _local if front is None else front


def be_local(flag: bool) -> None:
    """Names inside this program alone, or those of the network again."""
    global _local
    if flag != (_local is not None):
        _local = yarpy.LocalNames() if flag else None


def bypass(lookup: Lookup | None) -> None:
    """Look names up by a function, or no more."""
    global _front
    _front = None if lookup is None else _Front(lookup)
