"""Sending what a burst left behind."""

from __future__ import annotations

import time

import pytest
from support.build import COMPILED
from support.wait import HANG, wait_until

from yarpy.link.send.sweeper import GATHER_SECONDS, Sweeper


def test_sweeper_comes_soon_and_sleeps_when_nothing_is_left() -> None:
    sweeps: list[float] = []

    def sweep() -> bool:
        sweeps.append(time.perf_counter())
        return len(sweeps) < 3

    sweeper = Sweeper("sweeper", sweep)
    time.sleep(0.02)
    assert sweeps == []
    sweeper.watch()
    wait_until(lambda: len(sweeps) == 4)  # once more when it says that it sleeps
    assert sweeps[1] - sweeps[0] >= GATHER_SECONDS / 2
    time.sleep(0.02)
    assert len(sweeps) == 4
    sweeper.watch()
    wait_until(lambda: len(sweeps) == 6)
    sweeper.stop()
    sweeper.thread.join(HANG)
    assert not sweeper.thread.is_alive()


def test_thread_begins_with_the_first_work_and_not_behind_the_end() -> None:
    sweeper = Sweeper("idle", lambda: False)
    assert not sweeper.thread.is_alive()
    sweeper.stop()
    sweeper.watch()
    assert not sweeper.thread.is_alive()


@pytest.mark.skipif(COMPILED, reason="compiled code takes no other thread")
def test_a_start_that_a_signal_has_cut_is_no_error_of_the_next() -> None:
    """It comes to its end a moment after the look whether there was one."""

    class Begun:
        ident: int | None = None

        def __init__(self, ident: int | None) -> None:
            self._later = ident

        def start(self) -> None:
            self.ident = self._later
            raise RuntimeError("it was begun, or cannot be")

    sweeper = Sweeper("x", lambda: False)
    sweeper.thread = Begun(7)  # type: ignore[assignment]
    sweeper.watch()
    sweeper.thread = Begun(None)  # type: ignore[assignment]
    with pytest.raises(RuntimeError):  # threads have run out
        sweeper.watch()
