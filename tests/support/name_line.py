"""How commands arrive at a name server over text connections, and a small server made of that.

Rules: `NameLines` and `TextLines` are pure and take bytes in pieces of any size. `serve_names` is
a stand-in for the real name server, with threads, for testing clients alone.
"""

import contextlib
import socket
import socketserver
import threading
from collections.abc import Iterator
from typing import Any

from support.wait import HANG

from yarpy.nameserver.command import NameService
from yarpy.nameserver.reply import Reply
from yarpy.nameserver.store import NameStore
from yarpy.nameserver.topology import Topology


class NameLines:
    """`NAME_SERVER query /x`: 8 bytes of carrier header, 4 to ignore, a line; 12 to ignore, ..."""

    def __init__(self, service: NameService, peer: str = "127.0.0.1") -> None:
        self.service = service
        self.peer = peer
        self.replies: list[Reply] = []
        self._buffer = b""

    def feed(self, data: bytes) -> bytes:
        """What to send back for what came."""
        self._buffer += data
        out = b""
        while len(self._buffer) > 12:
            line, end, rest = self._buffer[12:].partition(b"\n")
            if not end:
                break
            self._buffer = rest
            reply = self.service.answer_text(line.rstrip(b"\r"), self.peer)
            self.replies.append(reply)
            out += reply.to_bytes()
        return out


class TextLines:
    """`CONNACK me`, then `d` and a command on the next line, `q` to end; `CONNECT`: no <ACK>."""

    def __init__(self, service: NameService, peer: str = "127.0.0.1") -> None:
        self.service = service
        self.peer = peer
        self.done = False
        self._buffer = b""
        self._acks: bytes | None = None
        self._data = False

    def feed(self, data: bytes) -> bytes:
        self._buffer += data
        out = b""
        while b"\n" in self._buffer and not self.done:
            line, _, self._buffer = self._buffer.partition(b"\n")
            line = line.rstrip(b"\r")
            if self._acks is None:
                self._acks = b"<ACK>\r\n" if line.startswith(b"CONNACK ") else b""
                out += b"Welcome " + line[8:] + b"\r\n"
            elif self._data:
                self._data = False
                out += self.service.answer_text(line, self.peer).to_bytes() + self._acks
            elif line == b"d":
                self._data = True
            elif line == b"q":
                self.done = True
                out += self._acks
        return out


class _Handler(socketserver.BaseRequestHandler):
    server: Any

    def handle(self) -> None:
        lines: NameLines | TextLines | None = None
        with self.server.lock:
            self.server.open.append(self.request)
        while True:
            try:
                data = self.request.recv(65536)
                if not data:
                    return
                if lines is None:
                    kind = NameLines if data.startswith(b"NAME") else TextLines
                    lines = kind(self.server.service, self.client_address[0])
                self.request.sendall(lines.feed(data))
            except OSError:
                return


class NameServerStub(socketserver.ThreadingTCPServer):
    """A name server for the tests of clients; `service` is what it knows."""

    allow_reuse_address = True
    daemon_threads = True

    def __init__(self, service: NameService, port: int = 0) -> None:
        self.service = service
        self.lock = threading.Lock()
        self.open: list[socket.socket] = []
        super().__init__(("127.0.0.1", port), _Handler)
        self.port: int = self.server_address[1]

    @property
    def connections(self) -> int:
        """How many were accepted so far."""
        with self.lock:
            return len(self.open)


def new_service(port: int = 10000) -> NameService:
    """An empty name service on 127.0.0.1 with a clock that stands still."""
    return NameService(NameStore("127.0.0.1", port), Topology(lambda: 1000.0))


@contextlib.contextmanager
def serve_names(service: NameService | None = None, port: int = 0) -> Iterator[NameServerStub]:
    """Run a stub server; on exit its connections are cut as if the process had ended."""
    server = NameServerStub(service or new_service(), port)
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        server.server_close()
        thread.join(HANG)
        for connection in server.open:
            with contextlib.suppress(OSError):
                connection.shutdown(socket.SHUT_RDWR)
