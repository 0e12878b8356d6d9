"""MPI without MPI: communicators of one program's threads, as far as the carriers use them.

    hall = Hall()
    sender, reader = FakeLibrary(hall), FakeLibrary(hall)

What one sends to all lies in a queue for each of the others.
"""

import queue
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from support.wait import HANG


class Failed(Exception):
    """What MPI raises."""


class Hall:
    """Where they meet: by the names of places."""

    def __init__(self) -> None:
        self.doors: dict[str, queue.Queue[FakeComm]] = {}

    def door(self, place: str) -> "queue.Queue[FakeComm]":
        return self.doors.setdefault(place, queue.Queue())


class FakeComm:
    """One member of a group; `failing` raises."""

    def __init__(self, hall: Hall) -> None:
        self.hall = hall
        self.group = [self]
        self.inbox: queue.Queue[Any] = queue.Queue()
        self.failing = False
        self.freed = 0

    def Dup(self) -> "FakeComm":  # noqa: N802
        return FakeComm(self.hall)

    def Get_size(self) -> int:  # noqa: N802
        return len(self.group)

    def Get_rank(self) -> int:  # noqa: N802
        return self.group.index(self)

    def Set_errhandler(self, handler: object) -> None:  # noqa: N802
        pass

    def Bcast(self, what: list[Any], root: int) -> None:  # noqa: N802
        held = what[0]
        if self.failing:
            raise Failed("broken")
        if self.Get_rank() == root:
            for other in self.group:
                if other is not self:
                    other.inbox.put(bytes(held))
        else:
            came = self.inbox.get(timeout=HANG)
            if isinstance(came, Exception):
                raise came
            assert len(came) == len(held)
            held[:] = came

    def Accept(self, place: str, info: object = None, root: int = 0) -> Any:  # noqa: N802
        if self.Get_rank() == root:
            new = self.hall.door(place).get(timeout=HANG)
            for other in self.group[1:]:
                other.inbox.put("accepted")
            new.group = self.group
            self.group.append(new)
            new.inbox.put("accepted")
        else:
            assert self.inbox.get(timeout=HANG) == "accepted"
        return self._between(high=False)

    def Connect(self, place: str) -> Any:  # noqa: N802
        self.hall.door(place).put(self)
        assert self.inbox.get(timeout=HANG) == "accepted"
        return self._between(high=True)

    def _between(self, high: bool) -> SimpleNamespace:
        def merge(asked: bool) -> FakeComm:
            assert asked == high
            return self

        return SimpleNamespace(
            Set_errhandler=lambda handler: None, Merge=merge, Disconnect=lambda: None
        )

    def Split(self, colour: int, rank: int) -> "FakeComm":  # noqa: N802
        assert rank == self.Get_rank() or colour
        if colour:
            self.group.remove(self)
            self.group = [self]
        return self

    def Free(self) -> None:  # noqa: N802
        self.freed += 1


class FakeLibrary:
    """As `mpi_library.Library`. `closed`: ports of MPI that were closed."""

    def __init__(self, hall: Hall, program: str = "vm____pid____1") -> None:
        self.program = program
        self.lost = 0
        self.closed: list[str] = []
        self.places = (f"place {number}" for number in range(100))
        open_port: Callable[[], str] = lambda: next(self.places)  # noqa: E731
        self.mpi = SimpleNamespace(
            COMM_SELF=FakeComm(hall),
            Exception=Failed,
            ERRORS_RETURN=None,
            INFO_NULL=None,
            INT=None,
            BYTE=None,
            Open_port=open_port,
            Close_port=self.closed.append,
        )

    def lose(self, *kept: object) -> None:
        self.lost += 1
