"""In-process pipes: Python objects handed from thread to thread.

Rules: two ends meet by the pair of TCP port numbers over which they were introduced. Only ends of
this process are in the meeting place, so a stranger's greeting finds nobody.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from queue import Empty, SimpleQueue
from typing import Any

from yarpy.errors import RemoteProtocolError
from yarpy.transports.base import Address, ObjectTransport

PATIENCE = 5.0  # seconds for the two ends to meet
LOOK = 0.01  # seconds between checks whether the other end will still come
_END = object()


class Meeting:
    """Where ends wait for each other; one per process."""

    def __init__(self) -> None:
        self._waiting: dict[tuple[int, int], InprocTransport] = {}
        self._lock = threading.Lock()  # initiator and acceptor are different threads

    def leave(self, key: tuple[int, int], end: InprocTransport) -> None:
        """Wait here for the other side."""
        with self._lock:
            self._waiting[key] = end

    def find(self, key: tuple[int, int]) -> InprocTransport | None:
        """The end that waits under `key`, once."""
        with self._lock:
            return self._waiting.pop(key, None)


MEETING = Meeting()


class InprocTransport(ObjectTransport):
    """One end of a pipe of objects."""

    def __init__(self, local: Address, remote: Address) -> None:
        self._local = local
        self._remote = remote
        self._inbox: SimpleQueue[object] = SimpleQueue()
        self._peer: InprocTransport | None = None
        self._timeout: float | None = None
        self._ended = False
        self._joined = threading.Event()

    @property
    def local(self) -> Address:
        return self._local

    @property
    def remote(self) -> Address:
        return self._remote

    def join(self, peer: InprocTransport) -> None:
        """Become the two ends of one pipe."""
        self._peer, peer._peer = peer, self
        self._joined.set()
        peer._joined.set()

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Wait until the other end has come. Raises TimeoutError if it does not."""
        deadline = time.monotonic() + PATIENCE
        try:
            while not self._joined.wait(LOOK):
                if time.monotonic() > deadline:
                    raise TimeoutError(
                        "no port of this process answered; the carrier local needs one"
                    )
                if look is not None:
                    look()
        except BaseException:
            MEETING.find((self.local[1], self.remote[1]))
            raise

    def receive(self, wait: bool = True) -> tuple[object] | None:
        try:
            item = self._inbox.get(wait, self._timeout)
        except Empty:
            raise BlockingIOError("nothing has come") from None
        if item is _END:
            self._inbox.put(_END)
            return None
        return (item,)

    def send(self, buffers: Sequence[Any]) -> None:
        peer = self._peer
        if peer is None or peer._ended or self._ended:
            raise BrokenPipeError("the other end is closed")
        for item in buffers:
            peer._inbox.put(item)

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._timeout = seconds

    def ended(self) -> bool:
        return self._peer is not None and self._peer._ended

    def interrupt(self) -> None:
        self._inbox.put(_END)

    def close(self) -> None:
        if not self._ended:
            self._ended = True
            if self._peer is not None:
                self._peer._inbox.put(_END)


def open_inproc(listen: bool, local: Address, remote: Address) -> InprocTransport:
    """Our end of a pipe; the initiator waits in the meeting place, the acceptor finds it there."""
    end = InprocTransport(local, remote)
    if not listen:
        MEETING.leave((local[1], remote[1]), end)
        return end
    peer = MEETING.find((remote[1], local[1]))
    if peer is None:
        raise RemoteProtocolError("the carrier local joins ports of one process; use unix_stream")
    end.join(peer)
    return end
