"""A clock that is set forth and back, and one that goes a little wrong."""

import time

import pytest

from yarpy.kits.record.capture.clock_step import SystemClock


def test_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    system, steady = [100.0, 101.0, 3702.0, 3703.4, 3704.0, 104.0, 105.0], [*range(10, 17)]
    monkeypatch.setattr(time, "time_ns", lambda: round(system.pop(0) * 1e9))
    monkeypatch.setattr(time, "monotonic_ns", lambda: steady.pop(0) * 10**9)
    clock = SystemClock()
    assert [clock.look() for _ in range(6)] == [0.0, 3600.0, 0.0, 0.0, -3601.0, 0.0]
