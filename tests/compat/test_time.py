"""Time: of the system, of a port of the network, of an object of the program."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from support.wait import wait_until

import yarp
import yarpy


@pytest.fixture(autouse=True)
def local() -> Iterator[None]:
    yarp.Network.setLocalMode(True)
    yield
    yarp.Time.useSystemClock()
    yarp.Network.setLocalMode(False)


class Simulated:
    """A clock of a program: time passes when somebody waits for it."""

    valid = True

    def __init__(self) -> None:
        self.time = 100.0

    def now(self) -> float:
        return self.time

    def delay(self, seconds: float) -> None:
        self.time += seconds

    def isValid(self) -> bool:
        return self.valid


def test_of_the_system() -> None:
    assert yarp.Time.isSystemClock() and yarp.getClockType() == yarp.YARP_CLOCK_SYSTEM
    assert yarp.Time.now() > 1.7e9 and yarp.Time.isValid()


def test_of_the_network() -> None:
    source = yarp.BufferedPortBottle()
    assert source.open("/clock")
    assert yarp.Time.useNetworkClock("/clock", "/me/clock:i")
    assert yarp.Time.isNetworkClock() and not yarp.Time.isValid()

    def tick(seconds: int) -> None:
        said = source.prepare()
        said.clear()
        said.addInt32(seconds)
        said.addInt32(500_000_000)
        source.writeStrict()

    tick(7)
    assert yarp.Time.now() == 7.5 and yarp.Time.isValid()
    stamp = yarp.Stamp()
    stamp.update()
    assert stamp.getTime() == 7.5
    thread = threading.Thread(target=yarp.Time.delay, args=(10.0,))
    thread.start()
    seconds = 7
    while thread.is_alive():
        seconds += 100
        tick(seconds)
        wait_until(lambda seconds=seconds: yarp.now() == seconds + 0.5)
    source.close()


def test_a_clock_that_is_not_there(capfd: pytest.CaptureFixture[str]) -> None:
    assert not yarp.Time.useNetworkClock("/nowhere", "/me/clock:i")
    assert "/nowhere" in capfd.readouterr().err and yarp.Time.isSystemClock()


def test_of_the_program() -> None:
    clock = Simulated()
    assert yarp.Time.useCustomClock(clock) and yarp.Time.isCustomClock()
    assert yarp.Time.now() == 100.0
    yarp.Time.delay(1000.0)
    assert yarp.Time.now() == pytest.approx(1100.0)
    clock.valid = False
    assert not yarp.Time.isValid() and not yarp.Time.useCustomClock(clock)


def test_threads_keep_it() -> None:
    clock = Simulated()
    assert yarp.Time.useCustomClock(clock)
    times: list[float] = []

    class Worker(yarp.PeriodicThread):
        def run(self) -> None:
            times.append(yarpy.clock.now())

    worker = Worker(1000.0)
    assert worker.start()
    wait_until(lambda: len(times) >= 3)
    worker.stop()
    assert times[:3] == pytest.approx([100.0, 1100.0, 2100.0])
