"""In-process pipes: Python objects handed from thread to thread.

Rules: two ends meet by the pair of TCP port numbers over which they were introduced. Only ends of
this process are in the meeting place, so a stranger's greeting finds nobody.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from queue import Empty
from typing import Any

from yarpy import fork
from yarpy.errors import RemoteProtocolError
from yarpy.platform.timed_queue import TimedQueue
from yarpy.scope import Flag
from yarpy.transports.base import Address, ObjectTransport, Transport
from yarpy.transports.opener import MeetingPlace, Opener

TIMEOUT = 5.0  # seconds for the two ends to meet
LOOK = 0.01  # seconds between checks whether the other end will still come
_END = object()


class Meeting:
    """The ends that wait for each other; one such table per process."""

    def __init__(self) -> None:
        self._waiting: dict[tuple[int, int], InprocTransport] = {}
        self._lock = fork.lock()  # initiator and acceptor are different threads

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

    scheme = "inproc"
    whole = True

    def __init__(self, local: Address, remote: Address) -> None:
        self._local = local
        self._remote = remote
        self._inbox: TimedQueue[object] = TimedQueue()
        self._came: list[object] = []  # taken out of it, and not handed on yet
        self._peer: InprocTransport | None = None
        self._timeout: float | None = None
        self._over = False  # nothing more is taken from the peer, but what it has sent by then
        self._gone = False  # nobody reads any more what comes now
        self._joined = Flag()

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
        deadline = time.monotonic() + TIMEOUT
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
        came = self._came
        try:
            if not came:
                self._inbox.take(came, self._timeout if wait else 0.0)
        except Empty:
            raise BlockingIOError("nothing has come") from None
        if came[0] is _END:  # which stays, as long as this end does
            self._gone = True
            while len(came) < 2 or came[1] is _END:
                del came[1:]
                try:
                    self._inbox.take(came, 0.0)
                except Empty:
                    return None
        item = (came[-1],)
        del came[-1:]
        return item

    def send(self, buffers: Sequence[Any]) -> None:
        peer = self._peer
        if peer is None or peer._over or self._over:
            raise BrokenPipeError("the other end is closed")
        for item in buffers:
            peer._inbox.put(item)
            # Its reader may have found the end just before; else it finds this.
            if peer._gone and peer._withdraw(item):
                raise BrokenPipeError("the other end is closed")

    def _withdraw(self, item: object) -> bool:
        """Take back what came too late; return whether nobody has read it."""
        left = self._empty()
        return any(one is item for one in left)

    def _empty(self) -> list[object]:
        """Take what nobody has read: each object is taken once, whoever looks for it."""
        left: list[object] = []
        try:
            while True:
                left.append(self._inbox.get_nowait())
        except Empty:
            return [one for one in left if one is not _END]

    def unread(self) -> list[object]:
        left = [one for one in self._came if one is not _END]
        self._came[:] = [_END]
        return left + self._empty()

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._timeout = seconds

    def ended(self) -> bool:
        return self._peer is not None and self._peer._over

    def interrupt(self) -> None:
        self._over = True
        self._inbox.put(_END)

    def close(self) -> None:
        self._over = self._gone = True
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


class Inproc(Opener):
    """Objects handed from thread to thread."""

    name = "inproc"
    meets = False
    stays = True

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport:
        through = place.through
        return open_inproc(place.listen, through.local, through.remote)
