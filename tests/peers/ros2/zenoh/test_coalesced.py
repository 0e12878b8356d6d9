"""Work that many ask for, and one thread does."""

import threading

import pytest
from support.wait import HANG, wait_until

from yarpy.peers.ros2.zenoh.coalesced import Coalesced


def test_a_flood_starts_one_thread() -> None:
    begun, go_on, over = threading.Event(), threading.Event(), threading.Event()
    threads: list[threading.Thread] = []

    def act() -> None:
        threads.append(threading.current_thread())
        if len(threads) == 2:
            over.set()
        begun.set()
        assert go_on.wait(HANG)

    look = Coalesced(act, "look")
    look()
    assert begun.wait(HANG)
    for _ in range(5000):
        look()
    go_on.set()
    assert over.wait(HANG)
    (thread,) = {*threads}
    thread.join(HANG)
    assert (len(threads), thread.name, thread.is_alive()) == (2, "look", False)
    look()  # another thread, once that one has ended
    wait_until(lambda: len(threads) == 3)
    threads[2].join(HANG)


def test_what_fails_does_not_stop_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    raised: list[BaseException | None] = []
    monkeypatch.setattr(threading, "excepthook", lambda args: raised.append(args.exc_value))
    made: list[threading.Thread] = []

    def act() -> None:
        made.append(threading.current_thread())
        raise ValueError("no")

    look = Coalesced(act, "look")
    for number in (1, 2):
        look()
        wait_until(lambda wanted=number: len(made) == wanted)  # type: ignore[misc]
        made[-1].join(HANG)
    assert len(raised) == 2


def test_a_thread_that_cannot_be_started(monkeypatch: pytest.MonkeyPatch) -> None:
    done = threading.Event()
    look = Coalesced(done.set, "look")

    def start(thread: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", start)
        with pytest.raises(RuntimeError):
            look()
    look()
    assert done.wait(HANG)
