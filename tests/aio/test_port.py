"""Ports in an event loop."""

import asyncio
import threading
import time

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarpy
from yarpy import aio


@pytest.fixture(autouse=True)
def names():
    with yarpy.NameServer():
        yield


def test_messages_are_awaited_and_iterated():
    async def main():
        async with (
            aio.Port("/aio/out") as writer,
            aio.BufferedPort("/aio/in", strict=True) as reader,
        ):
            await writer.connect("/aio/in")
            assert await writer.write(["hello", 1], yarpy.Stamp(1, 2.0)) == 1
            message = await reader.read(timeout=HANG)
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
            assert ((await reader.read(timeout=HANG)).value.array == 7).all()
            assert not array.flags.writeable

    asyncio.run(main())


def test_latest_keeps_the_newest_and_counts_the_others():
    async def main():
        async with aio.BufferedPort("/aio/in") as reader:
            async with aio.Port("/aio/out") as writer:
                await writer.connect("/aio/in")
                for number in range(20):
                    await writer.write([number], wait=True)
            assert (await reader.read(timeout=HANG)).value == [19]
            # Counted as past once its thread has met the end of the connection.
            await asyncio.to_thread(wait_until, lambda: reader.stats.past.inputs.replaced == 19)

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


def test_messages_of_several_tasks_leave_in_the_order_of_their_calls():
    async def main():
        async with aio.Port("/aio/out") as writer, aio.Port("/aio/in") as reader:
            await writer.connect("/aio/in")

            async def read():
                return [(await reader.read(timeout=HANG)).value[0] for _ in range(1000)]

            reading = asyncio.create_task(read())
            await asyncio.gather(*(writer.write([number]) for number in range(1000)))
            assert await reading == list(range(1000))

    asyncio.run(main())


def test_writing_that_is_cancelled_ends_and_the_next_write_works():
    async def main():
        async with aio.Port("/aio/out") as writer, aio.Port("/aio/in") as reader:
            await writer.connect("/aio/in")
            written = 0
            with pytest.raises(TimeoutError):
                while True:  # nobody reads: sooner or later a write waits
                    async with asyncio.timeout(1.0):
                        await writer.write([written])
                    written += 1

            async def read():
                found = []
                while found[-1:] != ["next"]:
                    found.append((await reader.read(timeout=HANG)).value[0])
                return found

            reading = asyncio.create_task(read())
            await asyncio.wait_for(writer.write(["next"]), HANG)
            found = await reading
            assert found[:written] == [*range(written)]
            left = found[written:-1]
            assert left in ([], [written])  # it may have begun to leave just then
            stats = writer.stats.outputs[0]
            assert (stats.messages, stats.drops) == (len(found), 1 - len(left))

    asyncio.run(main())


def test_loop_ends_though_a_write_was_cancelled_and_nothing_was_closed():
    async def main():
        writer, reader = await aio.Port("/aio/out").open(), await aio.Port("/aio/in").open()
        await writer.connect("/aio/in")
        with pytest.raises(TimeoutError):
            while True:
                async with asyncio.timeout(0.3):
                    await writer.write(b"x" * 100_000)
        return writer, reader

    started = time.monotonic()
    writer, reader = asyncio.run(main())
    assert lasted(started) < 10
    writer.port.close()
    reader.port.close()


def test_polling_and_waiting_need_no_await():
    async def main():
        async with (
            aio.Port("/aio/out") as writer,
            aio.BufferedPort("/aio/in", strict=True) as reader,
        ):
            assert reader.poll() is None
            await writer.connect("/aio/in")
            await writer.write([1])
            await writer.write([2], wait=True)
            assert reader.waiting == 2
            assert [reader.poll().value, reader.poll().value] == [[1], [2]]
            assert (reader.poll(), reader.waiting) == (None, 0)
            reader.read_strictly(False)
            await writer.write([3])
            assert (await reader.read(timeout=HANG)).value == [3]

    asyncio.run(main())


def test_interrupting_wakes_readers_and_writers_until_resumed():
    async def main():
        async with aio.Port("/aio/out") as writer, aio.Port("/aio/in") as reader:
            await writer.connect("/aio/in")
            reading = asyncio.create_task(reader.read())
            waiting = asyncio.create_task(reader.wait_for_inputs(7))
            await asyncio.sleep(0.05)
            reader.interrupt()
            for task in (reading, waiting):
                with pytest.raises(yarpy.PortClosed):
                    await task
            reader.resume()
            await writer.write([1])
            assert (await reader.read(timeout=HANG)).value == [1]

    asyncio.run(main())


def test_callback_runs_in_the_loop():
    async def main():
        heard = asyncio.Queue()

        async def hear(message):
            await asyncio.sleep(0)
            heard.put_nowait((message.value, threading.current_thread()))

        async with (
            aio.Port("/aio/out") as writer,
            aio.Port("/aio/in", callback=hear) as reader,
            aio.BufferedPort("/aio/late", callback=hear) as late,
        ):
            await writer.connect("/aio/in")
            await writer.write([1])
            assert await heard.get() == ([1], threading.main_thread())
            with pytest.raises(yarpy.PortClosed, match="callback"):
                await reader.read(timeout=1)
            await writer.disconnect("/aio/in")
            await writer.connect("/aio/late")
            await writer.write([2])
            assert (await heard.get())[0] == [2]
            assert late.contact.port

    asyncio.run(asyncio.wait_for(main(), 30))


def test_asking_all_connected_ports():
    async def main():
        async with (
            aio.Port("/aio/asker") as asker,
            aio.RpcServer("/aio/a", lambda message: ["a"]),
            aio.RpcServer("/aio/b", lambda message: ["b"]),
        ):
            await asker.connect("/aio/a", "tcp")
            await asker.connect("/aio/b", "tcp")
            answers = await asker.ask(["who"], timeout=HANG)
            assert [answer.value for answer in answers] == [["a"], ["b"]]

    asyncio.run(main())
