"""Zenoh: names and connections across networks, and keys as ends of connections for programs that
know nothing of YARP.

    names = yarpy.zenoh.ZenohNames("tcp/127.0.0.1:7447")
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yarpy.peers.zenoh.names import ZenohNames as ZenohNames

__all__ = ["ZenohNames"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from yarpy.peers.zenoh.names import ZenohNames

    return ZenohNames
