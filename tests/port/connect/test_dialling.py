"""One attempt at a time to connect a port to a target, whoever makes it."""

import gc
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from support.cut import ALL_SEEN, cut_at
from support.wait import HANG, inside, wait_until

import yarpy
from yarpy.port.connect import connecting, reconnect
from yarpy.port.connect.dialling import ATTEMPTS, Attempts, Dialling
from yarpy.port.hub import Hub


def test_the_second_waits_or_leaves_it_alone() -> None:
    dialling = Dialling()
    order: list[str] = []

    def second() -> None:
        with dialling.alone("/b") as alone:
            assert alone
            order.append("second")

    with dialling.alone("/b") as alone:
        assert alone
        with dialling.alone("/b") as again:
            assert again  # a frame beneath of this thread: nobody else would let it go on
        seen: list[bool] = []

        def look() -> None:
            with dialling.alone("/b", wait=False) as mine:
                seen.append(mine)

        looking = threading.Thread(target=look)
        looking.start()
        looking.join(HANG)
        assert seen == [False]
        with dialling.alone("/c", wait=False) as other:
            assert other
        thread = threading.Thread(target=second)
        thread.start()
        time.sleep(0.02)
        order.append("first")
    thread.join(HANG)
    assert order == ["first", "second"]


def test_a_failed_attempt_lets_the_next_one_in() -> None:
    dialling = Dialling()
    with pytest.raises(ValueError, match="no"), dialling.alone("/b"):
        raise ValueError("no")
    with dialling.alone("/b", wait=False) as alone:
        assert alone


def test_an_attempt_for_which_there_is_no_thread_is_made_later(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    attempts, done = Attempts("dial"), threading.Event()

    def refuse(thread: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", refuse)
        assert not attempts.begin("/a", done.set)
    assert attempts.under_way == 0
    assert attempts.begin("/a", done.set), "the target is free again"
    assert done.wait(HANG)


def test_one_attempt_at_each_target_and_a_limited_number_in_all() -> None:
    attempts = Attempts("dial")
    go_on, done = threading.Event(), []

    def attempt() -> None:
        assert go_on.wait(HANG)
        done.append(threading.current_thread().name)

    assert attempts.begin("/a", attempt)
    assert not attempts.begin("/a", attempt), "one at a time"
    for number in range(ATTEMPTS - 1):
        assert attempts.begin(f"/b{number}", attempt)
    assert not attempts.begin("/c", attempt), "there are enough"
    go_on.set()
    wait_until(lambda: not attempts.under_way)
    assert attempts.begin("/c", attempt)
    wait_until(lambda: len(done) == ATTEMPTS + 1)
    assert {"yarpy dial /a", "yarpy dial /c"} < set(done)


def test_an_attempt_that_raises_is_logged_and_over(caplog: pytest.LogCaptureFixture) -> None:
    attempts = Attempts("dial")
    assert attempts.begin("/a", lambda: 1 // 0)
    wait_until(lambda: not attempts.under_way)
    assert "to dial /a failed" in caplog.text and "ZeroDivisionError" in caplog.text


class Slow:
    """`connecting.open_output`, but the first reconnection pauses inside until it is let go."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.inside = threading.Event()
        self.go_on = threading.Event()
        self._real = connecting.open_output
        monkeypatch.setattr(connecting, "open_output", self)

    def __call__(self, hub: Hub, *arguments: object) -> object:
        if threading.current_thread().name == "yarpy dial /in" and not self.inside.is_set():
            self.inside.set()
            assert self.go_on.wait(HANG)
        return self._real(hub, *arguments)  # type: ignore[arg-type]


@contextmanager
def broken(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[yarpy.Port, Slow]]:
    """A port whose connection to /in broke and is just being made again, by that port alone."""
    monkeypatch.setattr(reconnect.Reconnector, "_ask_sender", lambda *_: False)  # of /in
    slow = Slow(monkeypatch)
    with yarpy.NameServer(), yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True):
        out.connect("/in")
        out._hub.outputs.links[0].driver.transport.interrupt()
        assert slow.inside.wait(HANG)
        try:
            yield out, slow
        finally:
            slow.go_on.set()


def test_a_program_that_connects_during_a_reconnection_keeps_its_connection(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with broken(monkeypatch) as (out, slow):
        inside("Dialling._wait", slow.go_on.set)
        out.connect("/in", "fast_tcp")
        wait_until(lambda: not out._hub.dialling._targets)
        assert [link.carrier for link in out.outputs] == ["fast_tcp"]
        assert not out._hub.outputs.links[0].ended()


def test_disconnecting_during_a_reconnection_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    with broken(monkeypatch) as (out, slow):
        out.disconnect("/in")
        slow.go_on.set()
        wait_until(lambda: not out._hub.dialling._targets)
        time.sleep(0.1)
        assert not out.outputs


@pytest.mark.parametrize("nested", [False, True])
def test_a_signal_handler_that_raises_anywhere_gives_the_target_back(nested: bool) -> None:
    number, there = 0, True
    while there or number < 2:  # the second time Python 3.13 shows more
        number += 1
        dialling = Dialling()

        def dial(dialling: Dialling = dialling) -> None:
            with dialling.alone("/b"):
                if nested:
                    with dialling.alone("/b"):
                        pass

        there = cut_at(number, dial, "connect/dialling.py")
        gc.collect()  # of what was cut when it had begun
        seen: list[bool] = []

        def look(dialling: Dialling = dialling, seen: list[bool] = seen) -> None:
            with dialling.alone("/b", wait=False) as mine:
                seen.append(mine)

        thread = threading.Thread(target=look)
        thread.start()
        thread.join(HANG)
        assert seen == [True], number
    assert number > 3 or not ALL_SEEN
