"""From other threads into the loop: tasks that wait for what happens there.

Rules: a thread only says that something happened; tasks look for themselves, so nothing is lost
between the thread and a task that was cancelled.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Final, TypeVar

from yarpy.scope import moment

T = TypeVar("T")

LONGEST_RUN: Final = 64  # times that a task finds something at once before others may run


class Wakeup:
    """Tasks of one loop that wait for the same thing."""

    def __init__(self) -> None:
        self._waiting: list[asyncio.Future[None]] = []
        self._loop: asyncio.AbstractEventLoop | None = None
        self._called = False  # `_wake` will run
        self._run = 0

    def notify(self) -> None:
        """Let the tasks look again; any thread may call."""
        if self._waiting and not self._called and self._loop is not None:
            self._called = True
            try:
                self._loop.call_soon_threadsafe(self._wake)
            except RuntimeError:
                pass  # the loop is closed, and its tasks are gone

    def _wake(self) -> None:
        self._called = False
        waiting, self._waiting = self._waiting, []
        for one in waiting:
            if not one.done():
                one.set_result(None)

    async def wait_for(self, look: Callable[[], T | None], timeout: float | None) -> T | None:
        """Return what `look` returns as soon as that is not None; None after `timeout` seconds."""
        if self._run >= LONGEST_RUN:
            self._run = 0
            await asyncio.sleep(0)  # before looking: what was found is not lost to a cancelled task
        found = look()
        if found is not None:
            self._run += 1
            return found
        if timeout is not None:
            moment(timeout)  # TypeError, in plain words, for what is no number
            if timeout <= 0:
                return None
        self._run = 0
        if timeout is None:
            return await self._wait(look)
        limit = asyncio.timeout(timeout)
        try:
            async with limit:
                return await self._wait(look)
        except TimeoutError:
            if limit.expired():
                return None
            raise

    async def _wait(self, look: Callable[[], T | None]) -> T:
        self._loop = asyncio.get_running_loop()
        while True:
            woken: asyncio.Future[None] = self._loop.create_future()
            self._waiting.append(woken)  # before looking: what comes now finds it
            try:
                found = look()
                if found is not None:
                    return found
                await woken
            finally:
                if not woken.done() or woken.cancelled():
                    self._forget(woken)

    def _forget(self, woken: asyncio.Future[None]) -> None:
        if woken in self._waiting:
            self._waiting.remove(woken)
