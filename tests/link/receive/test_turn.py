"""Who reads a connection: asked, granted, over; and nobody looks at a clock while nothing comes."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest
from support.wait import HANG, wait_until

from yarpy.link.receive import turn
from yarpy.link.receive.turn import Turn

OFTEN = 0.01  # seconds between two looks


class Thread:
    """A connection's thread that has handed over a message, and the question it may have been."""

    def __init__(self) -> None:
        self.turn = Turn()
        self.question = False
        self.looks = 0
        self.turn.ask(threading.get_ident())
        lease = self.turn.grant()
        assert lease is not None
        self.lease = lease
        arguments = (lease, self._look)
        self._thread = threading.Thread(target=self.turn.park, args=arguments, daemon=True)
        self._thread.start()

    def _look(self) -> bool:
        self.looks += 1
        return self.question

    @property
    def reads_on(self) -> bool:
        return not self._thread.is_alive()

    def join(self) -> None:
        self._thread.join(HANG)
        assert self.reads_on


@pytest.fixture
def parked(monkeypatch: pytest.MonkeyPatch) -> Iterator[Thread]:
    """It does not look before a test wants it to, however slow the machine is."""
    monkeypatch.setattr(turn, "AWAY", HANG)
    thread = Thread()
    yield thread
    thread.turn.end()
    thread.lease.busy = False
    thread.join()


def test_nobody_who_did_not_ask_gets_the_lease() -> None:
    turn = Turn()
    assert turn.grant() is None
    assert not turn.leased


def test_lease_is_of_the_thread_that_asked(parked: Thread) -> None:
    assert parked.lease.reader == threading.get_ident()
    assert parked.turn.lease is parked.lease


def test_lease_opens_when_the_thread_parks() -> None:
    turn = Turn()
    turn.ask(threading.get_ident())
    lease = turn.grant()
    assert lease is not None
    assert not lease.wait(0.01)
    lease.begin()
    assert lease.wait(0.01)
    assert lease.open


def look(parked: Thread, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let it look at once, and often from now on."""
    monkeypatch.setattr(turn, "AWAY", OFTEN)
    parked.turn._changed.wake()


def test_thread_reads_on_when_the_reader_stays_away(
    parked: Thread, monkeypatch: pytest.MonkeyPatch
) -> None:
    look(parked, monkeypatch)
    parked.join()
    assert parked.lease.over
    assert not parked.turn.leased


def test_thread_reads_on_when_the_lease_is_ended(parked: Thread) -> None:
    parked.turn.end()
    parked.join()
    assert not parked.turn.leased
    assert parked.turn.grant() is None  # the reader has to ask again


def test_thread_waits_until_the_reader_is_out(parked: Thread) -> None:
    parked.lease.busy = True
    parked.turn.end()
    time.sleep(0.05)
    assert not parked.reads_on
    parked.lease.busy = False
    parked.join()


def test_open_question_keeps_the_thread_parked_and_its_end_wakes_it(
    parked: Thread, monkeypatch: pytest.MonkeyPatch
) -> None:
    parked.question = True
    look(parked, monkeypatch)
    wait_until(lambda: parked.looks > 1)
    looks = parked.looks
    time.sleep(20 * OFTEN)
    assert parked.looks <= looks + 2  # it does not look again and again
    assert not parked.reads_on
    parked.question = False
    parked.turn.stir()
    parked.join()


def test_thread_waits_for_an_open_question_though_the_lease_is_over(parked: Thread) -> None:
    """The reader may be writing the answer at this moment."""
    parked.question = True
    parked.turn.end()
    wait_until(lambda: parked.looks > 2)
    looks = parked.looks
    time.sleep(20 * OFTEN)
    assert parked.looks <= looks + 2
    assert not parked.reads_on
    parked.question = False
    parked.turn.stir()
    parked.join()
