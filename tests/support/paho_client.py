"""The end of a client of paho-mqtt."""

from __future__ import annotations

from typing import Any


def end(client: Any) -> None:
    """Disconnect it, and leave no thread and no socket. One that was just connecting again when it
    was told to disconnect keeps what it opens."""
    client.disconnect()
    client.loop_stop()
    client._reset_sockets()
