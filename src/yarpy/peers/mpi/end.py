"""The common part of both carriers of MPI: how two programs find each other over TCP, and what
tells that one of them has died, as MPI does not.

Rules: C++ hangs up once both have met in MPI. Two programs of yarpy stay on the line: each says a
newline then, and its end is the other one's end.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Final

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.log import readable
from yarpy.peers.mpi.library import HINT, Library
from yarpy.transports.base import Address, Transport
from yarpy.transports.descriptor import has_input
from yarpy.transports.socket_transport import MSG_DONTWAIT
from yarpy.wire.framing import refused
from yarpy.wire.stream import Buffer

MEETING: Final = 10.0  # seconds for the two sides to meet
LEAVING: Final = 2.0  # seconds for leaving each other
LATE: Final = 1.0  # seconds for the end of the line to have a good reason
MOST: Final = 1 << 26  # bytes that are sent at once
_HELLO: Final = b"\n"
_BELL: Final = b"."
_LINE: Final = 1000  # bytes that a peer may say instead


class Line:
    """The TCP connection on which the two met: who keeps it shows that it lives."""

    def __init__(self, sock: socket.socket) -> None:
        self._sock: socket.socket | None = sock.dup()
        self._sock.setblocking(True)
        self.local: Address = sock.getsockname()[:2]
        self.remote: Address = sock.getpeername()[:2]
        self._kept = False  # by the other side, too
        self._since = 0.0

    def watch(self) -> None:
        """While the two look for each other. Raises RemoteProtocolError if the peer does not."""
        said = self._peek()
        if said and not said.startswith(_HELLO):
            line = said.partition(b"\n")[0].rstrip()
            answer = readable(line.decode("utf-8", "replace"))
            raise refused(line) or RemoteProtocolError(f'the peer answers "{answer[:80]}"')
        if said == b"" and self.late():
            raise RemoteProtocolError(
                f"the peer hung up: it takes no MPI, or could not begin, as its log says; {HINT}"
            )

    def settle(self) -> None:
        """Both have met: tell the other side that we keep the line."""
        self._since = 0.0
        if self._sock is not None:
            with suppress(OSError):  # C++ has closed it
                self._sock.sendall(_HELLO)

    @property
    def cut(self) -> bool:
        """Return whether the other side has gone although it had kept the line open."""
        said = self._peek()
        if said and not self._kept and self._sock is not None:
            self._kept = self._sock.recv(len(_HELLO)) == _HELLO
            said = self._peek()
        if said == b"" and not self._kept:
            self.close()
        return said == b"" and self._kept

    def ring(self) -> None:
        """Wake a program of yarpy that waits for what comes by MPI."""
        if self._sock is not None:
            with suppress(OSError):  # it is gone, as is noticed elsewhere
                self._sock.sendall(_BELL)

    def hear(self, seconds: float) -> bytes | None:
        """The next byte: the other side keeps the line, or rings; empty if it has gone, None if it
        is silent for so long."""
        sock = self._sock
        if sock is None:
            return b""
        try:
            if not has_input(sock.fileno(), seconds):
                return None
            said = sock.recv(1, MSG_DONTWAIT)
        except BlockingIOError:
            return None
        except (OSError, ValueError):  # closed meanwhile
            return b""
        self._kept = self._kept or said == _HELLO
        return said

    def late(self) -> bool:
        """Return whether more than `LATE` seconds have passed since the first call."""
        self._since = self._since or time.monotonic()
        return time.monotonic() - self._since > LATE

    def _peek(self) -> bytes | None:
        """Return the bytes that have arrived, without taking them; None if there are none, or can
        be none."""
        sock = self._sock
        if sock is None:
            return None
        try:
            return sock.recv(_LINE, socket.MSG_PEEK | MSG_DONTWAIT)
        except BlockingIOError:
            return None
        except OSError:
            return b""

    def close(self) -> None:
        """Hang up."""
        sock, self._sock = self._sock, None
        if sock is not None:
            sock.close()


class MpiEnd(Transport):
    """The facts of one end of a connection. `place` is where MPI finds the one who dialled."""

    def __init__(self, library: Library, line: Line, place: str) -> None:
        self._library = library
        self._mpi = library.mpi
        self._line = line
        self._dialled = bool(place)
        self.program = library.program
        self.place = place
        self._limit: float | None = None
        self._send_limit: float | None = None
        self._interrupted = False

    @property
    def local(self) -> Address:
        return self._line.local

    @property
    def remote(self) -> Address:
        return self._line.remote

    def set_dscp(self, tos: int) -> None:
        raise LocalProtocolError("packets of MPI have no priority of ours; use tcp for that")

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._limit = seconds
        if sends:
            self._send_limit = seconds

    def interrupt(self) -> None:
        self._interrupted = True


def explained(error: Exception) -> LocalProtocolError:
    """Return the error for what MPI reports, with the likely reason."""
    said = " ".join(str(error).split())
    return LocalProtocolError(f'MPI says "{said[:120]}"; {HINT}')


def pieces(buffers: Sequence[Buffer]) -> tuple[bytes, list[Buffer]]:
    """As much as is sent at once, copied; and what is left."""
    taken: list[Buffer] = []
    left: list[Buffer] = []
    size = 0
    for buffer in buffers:
        room = MOST - size
        if room >= len(buffer):
            taken.append(buffer)
        else:
            view = memoryview(buffer)
            taken.append(view[:room])
            left.append(view[room:])
        size += len(taken[-1])
    return b"".join(taken), left
