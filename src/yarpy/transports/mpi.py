"""MPI: a communicator of two programs, in which the sending port's program has rank 0.

    who dialled   opens a port of MPI, whose name it has told over TCP, and accepts
    who was       connects to it
    both          merge that into one communicator of two

Rules: bytes go as messages of any length with tag 0; where they are cut means nothing. MPI can only
be asked again and again whether something has come: less often the longer nothing does. It does not
tell that the other program has died. So two programs of yarpy keep the TCP connection on which they
met (`Line`); C++ closes it, and its death goes unnoticed.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, Final

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.log import readable
from yarpy.transports.base import MSG_DONTWAIT, Address
from yarpy.transports.mpi_library import HINT, Library, in_time, library
from yarpy.wire.framing import refused
from yarpy.wire.stream import Buffer

MEETING: Final = 10.0  # seconds for the two sides to meet
LEAVING: Final = 2.0  # seconds for the last message to leave
GLANCE: Final = 0.2  # seconds between looks whether the other side still lives
MOST: Final = 1 << 26  # bytes of a single message
_EAGER: Final = 1e-4  # seconds in which MPI is asked without a pause
_SHORTEST, _LONGEST = 20e-6, 2e-3  # seconds between questions
_HELLO: Final = b"\n"
_LINE: Final = 1000  # bytes that a peer may say instead
LATE: Final = 1.0  # seconds for the end of the line to have a good reason


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
            raise RemoteProtocolError("the peer hung up; it does not take this carrier")

    def settle(self) -> None:
        """Both have met: tell the other side that we keep the line."""
        self._since = 0.0
        if self._sock is not None:
            with suppress(OSError):  # C++ has closed it
                self._sock.sendall(_HELLO)

    @property
    def cut(self) -> bool:
        """Whether the other side, which had kept the line, has gone."""
        said = self._peek()
        if said and not self._kept and self._sock is not None:
            self._kept = self._sock.recv(len(_HELLO)) == _HELLO
            said = self._peek()
        if said == b"" and not self._kept:
            self.close()
        return said == b"" and self._kept

    def late(self) -> bool:
        """Whether a moment has passed since this was asked for the first time."""
        self._since = self._since or time.monotonic()
        return time.monotonic() - self._since > LATE

    def _peek(self) -> bytes | None:
        """What has come; None if nothing has, or nothing can."""
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


class Rest:
    """Pauses between questions, longer and longer."""

    def __init__(self) -> None:
        self._pause = 0.0
        self._eager = time.monotonic() + _EAGER

    def take(self, until: float | None = None) -> None:
        """Pause, but no longer than that. Raises BlockingIOError if it is over."""
        now = time.monotonic()
        if until is not None and now >= until:
            raise BlockingIOError
        if now > self._eager:
            self._pause = min(max(2 * self._pause, _SHORTEST), _LONGEST)
        time.sleep(self._pause if until is None else min(self._pause, until - now))


def open_mpi(listen: bool, sock: socket.socket | None, place: str) -> MpiTransport:
    """Our side of a connection that greeted over TCP; `place` is where the peer has said it is, if
    it dialled us. Raises LocalProtocolError where there is no MPI."""
    if sock is None:
        raise LocalProtocolError("mpi begins with a connection over TCP itself: take tcp")
    mpi = library()
    try:
        return MpiTransport(mpi, Line(sock), "" if listen else mpi.mpi.Open_port(), place)
    except mpi.mpi.Exception as error:
        raise explained(error) from error


def explained(error: Exception) -> LocalProtocolError:
    """What MPI says, and what may be the reason."""
    said = " ".join(str(error).split())
    return LocalProtocolError(f'MPI says "{said[:120]}"; {HINT}')


class MpiTransport:
    """Our end; connected once `ready` has returned."""

    port = 0

    def __init__(self, mpi: Library, line: Line, place: str, peers_place: str) -> None:
        self._library = mpi
        self._mpi = mpi.mpi
        self._line = line
        self.program = mpi.program
        self.place = place  # where MPI finds us
        self._peers_place = peers_place
        self._comm: Any = None
        self._other = 0
        self._going: Any = None  # a message that MPI has not sent yet, and its bytes
        self._bytes = b""
        self._came = memoryview(b"")  # of a message that was larger than what was asked for
        self._limit: float | None = None
        self._send_limit: float | None = None
        self._glance = 0.0
        self._interrupted = False
        self._lock = threading.Lock()  # nobody may ask a communicator that is being left

    # -- how the two meet -------------------------------------------------------------------------

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Enter one communicator with the peer."""
        try:
            comm = in_time(self._meet, MEETING, self._line.watch)
        except self._mpi.Exception as error:
            raise explained(error) from error
        except BaseException:
            self._library.lose()  # the thread is still in there
            raise
        if comm.Get_size() != 2:
            self._library.lose()
            raise RemoteProtocolError(f"{comm.Get_size()} programs of MPI came, and not two")
        self._comm, self._other = comm, 1 - comm.Get_rank()
        self._line.settle()

    def _meet(self) -> Any:
        alone = self._mpi.COMM_SELF.Dup()
        if self.place:
            between = alone.Accept(self.place)
            self._mpi.Close_port(self.place)
        else:
            between = alone.Connect(self._peers_place)
        between.Set_errhandler(self._mpi.ERRORS_RETURN)
        comm = between.Merge(not self.place)
        comm.Set_errhandler(self._mpi.ERRORS_RETURN)
        between.Disconnect()
        alone.Free()
        return comm

    # -- facts ------------------------------------------------------------------------------------

    @property
    def local(self) -> Address:
        return self._line.local

    @property
    def remote(self) -> Address:
        return self._line.remote

    def set_dscp(self, tos: int) -> None:
        raise LocalProtocolError("packets of MPI have no priority of ours; use tcp for that")

    def tos(self) -> int:
        return 0

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        return None

    def ended(self) -> bool:
        return self._interrupted or self._comm is None or self._line.cut

    def _look(self) -> bool:
        """Whether the peer has gone, asked now and then."""
        now = time.monotonic()
        if now < self._glance:
            return self._interrupted
        self._glance = now + GLANCE
        return self.ended()

    # -- reading ----------------------------------------------------------------------------------

    def recv_into(self, view: memoryview) -> int:
        until = None if self._limit is None else time.monotonic() + self._limit
        rest = Rest()
        while (count := self.try_recv_into(view)) < 0:
            if self._look():
                return max(self.try_recv_into(view), 0)
            rest.take(until)
        return count

    def try_recv_into(self, view: memoryview) -> int:
        if not self._came:
            with self._lock:
                comm = self._comm
                if self._interrupted or comm is None:
                    return 0
                try:
                    count = self._receive(comm, view)
                except self._mpi.Exception as error:
                    raise self._broken(error) from error
            if count or not self._came:
                return count or -1
        count = min(len(view), len(self._came))
        view[:count] = self._came[:count]
        self._came = self._came[count:]
        return count

    def _receive(self, comm: Any, view: memoryview) -> int:
        """The next message, into `view` if it is not larger, else aside."""
        status = self._mpi.Status()
        if not comm.Iprobe(self._other, 0, status):
            return 0
        size: int = status.Get_count(self._mpi.BYTE)
        whole = view if size <= len(view) else memoryview(bytearray(size))
        comm.Recv([whole, size, self._mpi.BYTE], self._other, 0)
        if whole is view:
            return size
        self._came = whole
        return 0

    # -- writing ----------------------------------------------------------------------------------

    def send(self, buffers: Sequence[Buffer]) -> None:
        until = None if self._send_limit is None else time.monotonic() + self._send_limit
        rest: Sequence[Buffer] = buffers
        while rest := self.try_send(rest):
            self._wait_sent(until)

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        if not self._sent():
            return list(buffers)
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
        if size:
            self._bytes = b"".join(taken)
            with self._lock:
                comm = self._comm
                if self._interrupted or comm is None:
                    raise BrokenPipeError("the connection is closed")
                try:
                    self._going = comm.Isend([self._bytes, self._mpi.BYTE], self._other, 0)
                except self._mpi.Exception as error:
                    raise self._broken(error) from error
            self._sent()
        return left

    def _sent(self) -> bool:
        """Whether MPI needs the bytes of the last message no longer."""
        with self._lock:
            if self._comm is None:
                raise BrokenPipeError("the connection is closed")
            if self._going is not None:
                try:
                    if not self._going.Test():
                        return False
                except self._mpi.Exception as error:
                    raise self._broken(error) from error
                self._going = None
        return True

    def _wait_sent(self, until: float | None) -> None:
        rest = Rest()
        while not self._sent():
            if self._look():
                raise ConnectionResetError("the peer has gone")
            rest.take(until)

    def wait_writable(self, seconds: float) -> bool:
        try:
            self._wait_sent(time.monotonic() + seconds)
        except BlockingIOError:
            return False
        except OSError:
            pass  # as sending tells
        return True

    def _broken(self, error: Exception) -> OSError:
        self._library.lose()
        return ConnectionResetError(f"MPI: {error}")

    # -- the end ----------------------------------------------------------------------------------

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._limit = seconds
        if sends:
            self._send_limit = seconds

    def interrupt(self) -> None:
        self._interrupted = True

    def close(self) -> None:
        with self._lock:
            comm, self._comm = self._comm, None
        if comm is not None:
            try:
                in_time(lambda: self._leave(comm), LEAVING, self._still_there)
            except (OSError, self._mpi.Exception):  # and what MPI still sends is never freed
                self._library.lose(self._going, self._bytes)
        self._line.close()

    def _leave(self, comm: Any) -> None:
        if self._going is not None:
            self._going.Wait()
        comm.Free()  # `Disconnect` waits for the peer, and under Open MPI 4.1 for ever

    def _still_there(self) -> None:
        if self._line.cut and self._line.late():  # else it has left a moment earlier
            raise ConnectionResetError("the peer has gone")
