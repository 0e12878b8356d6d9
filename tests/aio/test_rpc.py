"""Questions and answers in an event loop."""

import asyncio
import threading
from urllib.request import urlopen

import pytest

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
            assert (await one.call("fail"))[0] == "fail"
            answers = await asyncio.gather(one.ask(["a"]), two.ask(["b"]))
            assert [answer.value for answer in answers] == [["heard", "a"], ["heard", "b"]]
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
            page = await asyncio.to_thread(lambda: urlopen(f"http://{address}/", timeout=10).read())
            assert page == b"<p>mine</p>"

    asyncio.run(main())
