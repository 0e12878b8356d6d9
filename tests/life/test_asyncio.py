"""Ports of an event loop: what a task cancels ends alone, and nothing waits for a free thread."""

from __future__ import annotations

import asyncio
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy import aio


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


asked_slowly = threading.Event()


async def answer(message: yarpy.Message) -> object:
    if message.value == ["slow"]:
        asked_slowly.set()
        await asyncio.Event().wait()
    return message.value


def test_servers_that_ask_each_other_need_no_thread_of_the_loop_s(names: yarpy.LocalNames) -> None:
    """Eight clients of a server that calls another one used up the threads of the loop."""

    async def main() -> None:
        loop = asyncio.get_running_loop()
        loop.set_default_executor(executor)
        taken = loop.run_in_executor(None, over.wait)  # the only thread that it has

        async def hand_on(message: yarpy.Message) -> object:
            async with aio.RpcClient("/far", names=names) as client:
                return await client.call(*message.value)

        async with (
            aio.RpcServer("/far", answer, names=names),
            aio.RpcServer("/near", hand_on, names=names),
        ):
            clients = [aio.RpcClient("/near", names=names) for _ in range(8)]
            answers = await asyncio.gather(
                *(client.call(number) for number, client in enumerate(clients))
            )
            assert answers == [[number] for number in range(8)]
            await asyncio.gather(*(client.close() for client in clients))
        over.set()
        await taken

    over = threading.Event()
    with ThreadPoolExecutor(1) as executor:
        try:
            asyncio.run(asyncio.wait_for(main(), HANG))
        finally:
            over.set()


def test_a_call_that_is_cancelled_ends_alone(names: yarpy.LocalNames) -> None:
    async def main() -> None:
        async with (
            aio.RpcServer("/server", answer, names=names),
            aio.RpcClient("/server", names=names) as client,
        ):
            for number in range(3):
                with pytest.raises(TimeoutError):
                    await asyncio.wait_for(client.call("slow"), 0.05)
                assert await client.call(number) == [number]

    asyncio.run(asyncio.wait_for(main(), HANG))


def test_the_loop_ends_though_calls_and_writes_wait_for_ever(names: yarpy.LocalNames) -> None:
    async def main() -> tuple[object, ...]:
        server = await aio.RpcServer("/server", answer, names=names).open()
        client = await aio.RpcClient("/server", names=names).open()
        into, out = aio.Port("/in", names=names), aio.Port("/out", names=names)
        await into.open()
        await out.open()
        await out.connect("/in")
        for endless in (client.call("slow"), out.write(bytes(1 << 24), wait=True)):
            with pytest.raises(TimeoutError):
                await asyncio.wait_for(endless, 0.1)
        return server, client, into, out

    loop = threading.Thread(target=lambda: left.extend(asyncio.run(main())), daemon=True)
    left: list[aio.Port] = []
    loop.start()
    loop.join(HANG)
    assert not loop.is_alive()
    for end in left:
        assert end.port is not None
        end.port.close()


def test_messages_leave_in_the_order_of_their_calls(names: yarpy.LocalNames) -> None:
    async def main() -> None:
        async with aio.Port("/out", names=names) as out:
            await out.connect("/in")
            await asyncio.gather(*(out.write([number]) for number in range(1000)))

    with yarpy.BufferedPort("/in", strict=True, names=names) as into:
        asyncio.run(asyncio.wait_for(main(), HANG))
        wait_until(lambda: into.waiting == 1000, HANG)
        assert [into.read(HANG).value[0] for _ in range(1000)] == [*range(1000)]


def test_the_time_limit_of_a_write_counts_while_an_earlier_one_waits(
    names: yarpy.LocalNames,
) -> None:
    async def main() -> None:
        async with aio.Port("/in", names=names), aio.Port("/out", names=names) as out:
            await out.connect("/in")
            endless = asyncio.create_task(out.write(bytes(1 << 24), wait=True))
            await asyncio.sleep(0)
            assert await asyncio.wait_for(out.write([1], timeout=0.05), HANG) == 0
            assert out.stats.outputs[0].drops == 1
            endless.cancel()

    asyncio.run(main())


@pytest.mark.parametrize("verb", ["call", "ask", "tell"])
def test_the_time_limit_of_a_question_counts_while_an_earlier_one_waits(
    names: yarpy.LocalNames, verb: str
) -> None:
    async def main() -> None:
        async with (
            aio.RpcServer("/server", answer, names=names),
            aio.RpcClient("/server", names=names) as client,
        ):
            await client.open()
            asked_slowly.clear()
            endless = asyncio.create_task(client.call("slow"))
            await asyncio.to_thread(asked_slowly.wait, HANG)
            with pytest.raises(yarpy.Timeout, match="earlier question"):
                await asyncio.wait_for(getattr(client, verb)("quick", timeout=0.3), HANG)
            endless.cancel()

    asyncio.run(main())
