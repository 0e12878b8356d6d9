"""Who reads a connection: asked, granted, over; and nobody looks at a clock while nothing comes."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest
from support.wait import wait_until

from yarpy.link import turn
from yarpy.link.turn import Turn


class Thread:
    """A connection's thread that has handed over a message, and the question it may have been."""

    def __init__(self) -> None:
        self.turn = Turn()
        self.question = False
        self.looks = 0
        self.turn.ask()
        assert self.turn.grant()
        self._thread = threading.Thread(target=self.turn.park, args=(self._look,), daemon=True)
        self._thread.start()

    def _look(self) -> bool:
        self.looks += 1
        return self.question

    @property
    def reads_on(self) -> bool:
        return not self._thread.is_alive()

    def join(self) -> None:
        self._thread.join(5)
        assert self.reads_on


@pytest.fixture
def parked(monkeypatch: pytest.MonkeyPatch) -> Iterator[Thread]:
    """It looks rarely enough for a busy machine."""
    monkeypatch.setattr(turn, "AWAY", 0.3)
    thread = Thread()
    yield thread
    thread.turn.end()
    thread.join()


def test_nobody_who_did_not_ask_gets_the_lease() -> None:
    turn = Turn()
    assert not turn.grant()
    assert not turn.take(0)


def test_reader_comes_and_goes_while_the_thread_is_parked(parked: Thread) -> None:
    for _ in range(5):
        assert parked.turn.take(1)
        time.sleep(0.1)
        parked.turn.leave()
    assert not parked.reads_on


def test_two_readers_never_read_at_once(parked: Thread) -> None:
    assert parked.turn.take(1)
    assert not parked.turn.take(0.01)
    parked.turn.leave()
    assert parked.turn.take(1)
    parked.turn.leave()


def test_thread_reads_on_when_the_reader_stays_away(parked: Thread) -> None:
    assert parked.turn.take(1)
    parked.turn.leave()
    parked.join()
    assert not parked.turn.take(0)


def test_thread_reads_on_at_once_when_the_lease_is_ended(parked: Thread) -> None:
    started = time.monotonic()
    parked.turn.end()
    parked.join()
    assert time.monotonic() - started < 0.25
    assert not parked.turn.take(0)
    assert not parked.turn.grant()  # the reader has to ask again


def test_lease_is_taken_by_nobody_after_its_end(parked: Thread) -> None:
    """A reader that waited for the lock meanwhile finds that out."""
    assert parked.turn.take(1)
    found: list[bool] = []
    other = threading.Thread(target=lambda: found.append(parked.turn.take(5)))
    other.start()
    time.sleep(0.02)
    parked.turn.end()
    parked.turn.leave()
    other.join(5)
    assert found == [False]


def test_open_question_keeps_the_thread_parked_and_its_end_wakes_it(parked: Thread) -> None:
    parked.question = True
    wait_until(lambda: parked.looks > 1)
    time.sleep(0.4)
    looks = parked.looks
    time.sleep(0.7)
    assert parked.looks == looks  # it does not look again and again
    assert not parked.reads_on
    parked.question = False
    parked.turn.stir()
    parked.join()
