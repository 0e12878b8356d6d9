"""realtime(): asked for, measured, undone."""

from __future__ import annotations

import gc
import sys
import threading

import pytest
from support.wait import HANG

from yarpy.errors import LocalProtocolError
from yarpy.qos import Sched, scheduled
from yarpy.real_time import SWITCH_INTERVAL, realtime


@pytest.fixture(autouse=True)
def unchanged() -> object:
    """Whatever a test does, the next one finds Python as it was."""
    before = sys.getswitchinterval()
    yield
    sys.setswitchinterval(before)
    gc.unfreeze()


def test_importing_changes_nothing() -> None:
    assert sys.getswitchinterval() == pytest.approx(0.005)


def test_threads_take_turns_sooner_until_the_end() -> None:
    before = sys.getswitchinterval()
    with realtime():
        assert sys.getswitchinterval() == pytest.approx(SWITCH_INTERVAL)
        assert gc.get_freeze_count() > 0
    assert sys.getswitchinterval() == before
    assert gc.get_freeze_count() == 0


def test_it_stays_without_a_with() -> None:
    realtime(switch_interval=0.001)
    assert sys.getswitchinterval() == pytest.approx(0.001)


def test_priority_of_the_calling_thread_or_the_reason() -> None:
    found: list[object] = []

    def run() -> None:
        try:
            with realtime(priority=3):
                found.append(scheduled(0))
            found.append(scheduled(0))
        except LocalProtocolError as error:
            found.append(str(error))

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(HANG)
    if isinstance(found[0], str):
        assert "CAP_SYS_NICE" in found[0] or "does not let" in found[0]
        assert sys.getswitchinterval() == pytest.approx(0.005)  # nothing was done by halves
    else:
        assert found == [Sched(1, 3), Sched(0, 0)]
