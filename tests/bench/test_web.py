"""The benchmark of the web carriers runs and counts; how fast they are is not tested."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import web  # noqa: E402


@pytest.fixture(autouse=True)
def all_cores() -> Iterator[None]:
    cores = os.sched_getaffinity(0)
    yield
    os.sched_setaffinity(0, cores)


def test_pictures_are_counted() -> None:
    rate, cost = web.pictures(2, 2, interval=0.1)
    assert rate > 0
    assert 0 < cost < 1000


@pytest.mark.peer("wrk")
def test_requests_are_counted() -> None:
    rate, cost = web.requests(1.0, 2)
    assert rate > 0
    assert 0 < cost < 1e6
