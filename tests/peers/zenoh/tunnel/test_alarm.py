"""The alarm clock."""

from __future__ import annotations

import os
import threading
import time

import pytest
from support.wait import HANG, wait_until

from yarpy.peers.zenoh.tunnel.alarm import CLOCK, AlarmClock


def test_alarms_come_in_the_order_of_their_times_and_not_before() -> None:
    clock, called, now = AlarmClock(), [], time.monotonic()
    for name, after in (("late", 0.06), ("soon", 0.02), ("past", -1.0), ("soon too", 0.02)):
        clock.set(now + after, lambda name=name, due=now + after: called.append((name, due)))
    seen = []
    while len(seen) < 4:
        if len(called) > len(seen):
            seen.append(called[len(seen)])
            assert time.monotonic() >= seen[-1][1]
    assert [name for name, _ in seen] == ["past", "soon", "soon too", "late"]


def test_an_earlier_one_is_not_kept_waiting() -> None:
    clock, called = AlarmClock(), threading.Event()
    clock.set(time.monotonic() + 3600, lambda: None)
    clock.set(time.monotonic(), called.set)
    assert called.wait(HANG)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.filterwarnings("ignore:.*fork")
def test_a_forked_process_has_one_of_its_own() -> None:
    called = threading.Event()
    CLOCK.set(time.monotonic(), called.set)
    assert called.wait(HANG)
    child = os.fork()
    if not child:
        called.clear()
        CLOCK.set(time.monotonic(), called.set)
        os._exit(0 if called.wait(HANG) else 1)
    assert os.waitpid(child, 0)[1] == 0
    wait_until(lambda: CLOCK._running)
