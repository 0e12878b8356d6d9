"""Threads for what may block."""

import asyncio
import contextvars
import os
import threading
import time

import pytest
from support.wait import HANG

from yarpy.aio.thread import THREADS, Threads, Turn, in_thread
from yarpy.scope import sleep


def test_each_piece_of_work_has_a_thread_and_idle_ones_are_used_again():
    async def main():
        both = threading.Barrier(100)
        await asyncio.gather(*(in_thread(lambda: both.wait(HANG)) for _ in range(100)))
        for _ in range(200):
            if len(THREADS._idle) >= 100:
                break
            await asyncio.sleep(0.01)
        names = await asyncio.gather(*(in_thread(threading.get_ident) for _ in range(20)))
        assert len(set(names)) <= 20

    asyncio.run(main())


def test_idle_threads_end():
    def threads():
        return [one for one in threading.enumerate() if one.name == "yarpy aio"]

    asyncio.run(in_thread(int))
    assert all(one.daemon for one in threads())
    deadline = time.monotonic() + 20
    while threads():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_results_errors_and_context_come_and_go():
    word = contextvars.ContextVar("word", default="none")

    def fail(error):
        raise error

    async def main():
        word.set("ours")
        assert await in_thread(word.get) == "ours"
        with pytest.raises(KeyError):
            await in_thread(lambda: fail(KeyError("x")))
        with pytest.raises(RuntimeError, match="StopIteration"):
            await in_thread(lambda: fail(StopIteration("x")))

    asyncio.run(main())


def test_cancelled_work_is_ended_and_what_follows_waits_for_its_end():
    async def main():
        turn, seen = Turn(), []

        def work(number, seconds):
            try:
                sleep(seconds)
            finally:
                seen.append(number)

        first = asyncio.create_task(turn.run(lambda left: work(1, 60), None))
        second = asyncio.create_task(turn.run(lambda left: work(2, 0), None))
        third = asyncio.create_task(turn.run(lambda left: work(3, 0), None))
        await asyncio.sleep(0.05)
        second.cancel()
        await asyncio.sleep(0)
        first.cancel()
        await asyncio.wait_for(third, 10)
        assert seen == [1, 3]
        assert first.cancelled() and second.cancelled()
        assert turn.take()

    asyncio.run(main())


def test_turn_goes_on_when_whoever_got_it_is_cancelled():
    async def main():
        turn = Turn()
        assert turn.take()
        waiting = [asyncio.create_task(turn.wait()) for _ in range(2)]
        await asyncio.sleep(0)
        turn.release()
        waiting[0].cancel()  # the turn is on its way to it
        await asyncio.wait_for(waiting[1], 10)
        turn.release()
        assert turn.take()

    asyncio.run(main())


def test_turn_that_does_not_come_in_time_is_not_waited_for():
    async def main():
        turn = Turn()
        assert turn.take()
        late, patient = turn.wait(0.0), asyncio.create_task(turn.wait())
        assert not await asyncio.wait_for(late, HANG)
        assert await turn.run(lambda left: left, 0.0) == 0.0  # and the turn is still another's
        turn.release()
        assert await asyncio.wait_for(patient, HANG)
        assert not turn.take()

    asyncio.run(main())


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forking is of Unix")
def test_forked_process_has_threads_of_its_own():
    threads = Threads()
    ran = threading.Event()
    threads.start(ran.set)
    assert ran.wait(HANG)
    child = os.fork()
    if child == 0:
        again = threading.Event()
        threads.start(again.set)
        os._exit(0 if again.wait(HANG) else 1)
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.parametrize("late", [False, True])
def test_what_succeeds_when_nobody_waits_any_more_is_undone(late, monkeypatch):
    """Cancelled while the work is at its end, or when its result is on its way to the task."""

    async def main():
        loop, go_on, undone = asyncio.get_running_loop(), threading.Event(), []
        begun = threading.Event()  # else there is nothing to undo

        def work():
            begun.set()
            assert go_on.wait(HANG)
            return "made"

        task = asyncio.create_task(in_thread(work, undo=undone.append))
        while not begun.is_set():
            await asyncio.sleep(0.001)
        if late:  # its result comes, and then this, before the task goes on
            told, call = threading.Event(), loop.call_soon_threadsafe
            monkeypatch.setattr(
                loop, "call_soon_threadsafe", lambda *words: (call(*words), told.set())
            )
            go_on.set()
            assert told.wait(HANG)
            loop.call_soon(task.cancel)
        else:
            task.cancel()
            go_on.set()
        with pytest.raises(asyncio.CancelledError):
            await task
        deadline = time.monotonic() + 20
        while not undone:
            assert time.monotonic() < deadline
            await asyncio.sleep(0.001)
        assert undone == ["made"]

    asyncio.run(main())
