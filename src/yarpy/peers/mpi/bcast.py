"""bcast: the ends of connections whose messages go to all readers of a port at once (`mpi_group`).

Rules: a port's first connection sends for the others, and each one joins and leaves by itself. A
reader has a thread that follows its sender: into MPI, where nothing wakes it, it goes when the
sender rings on the TCP connection on which they met. C++ does not ring: then it waits in there.
"""

from __future__ import annotations

import socket
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import Final

from yarpy.errors import LocalProtocolError, YarpError
from yarpy.peers.mpi.end import MEETING, Line, MpiEnd, explained, pieces
from yarpy.peers.mpi.group import Group, Member, follow
from yarpy.peers.mpi.library import SETTING, Library, in_time, library
from yarpy.peers.mpi.meeting import Meeting
from yarpy.peers.mpi.transport import MpiTransport
from yarpy.transports.base import Transport
from yarpy.transports.opener import MeetingPlace, Opener
from yarpy.wire import framing
from yarpy.wire.stream import DEFAULT_LIMIT, Buffer

GLANCE: Final = 0.2  # seconds between looks whether the other side still lives
HESITATION: Final = 0.3  # seconds in which a new reader may still refuse
RINGING: Final = 2.0  # seconds in which a sender that rings has said so
AHEAD: Final = 1 << 22  # bytes that a reader may be behind; a single piece may be larger
_GOODBYE: Final = framing.encode_command("q")  # what leaving in good order means

_groups: dict[str, Group] = {}  # by the name of the sending port
_lock = threading.RLock()


def open_mpi(kind: str, listen: bool, sock: socket.socket | None, pair: str) -> End | Meeting:
    """Our side of a connection that greeted over TCP, of the carrier `kind`; `pair` is who reads
    from whom. Who was dialled meets the peer in a helper. Raises LocalProtocolError where there is
    no MPI."""
    if sock is None:
        raise LocalProtocolError(f"{kind} begins with a connection over TCP itself: take tcp")
    return Meeting(kind, sock, pair) if listen else open_end(kind, listen, sock, pair)


def open_end(kind: str, listen: bool, sock: socket.socket, pair: str) -> End:
    """An end in this process. Raises LocalProtocolError where there is no MPI."""
    mpi = library()
    try:
        place = "" if listen else mpi.mpi.Open_port()
        if kind == "mpi":
            return MpiTransport(mpi, Line(sock), place)
        return (BcastReader if listen else BcastSender)(mpi, Line(sock), place, pair)
    except mpi.mpi.Exception as error:
        raise explained(error) from error


class BcastSender(MpiEnd):
    """The sender's end of one connection; connected once `ready` has returned."""

    def __init__(self, library: Library, line: Line, place: str, pair: str) -> None:
        super().__init__(library, line, place)
        self._pair = pair
        self._group: Group | None = None

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Let the peer into the group. Once the others wait for it, they cannot do without it, so
        it first has a moment to refuse."""
        with _lock:
            name = self._pair.rpartition("<-")[2]
            group = _groups.get(name)
            if group is None or group.broken:
                group = _groups[name] = self._made()
            until = time.monotonic() + (HESITATION if group.size else 0.0)
            while time.monotonic() < until:
                self._line.watch()
                time.sleep(0.01)
            try:
                group.join(self.place, self._line)
                self._mpi.Close_port(self.place)
            except self._mpi.Exception as error:
                raise explained(error) from error
            self._group = group

    def _made(self) -> Group:
        try:
            return Group(self._library)
        except self._mpi.Exception as error:
            raise explained(error) from error

    def ended(self) -> bool:
        group = self._group
        if group is None or group.broken or self._interrupted:
            return True
        if self._line.cut:
            group.lose()  # MPI does not go on without a member
            return True
        return False

    def recv_into(self, view: memoryview) -> int:
        until = None if self._limit is None else time.monotonic() + self._limit
        while not self.ended():
            if until is not None and time.monotonic() > until:
                raise BlockingIOError
            time.sleep(GLANCE)
        return 0

    def try_recv_into(self, view: memoryview) -> int:
        return 0 if self.ended() else -1  # nothing comes back

    def send(self, buffers: Sequence[Buffer]) -> None:
        until = None if self._send_limit is None else time.monotonic() + self._send_limit
        rest: Sequence[Buffer] = buffers
        while rest := self.try_send(rest):
            left = GLANCE if until is None else min(until - time.monotonic(), GLANCE)
            if left <= 0:
                raise BlockingIOError
            self.wait_writable(left)

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        group = self._group
        if group is None or self._interrupted:
            raise BrokenPipeError("the connection is closed")
        data, left = pieces(buffers)
        if data and not group.offer(data):
            return list(buffers)
        return left

    def wait_writable(self, seconds: float) -> bool:
        group = self._group
        return group is None or group.wait_sent(seconds) or self.ended()

    def close(self) -> None:
        group, self._group = self._group, None
        if group is not None and not group.broken:
            if self._line.cut:
                group.lose()
            else:
                try:
                    group.leave(self._pair, self._line)
                except (OSError, self._mpi.Exception):
                    pass  # all of them end
        self._line.close()


class BcastReader(MpiEnd):
    """A reader's end; connected once `ready` has returned."""

    def __init__(self, library: Library, line: Line, place: str, pair: str) -> None:
        super().__init__(library, line, place)
        self._pair = pair
        self._changed = threading.Condition()
        self._came: deque[memoryview] = deque()
        self._held = 0
        self._thread: threading.Thread | None = None
        self._rings: bool | None = None  # the sender says that it does
        self._ended = self._closed = False

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Get into the group of the peer."""
        try:
            member = Member(self._library)
            in_time(lambda: member.connect(self.place), MEETING, self._line.watch)
        except self._mpi.Exception as error:
            raise explained(error) from error
        except BaseException:
            self._library.lose()
            raise
        self._line.settle()
        self._thread = threading.Thread(
            target=self._run, args=(member,), name=f"yarpy {self._pair}", daemon=True
        )
        self._thread.start()

    def _run(self, member: Member) -> None:
        try:
            follow(member, self._pair, DEFAULT_LIMIT, self._take, self._wait)
            self._take(_GOODBYE)
        except (YarpError, OSError, self._mpi.Exception):
            member.lose()
        with self._changed:
            self._ended = True
            self._changed.notify_all()
        self._line.close()

    def _take(self, data: bytes) -> None:
        with self._changed:
            self._changed.wait_for(lambda: self._held < AHEAD or self._closed)
            if not self._closed:
                self._came.append(memoryview(data))
                self._held += len(data)
                self._changed.notify_all()

    def _wait(self) -> None:
        """Wait until the sender rings. Raises ConnectionResetError once it has died."""
        if self._rings is None:
            self._rings = bool(self._line.hear(RINGING))
        while self._rings:
            heard = self._line.hear(GLANCE)
            if heard:
                return
            if heard == b"":
                raise ConnectionResetError("the sender has gone")

    def ended(self) -> bool:
        return self._thread is None or self._interrupted or (self._ended and not self._came)

    def recv_into(self, view: memoryview) -> int:
        until = None if self._limit is None else time.monotonic() + self._limit
        while (count := self.try_recv_into(view)) < 0:
            left = GLANCE if until is None else min(until - time.monotonic(), GLANCE)
            if left <= 0:
                raise BlockingIOError
            with self._changed:
                self._changed.wait_for(lambda: self._came or self.ended(), left)
        return count

    def try_recv_into(self, view: memoryview) -> int:
        if self._interrupted:
            return 0
        with self._changed:
            if not self._came:
                return 0 if self.ended() else -1
            first = self._came[0]
            count = min(len(first), len(view))
            view[:count] = first[:count]
            if count < len(first):
                self._came[0] = first[count:]
            else:
                self._came.popleft()
            self._held -= count
            self._changed.notify_all()
        return count

    def send(self, buffers: Sequence[Buffer]) -> None:
        """Nothing goes that way."""

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        return []

    def wait_writable(self, seconds: float) -> bool:
        return True

    def wait_left(self) -> None:
        """Wait until the sender has let this one go, or has died."""
        if self._thread is not None:
            self._thread.join()

    def close(self) -> None:
        """Its thread goes on until the sender lets it go: the others need it in the group."""
        with self._changed:
            self._closed = True
            self._came.clear()
            alive = self._thread is not None and not self._ended
            self._changed.notify_all()
        if alive:
            self._library.lose()
        if self._thread is None:
            self._line.close()


End = MpiTransport | BcastSender | BcastReader


class MpiOpener(Opener):
    """One reader by MPI."""

    name = "mpi"
    title = "MPI"
    setting = SETTING
    meets = False

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport:
        return open_mpi(cls.name, place.listen, place.through.sock, place.group)


class BcastOpener(MpiOpener):
    """All readers of a port at once."""

    name = "bcast"
