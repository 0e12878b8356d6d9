"""Which name service the ports of this program use: that of the configuration, or one inside."""

from __future__ import annotations

import yarpy

_local: yarpy.NameClient | None = None


def names() -> yarpy.NameClient | None:
    """The name client for what is opened now; None is yarpy's default."""
    return _local


def be_local(flag: bool) -> None:
    """Names inside this program alone, or those of the network again."""
    global _local
    if flag != (_local is not None):
        _local = yarpy.LocalNames() if flag else None
