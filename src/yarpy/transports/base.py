"""Transport: moves bytes and knows no protocol.

Rules: blocking calls, no Python-level timeouts (a kernel receive timeout costs nothing per call,
but begins anew behind each signal; Windows has `polling.py`); `interrupt` wakes the threads inside;
`close` is idempotent. Errors are OSError, mapped to ours by the driver alone.
"""

from __future__ import annotations

import socket
from collections.abc import Callable, Sequence
from typing import Any

Address = tuple[str, int]


class Transport:
    """One side of a pipe: of bytes, or, as an ObjectTransport, of whole objects.

    `scheme`: its name in the registry. `secure`: in TLS. `eager`: polling for what comes may beat
    sleeping. `cost`: seconds that a send takes at least, where threads of its own do most of it.
    `dropped`: what was lost before it could be read. `peer_names`: those of the peer's certificate.
    `lends`: `borrow` may give views of what has come. `whole`: a wait that an exception out of a
    signal handler has ended has lost nothing. `sock`: the socket below it, for polling and closing,
    if there is one.
    """

    scheme: str = ""
    secure: bool = False
    eager: bool = True
    cost: float = 0.0
    dropped: int = 0
    lends: bool = False
    whole: bool = False
    sock: socket.socket | None = None

    @property
    def peer_names(self) -> tuple[str, ...]:
        """The names in the peer's certificate, none without TLS."""
        return ()

    @property
    def local(self) -> Address:
        """Our address, `(host, port)`."""
        return "", 0

    @property
    def remote(self) -> Address:
        """The peer's address."""
        return "", 0

    @property
    def port(self) -> int:
        """The number the peer needs to find us, 0 if none."""
        return 0

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Called once before the first byte: here the two ends wait for each other.

        `look` is called now and then meanwhile; it raises if the peer will not come.
        """

    def recv_into(self, view: memoryview) -> int:
        """Wait for bytes; 0 is the end. Raises BlockingIOError when a time limit is over."""
        raise NotImplementedError

    def try_recv_into(self, view: memoryview) -> int:
        """Bytes that have come already; -1 if there are none, 0 at the end."""
        raise NotImplementedError

    def borrow(self, count: int, back: int) -> memoryview | None:
        """The next `count` bytes, read-only, where they have come; None: they have to be copied.
        They begin with the last `back` bytes of those that were received."""
        return None

    def send(self, buffers: Sequence[Any]) -> None:
        """Send everything."""
        raise NotImplementedError

    def try_send(self, buffers: Sequence[Any]) -> list[Any]:
        """Send what leaves without waiting; what is left. An empty buffer in that stands for bytes
        that the transport holds back itself."""
        raise NotImplementedError

    def wait_writable(self, seconds: float) -> bool:
        """Wait until something can be sent, or an error is to be had; False if time is over."""
        return True

    def wait_readable(self, seconds: float) -> bool:
        """Wait until something can be read, or the end; False if time is over."""
        return True

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        """Limit the wait of each receive, and of each send if `sends`; None: for ever."""
        raise NotImplementedError

    def limit_silence(self, seconds: float) -> bool:
        """Take the peer's host for dead after so many seconds without a word from it; return
        whether that can be told here."""
        return False

    def limit_unsent(self, size: int) -> None:
        """Limit the unsent bytes in the system to `size`, where that can be done."""

    def spare_slow_reader(self) -> None:
        """Called now and then while we send: a reader that takes nothing, but whose host answers,
        may do so for ever."""

    def set_dscp(self, tos: int) -> None:
        """Set the IP type-of-service byte (DSCP << 2) of outgoing packets, if there are any."""

    def tos(self) -> int:
        """Return that byte, as the system has it."""
        return 0

    def ended(self) -> bool:
        """Return whether the peer has closed its side, without reading anything."""
        raise NotImplementedError

    def hung_up(self) -> bool:
        """Return whether the peer has closed its side behind bytes that nobody has read yet. Where
        the system cannot tell, False."""
        return False

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        """Return how many bytes the peer's system has confirmed, and whether the peer has hung up
        as one does that has read them all; None: nobody can say. `sent`, `received`: so many went
        and came here."""
        return None

    def failed(self, error: OSError) -> None:
        """Called when receiving or sending has failed."""

    def interrupt(self) -> None:
        """Wake the threads that wait inside; nothing more will be sent or received."""
        raise NotImplementedError

    def close(self) -> None:
        """Release it."""
        raise NotImplementedError


class Answerable(Transport):
    """The transport of a peer that has called us, and that speaks first."""

    def peek(self) -> int:
        """The first byte that comes, left unread; -1 for the end."""
        raise NotImplementedError


class ObjectTransport(Transport):
    """The base of transports that carry whole Python objects instead of bytes: within a process, or
    over a library that has sockets of its own. `send` gets objects, too."""

    def receive(self, wait: bool = True) -> tuple[object] | None:
        """The next object in a one-element tuple; None is the end. Raises BlockingIOError when a
        time limit is over, or there is none and nobody is to wait."""
        raise NotImplementedError

    def unread(self) -> list[object]:
        """The objects that had come when it was closed: nobody reads them any more."""
        return []

    def recv_into(self, view: memoryview) -> int:
        raise TypeError("it carries objects, not bytes")

    def try_recv_into(self, view: memoryview) -> int:
        return -1

    def try_send(self, buffers: Sequence[Any]) -> list[Any]:
        self.send(buffers)
        return []
