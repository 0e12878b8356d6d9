"""Questions and answers in an event loop."""

import asyncio
import threading
import time
from urllib.request import urlopen

import pytest
from support.lasted import lasted
from support.wait import HANG

import yarpy
from yarpy import aio


@pytest.fixture(autouse=True)
def names():
    with yarpy.NameServer():
        yield


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
            with pytest.raises(yarpy.RemoteError, match="ValueError: as it was asked to"):
                await one.call("fail")
            answers = await asyncio.gather(one.ask(["a"]), two.ask(["b"]))
            assert [answer.value for answer in answers] == [["heard", "a"], ["heard", "b"]]
            assert "/aio/two" in [each.name for each in server.inputs]
            assert threads == {threading.get_ident()}

    asyncio.run(asyncio.wait_for(main(), 30))
    assert "as it was asked to" in caplog.text


def test_what_a_handler_waits_for_is_cancelled_and_the_server_lives():
    async def main():
        async def answer(message: yarpy.Message) -> object:
            if message.value == ["wait"]:
                work = asyncio.create_task(asyncio.sleep(HANG))
                work.cancel()
                await work
            return message.value

        async with (
            aio.RpcServer("/aio/server", answer),
            aio.RpcClient("/aio/server") as client,
        ):
            with pytest.raises(yarpy.RemoteError, match="RuntimeError: the handler was cancelled"):
                await client.call("wait")
            assert await client.call("next") == ["next"]

    asyncio.run(asyncio.wait_for(main(), HANG))


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
            with pytest.raises(yarpy.LinkClosed, match="nobody knows whether it has done"):
                await call

    asyncio.run(asyncio.wait_for(main(), 30))


def test_tell_and_pages():
    heard: list[object] = []

    class Handler:
        async def __call__(self, message: yarpy.Message) -> None:
            heard.append(message.value)

        def page(self, path: str, fields: object) -> str:
            return "<p>mine</p>"

    async def main():
        async with (
            aio.RpcServer("/aio/server", Handler()) as server,
            aio.RpcClient("/aio/server") as client,
        ):
            await client.tell(["go", 1])
            await client.call("and")
            assert heard == [["go", 1], ["and"]]
            address = server.port.address
            page = await asyncio.to_thread(
                lambda: urlopen(f"http://{address}/", timeout=HANG).read()
            )
            assert page == b"<p>mine</p>"

    asyncio.run(main())


async def slowly(message):
    if message.value == ["slow"]:
        await asyncio.Event().wait()
    return message.value


def test_call_that_is_cancelled_ends_and_the_next_call_works():
    async def main():
        async with aio.RpcServer("/aio/server", slowly), aio.RpcClient("/aio/server") as client:
            for number in range(5):
                with pytest.raises(TimeoutError):
                    await asyncio.wait_for(client.call("slow"), 0.05)
                assert await asyncio.wait_for(client.call(number), 10) == [number]
            waiting = [asyncio.create_task(client.call("slow")) for _ in range(4)]
            last = asyncio.create_task(client.call("last"))
            await asyncio.sleep(0.05)
            for task in reversed(waiting):
                task.cancel()
            assert await asyncio.wait_for(last, 10) == ["last"]
            assert all(task.cancelled() for task in waiting)

    asyncio.run(asyncio.wait_for(main(), 60))


def test_loop_ends_though_a_call_was_cancelled_and_nothing_was_closed():
    async def main():
        server = await aio.RpcServer("/aio/server", slowly).open()
        client = await aio.RpcClient("/aio/server").open()
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(client.call("slow"), 0.1)
        return server, client

    started = time.monotonic()
    server, client = asyncio.run(main())
    assert lasted(started) < 10
    client.port.close()
    server.port.close()


def test_servers_that_ask_other_servers_do_not_wait_for_a_free_thread():
    async def main(clients=24):
        between = aio.RpcClient("/aio/inner", name="/aio/between")

        async def pass_on(message):
            return await between.call(*message.value)

        async with (
            aio.RpcServer("/aio/inner", lambda message: message.value),
            between,
            aio.RpcServer("/aio/outer", pass_on),
        ):
            callers = [aio.RpcClient("/aio/outer") for _ in range(clients)]
            answers = await asyncio.gather(
                *(caller.call(number) for number, caller in enumerate(callers))
            )
            assert answers == [[number] for number in range(clients)]
            await asyncio.gather(*(caller.close() for caller in callers))

    asyncio.run(asyncio.wait_for(main(), 60))


def test_a_thousand_calls_at_once():
    async def main():
        async with aio.RpcServer("/aio/server", lambda message: message.value):
            clients = [aio.RpcClient("/aio/server") for _ in range(100)]
            for client in clients:  # each greeting has a time limit, whatever others do beside it
                await client.call("here")
            answers = await asyncio.gather(
                *(clients[number % 100].call(number) for number in range(1000))
            )
            assert answers == [[number] for number in range(1000)]
            await asyncio.gather(*(client.close() for client in clients))

    asyncio.run(asyncio.wait_for(main(), 100))


def test_question_after_the_loop_has_ended_is_answered():
    async def main():
        return await aio.RpcServer("/aio/server", slowly).open()

    server = asyncio.run(main())
    with (
        yarpy.RpcClient("/aio/server") as client,
        pytest.raises(yarpy.RemoteError, match="loop of this port has ended"),
    ):
        client.call("x", timeout=HANG)
    server.port.close()


def test_client_that_is_closed_stays_closed():
    async def main():
        client = aio.RpcClient("/aio/nobody")
        await client.close()
        assert client.closed
        with pytest.raises(yarpy.PortClosed, match="closed"):
            await client.call("x")

    asyncio.run(main())
