"""Waiting for sockets of a system that cannot be told, by a call, not to wait (Windows).

Rules: there the socket itself never waits, and every wait is one by select. A receive timeout of
the kernel (SO_RCVTIMEO) would not do: after one that is over, Windows says nothing certain about
the socket any more, and its error is that of a peer whose host is dead; and a send that waits keeps
its thread until the last byte has gone. Select does not see a shutdown of this side, so waits come
in slices and ask for it. Nobody closes a socket while another thread shuts it down: its number may
be another socket's by then, and the server of wine 8 ends.
"""

from __future__ import annotations

import errno
import select
import socket
import threading
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import Any, Final, TypeVar

from yarpy.wire.stream import Buffer

T = TypeVar("T")
SLICE: Final = 0.25  # seconds


class Polling:
    """The waits of one socket. `receiving`, `sending`: the seconds that each takes at most; None:
    for ever."""

    def __init__(self, sock: socket.socket) -> None:
        self._sock = sock
        self.receiving: float | None = None
        self.sending: float | None = None
        self.shut = False  # this side was shut down: nobody is to wait any more
        self._ending = threading.RLock()  # a signal handler may interrupt who closes

    def interrupt(self) -> None:
        """Shut both directions down, which ends all waits."""
        self.shut = True
        with self._ending, suppress(OSError):  # not connected any more, or closed
            self._sock.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Close the socket, as soon as nobody is shutting it down."""
        with self._ending:
            self._sock.close()

    def recv_into(self, view: memoryview) -> int:
        """Return the size of what has come into `view`; 0: the end, also by our own shutdown.
        Raises as `receive`."""
        try:
            return self.receive(self._sock.recv_into, view)
        except OSError as error:
            if self.shut and error.errno == errno.ESHUTDOWN:
                return 0
            raise

    def receive(self, call: Callable[..., T], *arguments: Any) -> T:
        """Return call(*arguments), which reads from the socket, as soon as there is something.
        Raises BlockingIOError when the time is over, and what the call raises."""
        return self._patiently(call, arguments, self.receiving, reads=True)

    def send(self, call: Callable[..., T], *arguments: Any) -> T:
        """Return call(*arguments), which writes to the socket, as soon as there is room. Raises as
        `receive`."""
        return self._patiently(call, arguments, self.sending, reads=False)

    def send_all(self, buffers: Iterable[Buffer]) -> None:
        """Send everything. Raises OSError; BlockingIOError when nothing left for so long."""
        for buffer in buffers:
            view = memoryview(buffer).cast("B")
            while view:
                view = view[self.send(self._sock.send, view) :]

    def _patiently(
        self, call: Callable[..., T], arguments: tuple[Any, ...], limit: float | None, reads: bool
    ) -> T:
        until = None if limit is None else time.monotonic() + limit
        while True:
            try:
                return call(*arguments)
            except BlockingIOError:
                left = SLICE if until is None else until - time.monotonic()
                if left <= 0.0:
                    raise
            self.wait(reads, left)

    def wait(self, reads: bool, seconds: float) -> bool:
        """Wait until something can be read, or sent, or an error is to be had; False if the time is
        over."""
        until = time.monotonic() + seconds
        while True:
            number = self._sock.fileno()
            if self.shut or number < 0:  # as the next call tells
                return True
            left, mine = until - time.monotonic(), [number]
            reading, writing = (mine, []) if reads else ([], mine)
            try:
                if any(select.select(reading, writing, [], min(SLICE, max(0.0, left)))):
                    return True
            except OSError:
                return True  # closed meanwhile
            if left <= SLICE:
                return False
