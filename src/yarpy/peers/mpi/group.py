"""One port's program and those of its readers in one communicator of MPI, for the carrier `bcast`.

    anything     int32 n from the sender, who has rank 0, then n bytes
    -1           somebody joins: all accept together
    -2           int32 length, then "READER<-SENDER" and a NUL: that one leaves, the others stay

Rules: what is sent reaches all or none, and MPI cannot be told to go on without one of them. When a
member dies, all connections of the group end, and are dialled again. A program of yarpy also gets a
byte over the TCP connection on which it met its sender for each thing sent: it need not ask MPI,
which takes a whole core, until something comes. C++ gives none, and wants none.
"""

from __future__ import annotations

import struct
import threading
from collections.abc import Callable
from typing import Any, Final

from yarpy.errors import RemoteProtocolError
from yarpy.limit import MPI_NAME
from yarpy.peers.mpi.end import LEAVING, MEETING, Line
from yarpy.peers.mpi.library import Library, in_time

JOIN: Final = -1
LEAVE: Final = -2
_NUMBER: Final = struct.Struct("=i")


class Member:
    """This program in one group. One thread at a time; what fails leaves it of no use."""

    def __init__(self, library: Library) -> None:
        self.mpi = library.mpi
        self._library = library
        self._comm: Any = library.mpi.COMM_SELF.Dup()

    @property
    def size(self) -> int:
        """The number of programs, with this one."""
        count: int = self._comm.Get_size()
        return count

    def number(self, value: int = 0) -> int:
        """Send a number, or get one."""
        held = bytearray(_NUMBER.pack(value))
        self._comm.Bcast([held, 1, self.mpi.INT], 0)
        found: int = _NUMBER.unpack(held)[0]
        return found

    def payload(self, held: bytearray | bytes) -> None:
        """Send these bytes, or get as many."""
        self._comm.Bcast([held, len(held), self.mpi.BYTE], 0)

    def accept(self, place: str = "") -> None:
        """Let somebody in, all together; the sender has told it the `place`."""
        self._enter(self._comm.Accept(place, self.mpi.INFO_NULL, 0), high=False)

    def connect(self, place: str) -> None:
        """Get in."""
        self._enter(self._comm.Connect(place), high=True)

    def _enter(self, between: Any, high: bool) -> None:
        between.Set_errhandler(self.mpi.ERRORS_RETURN)
        comm = between.Merge(high)
        comm.Set_errhandler(self.mpi.ERRORS_RETURN)
        between.Disconnect()
        self._comm.Free()
        self._comm = comm

    def part(self, leaves: bool) -> None:
        """Somebody leaves: perhaps this one."""
        comm = self._comm.Split(int(leaves), self._comm.Get_rank())
        self._comm.Free()
        self._comm = comm

    def leave(self) -> None:
        """Alone again: give the communicator back."""
        self._comm.Free()

    def lose(self, *kept: object) -> None:
        """A member has died, or a thread is stuck in MPI."""
        self._library.lose(*kept)


class Group:
    """The state that the connections of a sending port share: one of them sends for all."""

    def __init__(self, library: Library) -> None:
        self._member = Member(library)
        self.broken = False
        self._lock = threading.Lock()  # MPI does one thing at a time here
        self._changed = threading.Condition()
        self._data: bytes | None = None  # on its way, or about to be
        self._thread: threading.Thread | None = None
        self._lines: list[Line] = []

    @property
    def size(self) -> int:
        """The number of readers."""
        return len(self._lines)

    def join(self, place: str, line: Line) -> None:
        """Take a reader in. Raises an exception of MPI, TimeoutError, RemoteProtocolError."""

        def act() -> None:
            with self._lock:
                if self._lines:
                    self._ring()
                    self._member.number(JOIN)
                self._member.accept(place)
                line.settle()
                self._lines.append(line)

        self._do(act, MEETING, line.watch)

    def leave(self, pair: str, line: Line) -> None:
        """Let one reader go, once it has all. Raises an exception of MPI, TimeoutError."""
        if not self.wait_sent(LEAVING):
            self.lose()
            raise TimeoutError("a reader takes nothing")

        def act() -> None:
            with self._lock:
                self._ring()
                told = pair.encode() + b"\0"
                self._member.number(LEAVE)
                self._member.number(len(told))
                self._member.payload(told)
                self._member.part(False)
                self._lines.remove(line)
                if not self._lines:
                    self._member.leave()

        self._do(act, LEAVING, None)
        if not self._lines:
            self.fail()  # it is of no more use

    def offer(self, data: bytes) -> bool:
        """Send bytes to all, in a thread of its own; False if it is still busy."""
        with self._changed:
            if self.broken:
                raise BrokenPipeError("the connections of that port through MPI have ended")
            if self._data is not None:
                return False
            self._data = data
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="yarpy bcast", daemon=True)
                self._thread.start()
            self._changed.notify_all()
        return True

    def wait_sent(self, seconds: float) -> bool:
        """Wait at most so many seconds; return whether all has been sent, or cannot be any more."""
        with self._changed:
            return self._changed.wait_for(lambda: self._data is None or self.broken, seconds)

    def fail(self) -> None:
        """End all connections."""
        with self._changed:
            self.broken = True
            self._changed.notify_all()

    def lose(self) -> None:
        """MPI will not come back from this group: a member has died, say."""
        if not self.broken:
            self._member.lose(self._data)
            self.fail()

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._data is not None or self.broken)
                data = self._data
            if data is None or self.broken:
                return
            try:
                with self._lock:
                    self._ring()
                    self._member.number(len(data))
                    self._member.payload(data)
            except Exception:  # of MPI
                self.lose()
            with self._changed:
                self._data = None
                self._changed.notify_all()

    def _ring(self) -> None:
        for line in self._lines:
            line.ring()

    def _do(
        self, act: Callable[[], None], seconds: float, look: Callable[[], object] | None
    ) -> None:
        try:
            in_time(act, seconds, look)
        except BaseException:
            self.lose()
            raise


def follow(
    member: Member, name: str, limit: int, take: Callable[[bytes], None], wait: Callable[[], None]
) -> None:
    """As a reader: `take` what comes, until the sender lets this one go. `wait` comes back when
    something may have been sent. Raises RemoteProtocolError, an exception of MPI."""
    while True:
        wait()
        number = member.number()
        if number == JOIN:
            member.accept()
        elif number == LEAVE:
            length = member.number()
            if not 0 < length <= MPI_NAME:
                raise RemoteProtocolError(f"a name of {length} bytes is to leave")
            told = bytearray(length)
            member.payload(told)
            mine = told.rstrip(b"\0") == name.encode()
            member.part(mine)
            if mine:
                member.leave()
                return
        elif not 0 <= number <= limit:
            raise RemoteProtocolError(f"{number} bytes are sent at once; the limit is {limit}")
        else:
            came = bytearray(number)
            member.payload(came)
            take(bytes(came))
