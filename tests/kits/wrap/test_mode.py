"""The modes, between objects that stand for programs, over YARP."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import numpy as np
import pytest
from support.wait import HANG, inside, wait_until

import yarpy
from yarpy.kits import wrap


class Eyes:
    @wrap.on("/eyes/left")
    @wrap.on("/eyes/info")
    def look(self, gain: float = 1.0) -> tuple[np.ndarray, dict]:
        return np.full((4, 8, 3), int(gain), "u1"), {"gain": gain}

    @wrap.on("/eyes/sum")
    def add(self, a: int, b: int = 2) -> int:
        if a < 0:
            raise ValueError("negative")
        return a + b

    @wrap.on("/eyes/slow")
    async def add_slowly(self, a: int) -> int:
        await asyncio.sleep(0.01)
        return a + 1

    @wrap.on("/eyes/double", source="/eyes/number")
    def double(self, number: int, factor: int = 2) -> int:
        return number * factor

    @wrap.on("/eyes/number", source="/eyes/double")
    def number(self, value: int = 1) -> int:
        return value

    @wrap.on("/eyes/count", keep="all")
    def count(self, end: int = 3) -> Iterator[int]:
        yield from range(end)

    @wrap.on("/eyes/later", keep="all")
    async def count_later(self, end: int = 3) -> AsyncIterator[int]:
        for number in range(end):
            yield number


@contextmanager
def again(act: Callable[[], Any]) -> Iterator[None]:
    """Call it again and again, in a thread, as a program with a loop does."""
    done = threading.Event()

    def run() -> None:
        while not done.wait(0.01):
            act()

    thread = threading.Thread(target=run)
    thread.start()
    yield
    done.set()
    thread.join(HANG)


pytestmark = pytest.mark.usefixtures("names")


def test_publish_and_listen() -> None:
    here, there = Eyes(), Eyes()
    with wrap.publish(here.look), wrap.listen(there.look), again(lambda: here.look(3.0)):
        frame, info = there.look(timeout=HANG)
        assert frame.shape == (4, 8, 3) and frame[0, 0, 0] == 3 and info == {"gain": 3.0}
        last = wrap.last(there.look)
        assert last[0].stamp.time == pytest.approx(time.time(), abs=60)
        assert last[0].source == "/eyes/left" and last[1].middleware == "yarp"
    assert here.look(2.0)[1] == {"gain": 2.0}  # ordinary methods again
    assert there.look()[1] == {"gain": 1.0}


def test_nobody_publishes() -> None:
    eyes = Eyes()
    with wrap.listen(eyes.look), pytest.raises(yarpy.Timeout, match=r'"/eyes/left" within 0.05 s'):
        eyes.look(timeout=0.05)
    with wrap.listen(eyes.look) as handle:
        closing = inside("Listen.run", handle.close)
        with pytest.raises(yarpy.PortClosed):
            handle()
        closing.join(HANG)


def test_serve_and_call() -> None:
    here, there = Eyes(), Eyes()
    with wrap.serve(here.add), wrap.call(there.add) as ask:
        assert there.add(1) == 3 and ask(1, b=5) == 6 and here.add(4) == 6
        with pytest.raises(wrap.RemoteError, match="ValueError: negative") as caught:
            there.add(-1)
        assert (caught.value.type, caught.value.text) == ("ValueError", "negative")
        with pytest.raises(TypeError, match='the argument "a"'):
            there.add("x")  # type: ignore[arg-type]
        with pytest.raises(TypeError):
            there.add()  # type: ignore[call-arg]
        assert there.add(1) == 3  # the server lives


def test_call_of_nobody() -> None:
    with wrap.call(Eyes().add) as ask:
        with pytest.raises(yarpy.UnknownName):
            ask(1)
        with pytest.raises(yarpy.UnknownName):
            ask(1, timeout=0.1)


def test_server_that_comes_late_is_waited_for() -> None:
    here, there = Eyes(), Eyes()
    opened: list[wrap.Handle] = []
    with wrap.call(there.add):
        threading.Timer(0.1, lambda: opened.append(wrap.serve(here.add))).start()
        assert there.add(1, timeout=HANG) == 3
        wait_until(lambda: opened)  # it answers before it is told that it does
    opened[0].close()


def test_call_in_an_event_loop_has_many_on_their_way() -> None:
    here, there = Eyes(), Eyes()

    async def main() -> None:
        with wrap.serve(here.add_slowly), wrap.call(there.add_slowly):
            assert await asyncio.gather(*map(there.add_slowly, range(5))) == [1, 2, 3, 4, 5]
            assert await here.add_slowly(1) == 2

    asyncio.run(main())
    with wrap.serve(here.add_slowly), wrap.call(there.add_slowly):  # a server without a loop
        assert asyncio.run(there.add_slowly(7)) == 8


def test_relay_and_receive() -> None:
    source, relay, end = Eyes(), Eyes(), Eyes()
    with (
        wrap.publish(source.number),
        wrap.relay(relay.double),
        wrap.listen(end.double),
        again(lambda: source.number(21)),
    ):
        assert relay.double(timeout=HANG) == 42
        with again(lambda: relay.double(factor=3, timeout=HANG)):
            assert end.double(timeout=HANG) in (42, 63)
    with wrap.publish(source.number), wrap.receive(relay.double), again(lambda: source.number(5)):
        assert relay.double(timeout=HANG) == 10


def test_exchange() -> None:
    here, there = Eyes(), Eyes()
    found: list[int] = []

    def exchanged() -> bool:
        try:
            found.append(here.number(4, timeout=0.05))
        except yarpy.Timeout:
            return False
        return True

    def relay() -> None:
        with suppress(yarpy.Timeout):
            there.double(timeout=0.05)

    with wrap.exchange(here.number), wrap.relay(there.double), again(relay):
        wait_until(exchanged)
    assert found == [8]
    with pytest.raises(yarpy.LocalProtocolError, match="would hear itself"):
        wrap.exchange(here.add)


def test_off() -> None:
    eyes = Eyes()
    with wrap.off(eyes.look), wrap.off(eyes.add), wrap.off(eyes.count):
        assert eyes.look() == (None, None) and eyes.add(1) is None and [*eyes.count()] == []
    assert eyes.add(1) == 3


def test_generators() -> None:
    here, there = Eyes(), Eyes()
    with wrap.publish(here.count) as out, wrap.listen(there.count):
        wait_until(lambda: out.stats[0]["outputs"])
        assert [*here.count(3)] == [0, 1, 2]
        stream = there.count(timeout=HANG)
        assert [next(stream) for _ in range(3)] == [0, 1, 2]
        with pytest.raises(yarpy.Timeout):
            next(there.count(timeout=0.01))
    with pytest.raises(yarpy.LocalProtocolError, match="serve needs a function"):
        wrap.serve(here.count)


def test_streams_in_an_event_loop() -> None:
    here, there = Eyes(), Eyes()

    async def main() -> None:
        found = []
        with wrap.publish(here.count_later) as out, wrap.listen(there.count_later) as into:
            while not out.stats[0]["outputs"]:
                await asyncio.sleep(0.01)
            assert [number async for number in here.count_later(3)] == [0, 1, 2]
            async for number in wrap.stream(there.count_later, timeout=HANG):
                found.append(number)
                if number == 2:
                    into.close()  # which ends the loop
        assert found == [0, 1, 2]

    asyncio.run(main())
    with wrap.publish(here.add), pytest.raises(yarpy.LocalProtocolError, match="set to publish"):
        wrap.stream(here.add)


def test_listening_does_not_block_the_loop() -> None:
    class Ear:
        @wrap.on("/ear")
        async def hear(self) -> str:
            return "word"

    here, there = Ear(), Ear()

    async def main() -> None:
        with wrap.publish(here.hear), wrap.listen(there.hear):
            task = asyncio.create_task(there.hear(timeout=HANG))
            while not task.done():
                await here.hear()
                await asyncio.sleep(0.01)
            assert task.result() == "word"
            for _ in range(100):  # what else was published before
                try:
                    await there.hear(timeout=0.05)
                except yarpy.Timeout:
                    break
            waiting = asyncio.create_task(there.hear())
            await asyncio.sleep(0.02)
            waiting.cancel()
            with pytest.raises(asyncio.CancelledError):
                await waiting

    asyncio.run(main())
