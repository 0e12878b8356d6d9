"""A Socket.IO server that sends each event on to everybody, as users of Wrapyfi write it."""

from __future__ import annotations

import threading
from socketserver import ThreadingMixIn
from typing import Any
from wsgiref.simple_server import WSGIRequestHandler, WSGIServer, make_server

import socketio
from engineio.payload import Payload

# Of one request: a client that sends more at once, as on a busy machine, would be cut off.
Payload.max_decode_packets = 10_000


class _Server(ThreadingMixIn, WSGIServer):
    daemon_threads = True


class _Quiet(WSGIRequestHandler):
    def log_message(self, format: str, *args: Any) -> None:
        pass


class SocketIoServer:
    """On `port` of the loopback, until the end of a `with` block."""

    def __init__(self, port: int) -> None:
        self.server = socketio.Server(async_mode="threading", allow_upgrades=False)
        self.server.on("*", self._hand_on)
        # A packet and its bytes are several messages, which those of another thread may part.
        self._emits = threading.Lock()
        app = socketio.WSGIApp(self.server)
        self._http = make_server("127.0.0.1", port, app, _Server, _Quiet)
        self._thread = threading.Thread(target=self._http.serve_forever, args=(0.05,), daemon=True)

    def _hand_on(self, event: str, sid: str, *data: Any) -> None:
        with self._emits:
            self.server.emit(event, data if len(data) > 1 else data[0])

    def __enter__(self) -> SocketIoServer:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._http.shutdown()
        self._http.server_close()
        self.server.shutdown()
        self._thread.join()
