"""Threads for what may block: as many as there is work that blocks, each used again when idle.

Rules: nothing waits for a free thread, so work may wait for other work without a dead lock. They
are daemons: an event loop, or a program, that ends does not wait for them. Work whose task was
cancelled is told to end; until it has, nothing begins that has to come after it.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections import deque
from collections.abc import Callable
from contextvars import copy_context
from functools import partial
from queue import Empty, SimpleQueue
from typing import Final, TypeAlias, TypeVar

from yarpy.scope import Scope, moment
from yarpy.threads import Thread

T = TypeVar("T")
Work: TypeAlias = Callable[[], object]

IDLE: Final = 2.0  # seconds for which a thread waits for more work


class Threads:
    """Runs each piece of work at once, in a thread that has nothing else to do."""

    def __init__(self) -> None:
        self._idle: deque[SimpleQueue[Work]] = deque()  # its methods are atomic
        self._process = os.getpid()

    def start(self, work: Work) -> None:
        """Run `work`, which raises nothing. Raises RuntimeError where threads have run out."""
        if self._process != os.getpid():  # threads do not come along into a forked process
            self._process = os.getpid()
            self._idle.clear()
        try:
            inlet = self._idle.pop()
        except IndexError:
            inlet = SimpleQueue()
            Thread(target=self._run, args=(inlet,), name="yarpy aio", daemon=True).start()
        inlet.put(work)

    def _run(self, inlet: SimpleQueue[Work]) -> None:
        while True:
            try:
                work = inlet.get(timeout=IDLE)
            except Empty:
                try:
                    self._idle.remove(inlet)
                    return
                except ValueError:
                    work = inlet.get()  # it was chosen just now
            work()
            del work  # what it holds shall not live until the next one
            self._idle.append(inlet)


THREADS: Final = Threads()


async def in_thread(
    work: Callable[[], T],
    after: Callable[[], object] | None = None,
    undo: Callable[[T], object] | None = None,
) -> T:
    """Return what `work` returns, which runs in a thread of its own.

    When this is cancelled, whatever `work` waits for in a port ends with PortClosed; nobody waits
    for that. Where it has succeeded all the same, `undo` gets the result, in a thread; it raises
    nothing. `after` is called in the loop once `work` has ended, however that came.
    """
    loop = asyncio.get_running_loop()
    done: asyncio.Future[T] = loop.create_future()
    context = copy_context()
    scope = Scope()

    def scoped() -> T:
        with scope:
            return work()

    def run() -> None:
        found: list[T] = []
        failed: BaseException | None = None
        try:
            found.append(context.run(scoped))
        except StopIteration as error:  # which no Future takes
            failed = RuntimeError(f"StopIteration: {error}")
        except BaseException as error:
            failed = error
        try:
            loop.call_soon_threadsafe(settle, found, failed)
        except RuntimeError:
            pass  # the loop is closed: nobody waits any more
        finally:
            failed = None  # it knows this frame

    def settle(found: list[T], failed: BaseException | None) -> None:
        if not done.done():
            if failed is None:
                done.set_result(found[0])
            else:
                done.set_exception(failed)
        elif failed is None:
            dismiss(found[0])
        if after is not None:
            after()

    def dismiss(result: T) -> None:
        if undo is not None:
            THREADS.start(partial(undo, result))

    try:
        THREADS.start(run)
    except BaseException:
        if after is not None:
            after()
        raise
    try:
        return await done
    except asyncio.CancelledError:
        scope.end("the task that waited for this was cancelled")
        if done.done() and not done.cancelled() and done.exception() is None:
            dismiss(done.result())
        raise


class Turn:
    """Work that comes one after the other, in the order of the calls."""

    def __init__(self) -> None:
        self._taken = False
        self._waiting: deque[asyncio.Future[bool]] = deque()

    def take(self) -> bool:
        """Take the turn if nothing is at work and nothing waits; `release` gives it back."""
        free = not self._taken
        self._taken = True
        return free

    def release(self) -> None:
        """The next may begin: the turn goes straight to it, so nobody can come in between."""
        while self._waiting:
            next_ = self._waiting.popleft()
            if not next_.done():
                next_.set_result(True)
                return
        self._taken = False

    async def wait(self, until: float | None = None) -> bool:
        """Take the turn once everything before this call has ended; return False if `until` comes
        first."""
        if self.take():
            return True
        loop = asyncio.get_running_loop()
        granted: asyncio.Future[bool] = loop.create_future()
        self._waiting.append(granted)

        def give_up() -> None:
            if not granted.done():
                self._waiting.remove(granted)
                granted.set_result(False)

        late = loop.call_later(left_until(until), give_up) if until is not None else None
        try:
            return await granted
        except asyncio.CancelledError:
            if granted.done() and not granted.cancelled() and granted.result():
                self.release()
            raise
        finally:
            if late is not None:
                late.cancel()

    async def run(self, work: Callable[[float | None], T], timeout: float | None) -> T:
        """As `in_thread`, once everything before it has ended, or `timeout` seconds are over.
        `work` gets those that are left of them, None for no limit."""
        until = moment(timeout)
        ours = await self.wait(until)
        left = None if until is None else left_until(until)
        return await in_thread(partial(work, left), self.release if ours else None)


def left_until(until: float) -> float:
    """Return the seconds until a moment of time.monotonic(), 0.0 if it has come."""
    return max(0.0, until - time.monotonic())
