"""Sockets at a path, for programs of one user on one computer.

    Linux, macOS    a Unix socket, whose file says who may connect
    Windows         TCP on loopback; the file has the number, and a word that whoever connects has
                    to say first, so that only those come in who may read it

Rules: streams, bytes as they come. The file is removed by whoever listens; one that was killed
leaves it, and then connecting is a ConnectionError.
"""

from __future__ import annotations

import hmac
import secrets
import socket
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Final

from yarpy.platform import file_place

LOOPBACK: Final = "127.0.0.1"
_WORD: Final = 32  # letters
_GREETING: Final = 2.0  # seconds that one may take to say it


class LoopbackListener:
    """Listens on loopback for whoever can read the file at `path`. Raises OSError."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._closed = False
        self._word = secrets.token_hex(_WORD // 2)
        self._socket = socket.create_server((LOOPBACK, 0), backlog=16)
        draft = path.with_suffix(".new")
        draft.write_text(f"{self._socket.getsockname()[1]} {self._word}", "utf-8")
        file_place.replace(draft, path)

    def accept(self) -> socket.socket:
        """Return the next connection. Raises OSError once we are closed."""
        while True:
            link, _ = self._socket.accept()
            if self._closed:
                link.close()
                raise ConnectionAbortedError(f"{self._path} is closed")
            with suppress(OSError):  # a stranger, or one that has gone
                if hmac.compare_digest(_read(link, _WORD), self._word.encode()):
                    return link
            link.close()

    def close(self) -> None:
        """Take the file away and end; whoever waits in `accept` is woken."""
        file_place.remove(self._path)
        self._closed = True
        with suppress(OSError):  # closing alone wakes nobody everywhere
            socket.create_connection(self._socket.getsockname(), _GREETING).close()
        self._socket.close()


def connect_loopback(path: Path, timeout: float) -> socket.socket:
    """Return a connection to whoever listens at `path`. Raises OSError: FileNotFoundError or
    ConnectionError if nobody does."""
    number, _, word = path.read_text("utf-8").partition(" ")
    try:
        link = socket.create_connection((LOOPBACK, int(number)), timeout)
    except (ValueError, OverflowError) as error:
        raise ConnectionError(f"{path} is no socket") from error
    try:
        link.sendall(word.encode())
    except BaseException:
        link.close()
        raise
    return link


def _read(link: socket.socket, size: int) -> bytes:
    """Return so many bytes, or fewer if there are no more. Raises OSError if they take too long,
    however they come: others wait meanwhile."""
    found, until = b"", time.monotonic() + _GREETING
    while len(found) < size:
        link.settimeout(max(until - time.monotonic(), 0.001))
        more = link.recv(size - len(found))
        if not more:
            break
        found += more
    link.settimeout(_GREETING)
    return found


if sys.platform == "win32":
    Listener = LoopbackListener
    connect = connect_loopback

else:

    class Listener:
        """Listens at `path`, for this user alone. Raises OSError."""

        def __init__(self, path: Path) -> None:
            self._path = path
            path.unlink(missing_ok=True)
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            self._socket.bind(str(path))
            path.chmod(0o600)
            self._socket.listen(16)

        def accept(self) -> socket.socket:
            """Return the next connection. Raises OSError once we are closed."""
            return self._socket.accept()[0]

        def close(self) -> None:
            """Take the file away and end; whoever waits in `accept` is woken."""
            self._path.unlink(missing_ok=True)
            with suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
            self._socket.close()

    def connect(path: Path, timeout: float) -> socket.socket:
        """Return a connection to whoever listens at `path`. Raises OSError: FileNotFoundError or
        ConnectionError if nobody does."""
        link = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            link.settimeout(timeout)
            link.connect(str(path))
        except BaseException:
            link.close()
            raise
        return link
