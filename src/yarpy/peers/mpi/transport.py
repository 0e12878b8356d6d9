"""MPI: a communicator of two programs, in which the sending port's program has rank 0.

    who dialled   opens a port of MPI, whose name it has told over TCP, and accepts
    who was       connects to it
    both          merge that into one communicator of two

Rules: bytes go as messages of any length with tag 0; where they are cut means nothing. MPI can only
be asked again and again whether something has come: less often the longer nothing does.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeVar

from yarpy.errors import RemoteProtocolError
from yarpy.peers.mpi.end import LEAVING, MEETING, Line, MpiEnd, explained, pieces
from yarpy.peers.mpi.library import Library, in_time
from yarpy.wire.stream import Buffer

T = TypeVar("T")

GLANCE: Final = 0.2  # seconds between looks whether the other side still lives
_EAGER: Final = 1e-4  # seconds in which MPI is asked without a pause
_SHORTEST, _LONGEST = 20e-6, 2e-3  # seconds between questions


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


class MpiTransport(MpiEnd):
    """Our end; connected once `ready` has returned."""

    def __init__(self, library: Library, line: Line, place: str) -> None:
        super().__init__(library, line, place)
        self._comm: Any = None
        self._other = 0
        self._going: Any = None  # a message that MPI has not sent yet, and its bytes
        self._bytes = b""
        self._came = memoryview(b"")  # of a message that was larger than what was asked for
        self._glance = 0.0
        self._lock = threading.RLock()  # nobody may ask a communicator that is being left
        self._inside = False  # of MPI, perhaps in the frame beneath a signal handler

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
        if self._dialled:
            between = alone.Accept(self.place)
            self._mpi.Close_port(self.place)
        else:
            between = alone.Connect(self.place)
        between.Set_errhandler(self._mpi.ERRORS_RETURN)
        comm = between.Merge(not self._dialled)
        comm.Set_errhandler(self._mpi.ERRORS_RETURN)
        between.Disconnect()
        alone.Free()
        return comm

    # -- reading ----------------------------------------------------------------------------------

    def ended(self) -> bool:
        return self._interrupted or self._comm is None or self._line.cut

    def _look(self) -> bool:
        """Return whether the peer has gone; looks at most once in `GLANCE` seconds."""
        now = time.monotonic()
        if now < self._glance:
            return self._interrupted
        self._glance = now + GLANCE
        return self.ended()

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
                count = self._ask(lambda: self._receive(comm, view))
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
            if self.ended():  # else whoever waits for room would try again for ever
                raise ConnectionResetError("the peer has gone")
            return list(buffers)
        data, left = pieces(buffers)
        if data:
            self._bytes = data
            with self._lock:
                comm = self._comm
                if self._interrupted or comm is None:
                    raise BrokenPipeError("the connection is closed")
                self._going = self._ask(
                    lambda: comm.Isend([self._bytes, self._mpi.BYTE], self._other, 0)
                )
            self._sent()
        return left

    def _sent(self) -> bool:
        """Return whether MPI needs the bytes of the last message no longer."""
        with self._lock:
            if self._comm is None:
                raise BrokenPipeError("the connection is closed")
            if self._going is not None:
                if not self._ask(self._going.Test):
                    return False
                self._going = None
        return True

    def _ask(self, question: Callable[[], T]) -> T:
        """Ask MPI, under the lock."""
        self._inside = True
        try:
            return question()
        except self._mpi.Exception as error:
            raise self._broken(error) from error
        finally:
            self._inside = False

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

    def close(self) -> None:
        with self._lock:
            comm, self._comm = self._comm, None
            inside = self._inside
        if comm is not None and inside:
            self._library.lose(comm, self._going, self._bytes)  # the frame beneath still has it
        elif comm is not None:
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
