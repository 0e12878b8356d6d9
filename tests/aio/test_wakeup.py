"""Tasks that wait for what happens in other threads."""

import asyncio
import threading
from collections import deque
from functools import partial

import pytest

from yarpy.aio.wakeup import LONGEST_RUN, Wakeup


def take(items):
    return items.popleft() if items else None


def test_everything_is_found_once_by_many_tasks():
    async def main():
        wakeup, items, found = Wakeup(), deque(), []

        async def collect():
            while (item := await wakeup.wait_for(lambda: take(items), 20)) != "end":
                found.append(item)
            items.append("end")
            wakeup.notify()

        def produce():
            for number in range(2000):
                items.append(number)
                wakeup.notify()
            items.append("end")
            wakeup.notify()

        tasks = [asyncio.create_task(collect()) for _ in range(5)]
        await asyncio.sleep(0)
        thread = threading.Thread(target=produce)
        thread.start()
        await asyncio.gather(*tasks)
        thread.join()
        assert sorted(found) == list(range(2000))

    asyncio.run(main())


def test_time_limits_and_errors():
    def fail():
        raise KeyError("x")

    async def main():
        wakeup = Wakeup()
        assert await wakeup.wait_for(lambda: None, 0) is None
        assert await wakeup.wait_for(lambda: None, 0.01) is None
        assert await wakeup.wait_for(lambda: 1, 0) == 1
        with pytest.raises(KeyError):
            await wakeup.wait_for(fail, 1)
        assert not wakeup._waiting

    asyncio.run(main())


def test_nothing_is_lost_to_a_task_that_is_cancelled():
    async def main():
        for _ in range(50):
            wakeup, items = Wakeup(), deque()
            tasks = [asyncio.create_task(wakeup.wait_for(partial(take, items), 20)) for _ in "ab"]
            await asyncio.sleep(0)
            items.append(1)
            wakeup.notify()
            tasks[0].cancel()  # it is waiting still
            found = await asyncio.gather(*tasks, return_exceptions=True)
            assert found[1] == 1

    asyncio.run(asyncio.wait_for(main(), 30))


def test_finding_something_every_time_lets_other_tasks_run():
    async def main():
        wakeup, turns = Wakeup(), 0

        async def other():
            nonlocal turns
            while True:
                turns += 1
                await asyncio.sleep(0)

        task = asyncio.create_task(other())
        for _ in range(10 * LONGEST_RUN):
            await wakeup.wait_for(lambda: 1, None)
        task.cancel()
        assert turns >= 9

    asyncio.run(main())


def test_a_time_limit_that_is_no_number():
    async def main():
        with pytest.raises(TypeError, match="a time limit is a number of seconds or None, not '1'"):
            await Wakeup().wait_for(lambda: None, "1")

    asyncio.run(main())
