"""Sending what a burst left behind."""

from __future__ import annotations

import time

import pytest
from support.build import COMPILED
from support.wait import HANG, wait_until

from yarpy.link.send.flusher import GATHER_SECONDS, Flusher


def test_flusher_comes_soon_and_sleeps_when_nothing_is_left() -> None:
    flushes: list[float] = []

    def drain() -> bool:
        flushes.append(time.perf_counter())
        return len(flushes) < 3

    flusher = Flusher("flusher", drain)
    time.sleep(0.02)
    assert flushes == []
    flusher.watch()
    wait_until(lambda: len(flushes) == 4)  # once more when it says that it sleeps
    assert flushes[1] - flushes[0] >= GATHER_SECONDS / 2
    time.sleep(0.02)
    assert len(flushes) == 4
    flusher.watch()
    wait_until(lambda: len(flushes) == 6)
    flusher.stop()
    flusher.thread.join(HANG)
    assert not flusher.thread.is_alive()


def test_thread_begins_with_the_first_work_and_not_behind_the_end() -> None:
    flusher = Flusher("idle", lambda: False)
    assert not flusher.thread.is_alive()
    flusher.stop()
    flusher.watch()
    assert not flusher.thread.is_alive()


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

    flusher = Flusher("x", lambda: False)
    flusher.thread = Begun(7)  # type: ignore[assignment]
    flusher.watch()
    flusher.thread = Begun(None)  # type: ignore[assignment]
    with pytest.raises(RuntimeError):  # threads have run out
        flusher.watch()
