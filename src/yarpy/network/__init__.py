"""The network as a whole: connections between any two ports, their priorities, their traffic.

Rules: a name is imported when it is needed. A package that imports its parts at once hands them
half done to other threads that happen to meet one of the parts first.
"""

from typing import TYPE_CHECKING

__all__ = [
    "Pairing",
    "RemoteConnection",
    "admin",
    "ask_server",
    "connect",
    "disconnect",
    "exists",
    "find",
    "is_connected",
    "ping",
    "query",
    "wait_for",
]

if TYPE_CHECKING:
    from yarpy.network.asking import admin, ask_server, find, ping, query
    from yarpy.network.connection import disconnect, exists, is_connected, wait_for
    from yarpy.network.pairing import Pairing
    from yarpy.network.remote import RemoteConnection, connect
else:
    _PARTS = {
        "asking": ("admin", "ask_server", "find", "ping", "query"),
        "connection": ("disconnect", "exists", "is_connected", "wait_for"),
        "pairing": ("Pairing",),
        "remote": ("RemoteConnection", "connect"),
    }

    def __getattr__(name):
        from importlib import import_module

        for part, names in _PARTS.items():
            if name in names:
                return getattr(import_module(f"{__name__}.{part}"), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
