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
    from yarpy.network.connection import (
        Pairing,
        admin,
        ask_server,
        disconnect,
        exists,
        find,
        is_connected,
        ping,
        query,
        wait_for,
    )
    from yarpy.network.remote import RemoteConnection, connect
else:

    def __getattr__(name):
        from importlib import import_module

        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        part = "remote" if name in ("RemoteConnection", "connect") else "connection"
        return getattr(import_module(f"{__name__}.{part}"), name)
