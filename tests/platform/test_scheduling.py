"""What the system says to the scheduling of a thread."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator

import pytest

from yarpy.platform import scheduling


@pytest.fixture
def thread() -> Iterator[int]:
    """A thread whose scheduling nobody needs."""
    over = threading.Event()
    one = threading.Thread(target=over.wait)
    one.start()
    assert one.native_id is not None
    yield one.native_id
    over.set()
    one.join()


needed = pytest.mark.skipif(
    sys.platform not in ("linux", "win32"), reason="this system schedules no thread by itself"
)


@needed
def test_another_thread_and_ones_own(thread: int) -> None:
    scheduling.schedule(thread, 0, 0)
    assert scheduling.scheduled(thread) == scheduling.scheduled(0) == (0, 0)


@needed
@pytest.mark.parametrize("asked", [(1, 1), (2, 33), (1, 34), (2, 66), (1, 67), (2, 99)])
def test_a_priority_is_read_back_as_the_system_has_it(thread: int, asked: tuple[int, int]) -> None:
    try:
        scheduling.schedule(thread, *asked)
    except PermissionError:
        assert scheduling.scheduled(thread) == (0, 0)
        return
    levels = (2, {1: 1, 33: 1, 34: 34, 66: 34, 67: 67, 99: 67}[asked[1]])
    assert scheduling.scheduled(thread) == (levels if sys.platform == "win32" else asked)
    scheduling.schedule(thread, 0, 0)
    assert scheduling.scheduled(thread) == (0, 0)


@needed
@pytest.mark.parametrize("asked", [(1, 200), (9, 1), (2, -1)])
def test_what_no_system_takes(thread: int, asked: tuple[int, int]) -> None:
    with pytest.raises(OSError):
        scheduling.schedule(thread, *asked)
    assert scheduling.scheduled(thread) == (0, 0)


def test_a_thread_that_is_not_there() -> None:
    with pytest.raises(OSError):
        scheduling.scheduled(2**22 - 1)


def test_a_system_without_it(monkeypatch: pytest.MonkeyPatch) -> None:
    if sys.platform == "linux":
        monkeypatch.delattr("os.sched_setscheduler")
        monkeypatch.delattr("os.sched_getscheduler")
    elif sys.platform == "win32":
        pytest.skip("each Windows has levels of threads")
    with pytest.raises(NotImplementedError):
        scheduling.schedule(0, 0, 0)
    with pytest.raises(OSError, match="does not tell"):
        scheduling.scheduled(0)
