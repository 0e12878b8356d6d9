"""Opening, connecting and calling back in an event loop."""

import asyncio
import gc
import threading
import time
import urllib.request

import pytest
from support.wait import HANG

import yarpy
from yarpy import aio
from yarpy.link.begin.accept_loop import LOOP


@pytest.fixture(autouse=True)
def names():
    with yarpy.NameServer():
        yield


def test_a_port_says_which_it_is_and_how_it_is():
    async def main():
        for kind in (aio.Port, aio.BufferedPort):
            port = kind("/aio/said")
            called = f"<aio.{kind.__name__} /aio/said"
            assert repr(port) == f"{called} (not open)>"
            async with port:
                assert repr(port) == f"{called} ({port.address})>"
            assert repr(port) == f"{called} (closed)>"

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
        return [one for one in LOOP.listening if one.name == "/aio/in"]

    asyncio.run(main())


def test_port_opened_by_two_tasks_at_once_is_one():
    async def main():
        reader = aio.Port("/aio/in")
        await asyncio.gather(reader.open(), reader.open())
        await reader.close()
        assert yarpy.query("/aio/in") is None

    asyncio.run(main())


def test_connections_are_made_awaited_and_told_in_the_loop():
    async def main():
        heard: list[str] = []
        threads: set[int] = set()

        def hear(event: yarpy.ConnectionEvent) -> None:
            threads.add(threading.get_ident())
            heard.append(str(event))

        async with aio.BufferedPort("/aio/in", strict=True, on_connection=hear) as reader:
            async with aio.Port("/aio/out", port_type="yarp/bottle") as writer:
                assert not await reader.wait_for_inputs(timeout=0.05)
                await reader.listen_to("/aio/out", "fast_tcp")
                assert await reader.wait_for_inputs(timeout=HANG)
                assert await writer.wait_for_outputs(timeout=HANG)
                made = await writer.connect("/aio/in")
                assert (made.target, made.carrier) == ("/aio/in", "tcp")
                await writer.write([1])
                assert await writer.flush(10)
                assert (await reader.read(timeout=HANG)).value == [1]
                assert writer.stats.outputs[0].messages == 1
                assert yarpy.query("/aio/out") == writer.contact
            while len(heard) < 4:
                await asyncio.sleep(0.01)
        assert heard[0] == "Receiving input from /aio/out to /aio/in using fast_tcp"
        assert threads == {threading.get_ident()}

    asyncio.run(asyncio.wait_for(main(), 30))


def test_missed_deadlines_are_told_in_the_loop():
    async def main():
        heard = asyncio.Queue()
        threads = []

        def hear(event):
            threads.append(threading.current_thread())
            heard.put_nowait(event)

        async with aio.Port("/aio/in") as reader, aio.Port("/aio/out") as writer:
            await writer.connect("/aio/in")
            assert await reader.wait_for_inputs(timeout=HANG)
            reader.inputs[0].qos = yarpy.Qos(deadline=0.02)
            reader.on_deadline(hear)
            writer.port.write([1], yarpy.Stamp(1, time.time() - 0.5))
            event = await asyncio.wait_for(heard.get(), 10)
            assert (event.source, event.silent) == ("/aio/out", False)
            assert event.lateness > 0.4
            assert threads == [threading.main_thread()]
            reader.on_deadline(None)
            # First, for a write waits in this thread until the message before it was read.
            assert (await reader.read(timeout=HANG)).value == [1]
            writer.port.write([2], yarpy.Stamp(2, time.time() - 0.5))
            assert (await reader.read(timeout=HANG)).value == [2]
            assert heard.empty()

    asyncio.run(main())


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
                urllib.request.urlopen, f"http://{port.contact.address}/x", timeout=HANG
            )
            with page:
                assert page.read() == b"<h1>/x</h1>"
            port.on_admin(None)
            answered = await asyncio.to_thread(yarpy.admin, "/aio/asked", "who")
            assert answered[0] == "fail"
        assert threads == {threading.get_ident()}

    asyncio.run(asyncio.wait_for(main(), 30))


def test_a_connection_that_comes_when_its_task_was_cancelled_is_ended(monkeypatch):
    made, go_on = threading.Event(), threading.Event()

    async def main():
        async with aio.Port("/in") as in_, aio.Port("/out") as out:
            connect = out.port.connect

            def connect_slowly(*arguments):
                connection = connect(*arguments)
                made.set()
                assert go_on.wait(HANG)
                return connection

            monkeypatch.setattr(out.port, "connect", connect_slowly)
            task = asyncio.create_task(out.connect("/in", "tcp"))
            assert await asyncio.to_thread(made.wait, 20)
            assert out.outputs
            task.cancel()
            with pytest.raises(asyncio.CancelledError):
                await task
            go_on.set()
            deadline = time.monotonic() + 20
            while out.outputs:
                assert time.monotonic() < deadline
                await asyncio.sleep(0.001)
            assert await out.connect("/in", "tcp")
            assert await in_.wait_for_inputs(timeout=HANG)

    asyncio.run(main())


def test_an_opening_that_fails_after_it_was_cancelled_is_quiet():
    told = []

    async def main():
        asyncio.get_running_loop().set_exception_handler(lambda _, context: told.append(context))
        async with aio.Port("/same"):
            second = aio.Port("/same")
            opening = asyncio.create_task(second.open())
            await asyncio.sleep(0)
            opening.cancel()
            with pytest.raises(asyncio.CancelledError):
                await opening
            await second.close()  # waits for its end
            gc.collect()

    asyncio.run(main())
    assert told == []
