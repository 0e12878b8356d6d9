"""The MPI library of this computer, begun when it is first needed and ended with the program.

Rules: only where the owner of the program has asked for it (`YARPY_MPI=yes`, or a program that has
begun MPI itself), since MPI trusts whatever a peer says, and opens ports of its own to the network.
Several threads use it, as they like. What blocks for ever inside MPI cannot be woken, so it has a
thread of its own that nobody has to wait for (`in_time`). Who has lost a peer must not end MPI in
good order, which would wait for that peer: then it is left as it is.
"""

from __future__ import annotations

import atexit
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, Final, TypeVar

from yarpy.errors import LocalProtocolError

T = TypeVar("T")

SETTING: Final = "YARPY_MPI"
ENDING: Final = 5.0  # seconds that the end may take
HINT: Final = (
    "both programs take the same MPI library: that of `pip install mpich`, each started by "
    "`mpiexec -n 1`, or Debian's openmpi-bin with MPI4PY_MPIABI=openmpi and an ompi-server "
    "(the page about carriers says how)"
)
_LOOK: Final = 0.01  # seconds between looks whether a thread has come back


class Library:
    """MPI, as this program has it: `mpi` is mpi4py's module."""

    def __init__(self) -> None:
        self.mpi: Any = _import()
        self.own = not self.mpi.Is_initialized()
        self._lost: list[Any] = []
        if self.own:
            self.mpi.Init_thread(self.mpi.THREAD_MULTIPLE)
        if self.mpi.Query_thread() < self.mpi.THREAD_MULTIPLE:
            raise LocalProtocolError(
                "MPI was begun for a single thread: before `from mpi4py import MPI` put "
                "`mpi4py.rc.threads = True`, or let yarpy begin it"
            )
        # As in C++, to find out whether two ports are of one program.
        self.program = f"{self.mpi.Get_processor_name()}____pid____{os.getpid()}"
        if self.own:
            atexit.register(self._end)

    def lose(self, *kept: Any) -> None:
        """A peer has gone without leaving; MPI may still look at what is `kept` for ever."""
        self._lost += [None, *kept]

    def _end(self) -> None:
        """Leave MPI, in good order if that does not mean waiting for somebody who has gone."""
        if not self._lost:
            in_time(self.mpi.Finalize, ENDING)


_lock = threading.RLock()
_library: Library | None = None


def library() -> Library:
    """The library. Raises LocalProtocolError, which says what is to be set or installed."""
    global _library
    with _lock:
        permit()
        if _library is None:
            _library = Library()
        return _library


def permit() -> None:
    """Raise LocalProtocolError, which says what the owner is to set, where MPI is off."""
    if not allowed():
        raise LocalProtocolError(
            "MPI is off in this program, since whoever speaks to it by MPI can end it: its "
            f"owner starts it with {SETTING}=yes; or take tcp"
        )


def allowed() -> bool:
    """Return whether the owner has asked for MPI: by the setting, or by starting it in the
    program."""
    if os.environ.get(SETTING, "") == "yes":
        return True
    begun = sys.modules.get("mpi4py.MPI")
    ours = _library is not None and _library.own
    return begun is not None and not ours and bool(begun.Is_initialized())


def _import() -> Any:
    try:
        import mpi4py
    except ImportError as error:
        raise LocalProtocolError(
            f'mpi and bcast need mpi4py ({error}): `pip install "yarpy[mpi]"`'
        ) from error
    mpi4py.rc.initialize = False  # not by importing it
    mpi4py.rc.finalize = False
    try:
        from mpi4py import MPI
    except (ImportError, RuntimeError) as error:
        raise LocalProtocolError(f"no MPI library can be loaded ({error}): {HINT}") from error
    return MPI


def in_time(action: Callable[[], T], seconds: float, look: Callable[[], object] | None = None) -> T:
    """Run `action` in a thread of its own and return its result, calling `look` meanwhile. Raises
    what either of them raises, and TimeoutError after so many seconds; the thread is then left to
    itself."""
    found: list[T] = []
    failed: list[BaseException] = []

    def act() -> None:
        try:
            found.append(action())
        except BaseException as error:
            failed.append(error)

    thread = threading.Thread(target=act, name="yarpy MPI", daemon=True)
    thread.start()
    deadline = time.monotonic() + seconds
    while True:
        thread.join(_LOOK)
        if found:
            return found[0]
        if failed:
            raise failed[0]
        if time.monotonic() > deadline:
            raise TimeoutError("MPI does not come back")
        if look is not None:
            look()
