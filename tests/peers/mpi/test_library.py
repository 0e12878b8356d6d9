"""The MPI library: what a user is told where it is missing, and who waits for it how long."""

from __future__ import annotations

import sys
import threading
from types import ModuleType, SimpleNamespace

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.peers.mpi import library as mpi_library
from yarpy.peers.mpi.library import Library, in_time


def pretend(monkeypatch: pytest.MonkeyPatch, mpi: object) -> SimpleNamespace:
    """mpi4py with this in the place of MPI, or without any if it is an exception."""

    class Package(ModuleType):
        rc = SimpleNamespace(initialize=True, finalize=None)

        def __getattr__(self, name: str) -> object:
            if name != "MPI" or isinstance(mpi, Exception):
                raise mpi if isinstance(mpi, Exception) else AttributeError(name)
            return mpi

    package = Package("mpi4py")
    monkeypatch.setitem(sys.modules, "mpi4py", package)
    monkeypatch.setattr(mpi_library.atexit, "register", lambda end: ended.append(end))
    ended.clear()
    return package.rc


ended: list[object] = []


def mpi(initialized: bool = False, thread: int = 3) -> SimpleNamespace:
    calls: list[object] = []
    return SimpleNamespace(
        THREAD_MULTIPLE=3,
        Is_initialized=lambda: initialized,
        Init_thread=calls.append,
        Query_thread=lambda: thread,
        Get_processor_name=lambda: "vm",
        Finalize=lambda: calls.append("end"),
        calls=calls,
    )


def test_begun_for_many_threads_and_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    module = mpi()
    rc = pretend(monkeypatch, module)
    library = Library()
    assert (rc.initialize, rc.finalize) == (False, False)
    assert library.program.startswith("vm____pid____")
    library._end()
    assert module.calls == [3, "end"]
    assert len(ended) == 1


def test_who_has_lost_a_peer_does_not_wait_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    module = mpi()
    pretend(monkeypatch, module)
    library = Library()
    library.lose()
    library._end()
    assert "end" not in module.calls


def test_begun_by_the_program_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    module = mpi(initialized=True)
    pretend(monkeypatch, module)
    Library()
    assert (module.calls, ended) == ([], [])


def test_begun_for_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(monkeypatch, mpi(initialized=True, thread=1))
    with pytest.raises(LocalProtocolError, match="single thread"):
        Library()


def test_without_mpi4py(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MPI", "yes")
    monkeypatch.setitem(sys.modules, "mpi4py", None)
    monkeypatch.setattr(mpi_library, "_library", None)
    with pytest.raises(LocalProtocolError, match=r"pip install \"yarpy\[mpi\]\""):
        mpi_library.library()


def test_without_an_mpi_library(monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(monkeypatch, ImportError("libmpi.so.12: cannot open shared object file"))
    with pytest.raises(LocalProtocolError, match=r"libmpi.so.12.*openmpi-bin"):
        Library()


def test_the_library_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MPI", "yes")
    pretend(monkeypatch, mpi())
    monkeypatch.setattr(mpi_library, "_library", None)
    assert mpi_library.library() is mpi_library.library()


@pytest.mark.parametrize("setting", ["", "no", "1"])
def test_off_unless_the_owner_asks_for_it(setting: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MPI", setting)
    monkeypatch.setattr(mpi_library, "_library", None)
    monkeypatch.delitem(sys.modules, "mpi4py.MPI", raising=False)
    pretend(monkeypatch, ZeroDivisionError("MPI was loaded"))
    with pytest.raises(LocalProtocolError, match="YARPY_MPI=yes"):
        mpi_library.library()


@pytest.mark.parametrize(("begun", "takes"), [(True, True), (False, False)])
def test_a_program_that_began_mpi_has_asked_for_it(
    begun: bool, takes: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("YARPY_MPI", raising=False)
    monkeypatch.setattr(mpi_library, "_library", None)
    monkeypatch.setitem(sys.modules, "mpi4py.MPI", mpi(initialized=begun))  # type: ignore[arg-type]
    assert mpi_library.allowed() == takes


def test_in_time() -> None:
    assert in_time(lambda: 7, 30.0) == 7
    with pytest.raises(ZeroDivisionError):
        in_time(lambda: 1 // 0, 30.0)


def test_too_late() -> None:
    event = threading.Event()
    with pytest.raises(TimeoutError):
        in_time(event.wait, 0.05)
    looks: list[int] = []

    def look() -> None:
        looks.append(1)
        if len(looks) == 3:
            raise ConnectionResetError("gone")

    with pytest.raises(ConnectionResetError):
        in_time(event.wait, 30.0, look)
    event.set()
