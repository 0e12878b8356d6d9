"""Ports in an event loop."""

import asyncio
import gc
import threading
import urllib.request

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


def test_a_full_inbox_holds_the_sender_up_and_loses_nothing():
    async def main():
        async with aio.Port("/aio/in", queue=4) as reader:
            with yarpy.Port("/aio/out") as writer:
                writer.connect("/aio/in")

                def write():
                    for number in range(200):
                        writer.write([number])

                work = asyncio.create_task(asyncio.to_thread(write))
                await asyncio.sleep(0.1)
                got = [(await reader.read(timeout=5)).value[0] for _ in range(200)]
                await work
                assert got == list(range(200))
                assert reader.drops == 0

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


def test_a_question_still_open_when_the_port_closes_gets_an_empty_answer():
    async def main():
        async with aio.Port("/aio/service") as service:
            client = aio.RpcClient("/aio/service")
            call = asyncio.create_task(client.call("anybody"))
            message = await service.read(timeout=2)
            assert message.wants_reply
        assert await asyncio.wait_for(call, 10) == []
        await client.close()

    asyncio.run(main())


def test_drops_of_latest_are_counted_on_their_connection():
    async def main():
        async with aio.Port("/aio/in", latest=True) as reader:
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
                assert (stats["messages"], stats["drops"]) == (200, 200 - got)
                assert reader.drops == 200 - got

    asyncio.run(main())


def test_cancelled_opening_leaves_no_port_behind():
    async def main():
        for patience in (0, 0.0005, 0.002, 0.005):
            reader = aio.Port("/aio/in")
            opening = asyncio.create_task(reader.open())
            await asyncio.sleep(patience)
            if opening.cancel():
                with pytest.raises(asyncio.CancelledError):
                    await opening
            await reader.close()
            for _ in range(2000):
                if yarpy.query("/aio/in") is None and not _open_ports():
                    break
                await asyncio.sleep(0.01)
            assert not _open_ports()

    def _open_ports():
        return [thread for thread in threading.enumerate() if thread.name == "yarpy /aio/in"]

    asyncio.run(main())


def test_port_opened_by_two_tasks_at_once_is_one():
    async def main():
        reader = aio.Port("/aio/in")
        await asyncio.gather(reader.open(), reader.open())
        await reader.close()
        assert yarpy.query("/aio/in") is None

    asyncio.run(main())


def test_question_that_everybody_forgot_gets_an_empty_answer():
    async def main():
        async with aio.Port("/aio/in") as reader, aio.RpcClient("/aio/in") as client:
            asking = asyncio.create_task(client.call("x", timeout=20))
            message = await reader.read(timeout=20)
            with pytest.raises(yarpy.Timeout):
                await reader.read(timeout=0.05)  # it may still be answered, by any task
            assert message.wants_reply
            del message
            gc.collect()
            assert await asking == []

    asyncio.run(main())


def test_connections_are_made_awaited_and_told_in_the_loop():
    async def main():
        heard: list[str] = []
        threads: set[int] = set()

        def hear(event: yarpy.ConnectionEvent) -> None:
            threads.add(threading.get_ident())
            heard.append(str(event))

        async with aio.Port("/aio/in", on_connection=hear) as reader:
            async with aio.Port("/aio/out", port_type="yarp/bottle") as writer:
                assert not await reader.wait_for_inputs(timeout=0.05)
                await reader.listen_to("/aio/out", "fast_tcp")
                assert await reader.wait_for_inputs(timeout=10)
                assert await writer.wait_for_outputs(timeout=10)
                made = await writer.connect("/aio/in")
                assert (made.target, made.carrier) == ("/aio/in", "tcp")
                await writer.write([1])
                assert await writer.flush(10)
                assert (await reader.read(timeout=10)).value == [1]
                assert writer.stats["outputs"][0]["messages"] == 1
                assert yarpy.query("/aio/out") == writer.contact
            while len(heard) < 4:
                await asyncio.sleep(0.01)
        assert heard[0] == "Receiving input from /aio/out to /aio/in using fast_tcp"
        assert threads == {threading.get_ident()}

    asyncio.run(asyncio.wait_for(main(), 30))


def test_server_answers_from_the_loop_side_by_side(caplog):
    async def main():
        both = asyncio.Barrier(2)
        threads: set[int] = set()

        async def answer(message: yarpy.Message) -> object:
            threads.add(threading.get_ident())
            if message.value == ["fail"]:
                raise ValueError("as it was asked to")
            async with asyncio.timeout(10):
                await both.wait()  # the other question is being answered too
            return ["heard", *message.value]

        async with (
            aio.RpcServer("/aio/server", answer) as server,
            aio.RpcClient("/aio/server") as one,
            aio.RpcClient("/aio/server", name="/aio/two") as two,
        ):
            assert await asyncio.gather(one.call("a"), two.call("b")) == [
                ["heard", "a"],
                ["heard", "b"],
            ]
            assert (await one.call("fail"))[0] == "fail"
            assert "/aio/two" in [each.name for each in server.inputs]
            assert threads == {threading.get_ident()}

    asyncio.run(asyncio.wait_for(main(), 30))
    assert "as it was asked to" in caplog.text


def test_server_takes_plain_functions_and_closes_over_a_question():
    async def main():
        asked = asyncio.Event()

        async def never(message: yarpy.Message) -> object:
            asked.set()
            return await asyncio.Event().wait()

        async with (
            aio.RpcServer("/aio/plain", lambda message: message.value),
            aio.RpcClient("/aio/plain") as client,
        ):
            assert await client.call("x") == ["x"]
        server = await aio.RpcServer("/aio/slow", never).open()
        async with aio.RpcClient("/aio/slow") as client:
            call = asyncio.create_task(client.call("x"))
            await asked.wait()
            await server.close()
            try:
                assert (await call)[0] == "fail"
            except yarpy.LinkClosed:
                pass  # it was closed before its answer had left

    asyncio.run(asyncio.wait_for(main(), 30))


def test_administrative_messages_and_pages_are_answered_in_the_loop():
    async def main():
        threads: set[int] = set()

        async def answer(message: yarpy.Message) -> object:
            threads.add(threading.get_ident())
            return ["mine"]

        async with aio.Port("/aio/asked") as port:
            port.on_admin(answer)
            port.on_page(lambda path, fields: f"<h1>{path}</h1>")
            assert await asyncio.to_thread(yarpy.admin, "/aio/asked", "who") == ["mine"]
            page = await asyncio.to_thread(
                urllib.request.urlopen, f"http://{port.contact.address}/x", timeout=10
            )
            with page:
                assert page.read() == b"<h1>/x</h1>"
            port.on_admin(None)
            answered = await asyncio.to_thread(yarpy.admin, "/aio/asked", "who")
            assert answered[0] == "fail"
        assert threads == {threading.get_ident()}

    asyncio.run(asyncio.wait_for(main(), 30))
