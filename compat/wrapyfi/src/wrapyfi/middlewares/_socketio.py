"""The client of python-socketio, with messages in order.

Rules: a packet with bytes is several messages of the connection. The library handles each message
in a thread of its own, and lets threads that send come between the messages of one packet: then
packets get lost with a traceback. Here one thread handles what comes, and packets leave whole. So
what is heard must not wait for an answer of the server.
"""

from __future__ import annotations

import threading
from typing import Any

import engineio
import socketio


class _Connection(engineio.Client):  # type: ignore[misc]
    def _trigger_event(self, event: str, *args: Any, **kwargs: Any) -> Any:
        if event == "message":
            kwargs["run_async"] = False
        return super()._trigger_event(event, *args, **kwargs)


class Client(socketio.Client):  # type: ignore[misc]
    def __init__(self, **options: Any) -> None:
        self._sends = threading.RLock()  # one packet
        super().__init__(**options)

    def _engineio_client_class(self) -> type[_Connection]:
        return _Connection

    def _send_packet(self, packet: Any) -> None:
        with self._sends:
            super()._send_packet(packet)
