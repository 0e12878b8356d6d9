"""Sending what a burst left behind."""

from __future__ import annotations

import time

from support.wait import wait_until

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
    sweeper.thread.join(5)
    assert not sweeper.thread.is_alive()


def test_thread_begins_with_the_first_work_and_not_behind_the_end() -> None:
    sweeper = Sweeper("idle", lambda: False)
    assert not sweeper.thread.is_alive()
    sweeper.stop()
    sweeper.watch()
    assert not sweeper.thread.is_alive()
