"""Clocks: the computer's, one of the network, and which of them a program lives by."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterator

import pytest
from support.process import Process
from support.wait import HANG, inside, wait_until

import yarpy
from yarpy import clock
from yarpy.clock import NetworkClock, SystemClock, spelled
from yarpy.module import Module

NEVER = threading.Event()


@pytest.fixture
def names() -> Iterator[yarpy.NameClient]:
    with yarpy.NameServer() as server:
        yield server.client


@pytest.fixture
def source(names: yarpy.NameClient) -> Iterator[yarpy.Port]:
    with yarpy.Port("/clock", names=names) as port:
        yield port


@pytest.fixture
def heard(names: yarpy.NameClient, source: yarpy.Port) -> Iterator[NetworkClock]:
    with NetworkClock(names=names) as made:
        source.wait_for_outputs(timeout=HANG)
        yield made


def waiting(one: NetworkClock, seconds: float, over: threading.Event = NEVER) -> threading.Thread:
    """A thread that waits for `seconds` of `one`, and has begun to."""
    began = threading.Event()

    def run() -> None:
        before = one._time
        began.set()
        assert one._time == before
        one.wait(over, seconds)

    thread = threading.Thread(target=run)
    thread.start()
    assert began.wait(HANG)
    return thread


def send(source: yarpy.Port, one: NetworkClock, seconds: float) -> None:
    source.write(spelled(seconds))
    wait_until(lambda: one._time == pytest.approx(seconds))


def test_the_computer_s() -> None:
    one = SystemClock()
    assert abs(one.now() - time.time()) < HANG
    began = time.monotonic()
    assert one.wait(NEVER, 0.01) is False and time.monotonic() - began >= 0.01
    over = threading.Event()
    over.set()
    assert one.wait(over, HANG) is True
    assert one.wait(NEVER, -1.0) is False


def test_seconds_and_nanoseconds() -> None:
    assert spelled(1.25) == [1, 250_000_000]
    assert spelled(1_795_224_973.0) == [1_795_224_973, 0]


def test_it_says_what_it_heard_last(source: yarpy.Port, heard: NetworkClock) -> None:
    assert not heard.valid and heard.monotonic() == 0.0
    with pytest.raises(yarpy.Timeout, match="/clock sends nothing"):
        heard.wait_until_valid(0.01)
    send(source, heard, 12.5)
    assert heard.valid and heard.now() == heard.monotonic() == 12.5


def test_now_waits_for_the_first_message(source: yarpy.Port, heard: NetworkClock) -> None:
    inside("NetworkClock.wait_until_valid", lambda: source.write([7, 0]))
    assert heard.now() == 7.0


def test_so_do_differences(source: yarpy.Port, heard: NetworkClock) -> None:
    before = clock.current()
    clock.use(heard)
    try:
        inside("NetworkClock.wait_until_valid", lambda: source.write([7, 0]))
        assert clock.monotonic() == 7.0
    finally:
        clock.use(before)


def test_a_wait_lasts_as_long_as_the_clock_says(source: yarpy.Port, heard: NetworkClock) -> None:
    send(source, heard, 100.0)
    thread = waiting(heard, 1000.0)
    send(source, heard, 1099.0)
    assert thread.is_alive()
    send(source, heard, 2100.0)
    thread.join(HANG)
    assert not thread.is_alive()


def test_a_clock_that_jumps_back_keeps_nobody_for_longer(
    source: yarpy.Port, heard: NetworkClock
) -> None:
    send(source, heard, 1000.0)
    thread = waiting(heard, 10.0)
    send(source, heard, 0.0)
    # Whoever waits sees each moment only if it looks in time: what it has missed it waits for.
    for moment in range(1, 100):
        send(source, heard, float(moment))
        if not thread.is_alive():
            break
        time.sleep(0.06)
    thread.join(HANG)
    assert not thread.is_alive() and heard.now() <= 60.0


def test_the_end_of_what_waits_and_of_the_clock_itself(
    source: yarpy.Port, heard: NetworkClock
) -> None:
    over = threading.Event()
    threads = [waiting(heard, 1e6, over), waiting(heard, 1e6)]
    over.set()
    threads[0].join(HANG)
    assert not threads[0].is_alive()
    heard.close()
    threads[1].join(HANG)
    assert not threads[1].is_alive()
    with pytest.raises(yarpy.PortClosed):
        heard.now()


def test_what_is_no_time_is_told(
    source: yarpy.Port, heard: NetworkClock, caplog: pytest.LogCaptureFixture
) -> None:
    for nonsense in ("late", [1], ["a", "b"]):
        source.write(nonsense)
    send(source, heard, 3.0)
    assert caplog.text.count("/clock sends no time") == 3


def test_either_side_may_start_first(names: yarpy.NameClient) -> None:
    with NetworkClock("/later", names=names) as one:
        for _ in range(2):  # and it may be started again
            with yarpy.Port("/later", names=names) as port:
                port.wait_for_outputs(timeout=HANG)
                port.write([5, 0])
                assert one.now() == 5.0


def test_without_a_server_the_clock_has_to_be_there() -> None:
    names = yarpy.LocalNames()
    with pytest.raises(yarpy.UnknownName):
        NetworkClock(name="/me", names=names)
    with (
        yarpy.Port("/clock", names=names) as source,
        NetworkClock(name="/me", names=names) as one,
    ):
        source.write([1, 500_000_000])
        assert one.now() == 1.5


def test_which_clock_a_program_lives_by(
    monkeypatch: pytest.MonkeyPatch, source: yarpy.Port, heard: NetworkClock
) -> None:
    monkeypatch.setattr(clock, "_current", None)
    monkeypatch.delenv("YARP_CLOCK", raising=False)
    assert isinstance(clock.current(), SystemClock)
    clock.use(heard)
    source.write([9, 0])
    assert clock.now() == 9.0
    inside("NetworkClock.wait", lambda: source.write([20, 0]))
    clock.sleep(10.0)
    clock._forget()
    clock.use(None)
    assert isinstance(clock.current(), SystemClock)


def test_a_module_keeps_the_time_of_a_simulation(
    monkeypatch: pytest.MonkeyPatch, source: yarpy.Port, heard: NetworkClock
) -> None:
    monkeypatch.setattr(clock, "_current", heard)

    class Counter(Module):
        period = 1000.0
        seen = 0

        def update(self) -> bool:
            self.seen += 1
            return self.seen < 3

    counter = Counter()
    send(source, heard, 1.0)
    thread = threading.Thread(target=counter.run)
    thread.start()
    wait_until(lambda: counter.seen == 1)
    moment = 1.0
    while thread.is_alive():
        moment += 1000.0
        send(source, heard, moment)
        time.sleep(0.01)
    assert counter.seen == 3 and moment >= 2001.0


PROGRAM = """
import os, yarpy
print("parent", yarpy.clock.now(), flush=True)
child = os.fork()
if child == 0:  # it has no connections of its parent's
    print("child", yarpy.clock.now(), flush=True)
else:
    os.waitpid(child, 0)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_the_environment_names_it() -> None:
    with yarpy.NameServer() as server, yarpy.Port("/sim", names=server.client) as source:
        environment = {**os.environ, "YARP_CLOCK": "/sim", **server.environment}
        with Process([sys.executable, "-c", PROGRAM], env=environment) as process:
            wait_until(lambda: _told(source, 42, process, "parent"))
            wait_until(lambda: _told(source, 43, process, "child"))
            process.wait()
        said = process.stderr.splitlines()
        assert not [line for line in said if not line.startswith("waiting for the clock /sim")]


def _told(source: yarpy.Port, seconds: int, process: Process, who: str) -> bool:
    source.write([seconds, 0])
    time.sleep(0.02)
    return f"{who} {seconds}.0" in process.stdout
