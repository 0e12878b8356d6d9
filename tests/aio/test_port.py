"""Ports in an event loop."""

import asyncio

import pytest

import yarpy
from yarpy import aio


@pytest.fixture(autouse=True)
def names():
    with yarpy.NameServer():
        yield


def test_messages_are_awaited_and_iterated():
    async def main():
        async with aio.Port("/aio/out") as writer, aio.Port("/aio/in") as reader:
            await writer.connect("/aio/in")
            assert await writer.write(["hello", 1], yarpy.Stamp(1, 2.0)) == 1
            message = await reader.read(timeout=2)
            assert message.value == ["hello", 1]
            assert message.stamp == yarpy.Stamp(1, 2.0)
            for number in range(100):
                await writer.write([number])
            got = []
            async for message in reader:
                got.append(message.value[0])
                if len(got) == 100:
                    break
            assert got == list(range(100))

    asyncio.run(main())


def test_arrays_are_prepared():
    async def main():
        async with aio.Port("/aio/out") as writer, aio.Port("/aio/in") as reader:
            await writer.connect("/aio/in")
            array = writer.prepare((200, 400))
            array[...] = 7
            await writer.write(array)
            assert ((await reader.read(timeout=2)).value.array == 7).all()
            assert not array.flags.writeable

    asyncio.run(main())


def test_latest_keeps_the_newest_and_counts_the_others():
    async def main():
        async with aio.Port("/aio/in", latest=True) as reader:
            async with aio.Port("/aio/out") as writer:
                await writer.connect("/aio/in")
                for number in range(20):
                    await writer.write([number], wait=True)
            assert (await reader.read(timeout=2)).value == [19]
            assert reader.drops == 19

    asyncio.run(main())


def test_questions_are_answered_from_the_loop():
    async def main():
        async with aio.Port("/aio/service") as service, aio.RpcClient("/aio/service") as client:

            async def serve():
                async for message in service:
                    message.reply(["sum", sum(message.value)])

            task = asyncio.create_task(serve())
            answers = await asyncio.gather(*(client.call(n, n) for n in range(10)))
            assert answers == [["sum", 2 * n] for n in range(10)]
            task.cancel()

    asyncio.run(main())


def test_reading_times_out_and_closing_wakes_the_reader():
    async def main():
        port = aio.Port("/aio/in")
        with pytest.raises(yarpy.PortClosed, match="not open"):
            await port.read()
        await port.open()
        with pytest.raises(yarpy.Timeout, match=r"0\.05 s"):
            await port.read(timeout=0.05)
        reading = asyncio.create_task(port.read())
        await asyncio.sleep(0.05)
        await port.close()
        with pytest.raises(yarpy.PortClosed):
            await reading

    asyncio.run(main())
