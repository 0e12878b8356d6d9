"""Line: one connection to a name server, and what a command and its reply are on it.

Rules: plain blocking sockets with one deadline, `until`. Old style commands go out behind 12 bytes
of prefix each, and their reply ends with a line of its own; over `CONNACK` each reply ends with
`<ACK>`. A reply is bounded.
"""

from __future__ import annotations

import contextlib
import math
import os
import socket
import sys
import time
from typing import Final, Literal

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import DecodeError, RemoteProtocolError
from yarpy.limit import NAME_REPLY
from yarpy.names.registration_line import END, PREFIX

_ACK: Final = "<ACK>"
# Python waits for a socket with a time limit by select, which on Windows does not see that this
# side was shut down: there a wait comes in slices.
SLICE: Final[float | None] = 0.25 if sys.platform == "win32" else None  # seconds


class LineSocket(socket.socket):
    """A socket that nobody has to close: it is kept for the next command of a client that may just
    be dropped. One of the library complains of that, even where it is dropped with an object that
    would close it."""

    __del__ = socket.socket.close


class Gone(Exception):
    """The connection ended before a reply; a new one may do better."""


class Line:
    """One connection after its handshake: `lines` for NAME_SERVER, `acked` for CONNACK."""

    def __init__(self, connection: socket.socket, kind: Literal["lines", "acked"]) -> None:
        self.connection = connection
        self.kind = kind
        self.used = time.monotonic()
        self.process = os.getpid()
        self.until = math.inf  # of what is being said, as of time.monotonic()
        self._buffer = bytearray()
        self._woken = False

    def send(self, data: bytes) -> None:
        try:
            self.connection.settimeout(self._left())
            self.connection.sendall(data)
        except TimeoutError:
            raise
        except OSError as error:
            raise Gone(str(error)) from error

    def line(self) -> str:
        """The next line without its end."""
        start = 0
        while (end := self._buffer.find(b"\n", start)) < 0:
            start = len(self._buffer)
            if start > NAME_REPLY:
                raise RemoteProtocolError(f"a name server's line of more than {NAME_REPLY} bytes")
            try:
                data = self._receive()
            except TimeoutError:
                raise
            except OSError as error:
                raise Gone(str(error)) from error
            if not data:
                raise Gone("it closed the connection")
            self._buffer += data
        text = bytes(self._buffer[:end]).rstrip(b"\r")
        del self._buffer[: end + 1]
        return text.decode("utf-8", "surrogateescape")

    def _receive(self) -> bytes:
        while not self._woken:
            left = self._left()
            if SLICE is not None:
                left = SLICE if left is None else min(left, SLICE)
            self.connection.settimeout(left)
            try:
                return self.connection.recv(65_536)
            except TimeoutError:
                if SLICE is None:
                    raise
        return b""

    def _left(self) -> float | None:
        """The seconds for what comes next. Raises TimeoutError."""
        if self.until == math.inf:
            return None
        left = self.until - time.monotonic()
        if left <= 0.0:
            raise TimeoutError("timed out")
        return left

    def wake(self) -> None:
        """Free a thread that waits for the server."""
        self._woken = True
        with contextlib.suppress(OSError):
            self.connection.shutdown(socket.SHUT_RDWR)

    @property
    def clean(self) -> bool:
        """Return whether nothing is left over from the last command."""
        return not self._buffer

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self.connection.close()


def old_style(line: Line, command: str) -> list[str]:
    line.send(encode(f"{PREFIX}{command}\n"))
    lines: list[str] = []
    size = 0
    while (text := line.line()) != END:
        if text.startswith("[") and not lines:
            try:  # [ok] to an announce, or [fail] and why
                return list(map(plain_text, Bottle.from_text(text)[1:2]))
            except DecodeError:
                return []
        size += len(text) + 2
        if size > NAME_REPLY:
            raise RemoteProtocolError(f"a name server's reply of more than {NAME_REPLY} bytes")
        lines.append(text)
    return lines


def acknowledged(line: Line, *commands: str) -> list[list[str]]:
    """Send commands in one piece; the lines of each reply."""
    line.send(encode("".join(f"d\r\n{command}\r\n" for command in commands)))
    replies: list[list[str]] = []
    size = 0
    for _ in commands:
        lines: list[str] = []
        while (text := line.line()) != _ACK:
            size += len(text) + 2
            if size > NAME_REPLY:
                raise RemoteProtocolError(f"a name server's reply of more than {NAME_REPLY} bytes")
            lines.append(text)
        replies.append(lines)
    return replies


def encode(text: str) -> bytes:
    # A newline inside a string is escaped in Bottle text, so one command is one line.
    return text.encode("utf-8", "surrogateescape")
