"""Threads of connections wait for the loop: for room, and for answers."""

import asyncio
import gc

import pytest
from support.wait import HANG

import yarpy
from yarpy import aio


@pytest.fixture(autouse=True)
def names():
    with yarpy.NameServer():
        yield


def test_reader_that_is_slow_holds_the_sender_up_and_loses_nothing():
    async def main():
        async with aio.Port("/aio/in") as reader:
            with yarpy.Port("/aio/out") as writer:
                writer.connect("/aio/in")

                def write():
                    for number in range(200):
                        writer.write([number])

                work = asyncio.create_task(asyncio.to_thread(write))
                await asyncio.sleep(0.1)
                got = [(await reader.read(timeout=HANG)).value[0] for _ in range(200)]
                await work
                assert got == list(range(200))
                assert reader.stats.inputs[0].drops == 0

    asyncio.run(main())


def test_a_question_still_open_when_the_port_closes_gets_no_answer():
    async def main():
        async with aio.Port("/aio/service") as service:
            client = aio.RpcClient("/aio/service")
            call = asyncio.create_task(client.call("anybody"))
            message = await service.read(timeout=HANG)
            assert message.wants_reply
        with pytest.raises(yarpy.LinkClosed, match="nobody knows whether it has done"):
            await asyncio.wait_for(call, HANG)
        await client.close()

    asyncio.run(main())


def test_drops_of_latest_are_counted_on_their_connection():
    async def main():
        async with aio.BufferedPort("/aio/in") as reader:
            with yarpy.Port("/aio/out") as writer:
                writer.connect("/aio/in")

                def write():
                    for number in range(200):
                        writer.write([number])
                    writer.flush()

                await asyncio.to_thread(write)
                got = 0
                with pytest.raises(yarpy.Timeout):
                    while True:
                        await reader.read(timeout=0.2)
                        got += 1
                stats = reader.inputs[0].stats
                assert (stats.messages, stats.replaced) == (200, 200 - got)

    asyncio.run(main())


def test_question_that_everybody_forgot_gets_an_empty_answer():
    async def main():
        async with aio.Port("/aio/in") as reader, aio.RpcClient("/aio/in") as client:
            asking = asyncio.create_task(client.call("x", timeout=HANG))
            message = await reader.read(timeout=HANG)
            with pytest.raises(yarpy.Timeout):
                await reader.read(timeout=0.05)  # it may still be answered, by any task
            assert message.wants_reply
            del message
            gc.collect()
            assert await asking == []

    asyncio.run(main())
