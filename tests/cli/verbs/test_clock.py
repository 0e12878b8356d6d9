"""`yarpy clock`: programs with YARP_CLOCK live by what it sends."""

from __future__ import annotations

import signal
import threading
from typing import Any

import yarpy
from yarpy.clock import NetworkClock


def test_it_sends_the_time(cli: Any, names: yarpy.NameClient) -> None:
    with (
        cli.start("clock", "--name", "/time", "--rtf", "1000", "--period", "5") as process,
        NetworkClock("/time", names=names) as clock,
    ):
        first = clock.now()
        assert first >= 0
        clock.wait(threading.Event(), 100.0)  # a tenth of a second
        assert clock.now() >= first + 100.0
        process.signal(signal.SIGINT)
        assert process.wait() == 130
        assert "YARP_CLOCK=/time makes programs live by it" in process.stdout


def test_it_may_send_that_of_the_computer(cli: Any, names: yarpy.NameClient) -> None:
    with (
        cli.start("clock", "--systemTime") as process,
        NetworkClock(names=names) as clock,
    ):
        assert clock.now() > 1.7e9
        process.signal(signal.SIGINT)
        process.wait()


def test_what_makes_no_sense(cli: Any, names: yarpy.NameClient) -> None:
    for words in (["--rtf", "0"], ["--period", "-1"]):
        assert cli.run("clock", *words).returncode == 1
    with yarpy.Port("/clock", names=names):
        said = cli.run("clock")
        assert said.returncode == 1 and "/clock" in said.stderr
