"""The network as a whole: connections between any two ports, their priorities, their traffic."""

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
