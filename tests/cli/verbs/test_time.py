"""`yarpy time`."""

import signal
import time

import pytest

from yarpy.cli.verbs.time import spelled


def test_ten_times_a_second(cli):
    with cli.start("time") as process:
        first = float(process.wait_line(r"^\d+\.\d{6}$").group())
        last = float(process.wait_line(r"^\d+\.\d{6}$", count=6).group())
        process.signal(signal.SIGINT)
        assert process.wait() == 130
    assert abs(first - time.time()) < 30
    assert 0.4 < last - first < 3.0


@pytest.mark.parametrize(
    ("nanoseconds", "plain", "ros"),
    [
        (1_795_224_973_141_008_999, "1795224973.141008", "1795224973 141008999"),
        (5_000_000_007, "5.000000", "5 7"),
    ],
)
def test_spelled(nanoseconds, plain, ros):
    assert spelled(nanoseconds, False) == plain
    assert spelled(nanoseconds, True) == ros
