"""Rows of calls: connecting in a callback, closing twice, a client of two threads, and how many
connections `yarpy.connect` makes."""

from __future__ import annotations

import socket
import sys
import threading
import time

import pytest

import yarpy
from yarpy.names.client import YarpNameClient

HANG = 20.0  # seconds


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


def test_a_callback_of_a_connection_may_connect_again(names: yarpy.LocalNames) -> None:
    events: list[bool] = []

    def back(event: yarpy.ConnectionEvent) -> None:
        events.append(event.created)
        if not event.created and len(events) < 4:
            port.connect("/b")

    with (
        yarpy.Port("/b", names=names),
        yarpy.Port("/a", names=names, on_connection=back) as port,
    ):
        port.connect("/b")
        over = threading.Event()

        def again() -> None:
            port.connect("/b")  # the first one ends, and `back` connects in between
            over.set()

        threading.Thread(target=again, daemon=True).start()
        assert over.wait(HANG)
        assert [output.name for output in port.outputs] == ["/b"]


def test_a_callback_of_a_connection_may_do_anything(names: yarpy.LocalNames) -> None:
    done: list[str] = []

    def call(event: yarpy.ConnectionEvent) -> None:
        if not event.created or done:
            return
        done.append("begun")
        port.write([1])
        port.connect("/c")
        port.disconnect("/c")
        port.listen_to("/c")
        port.wait_for_outputs(timeout=0.1)
        port.flush(timeout=0.1)
        port.interrupt()
        port.resume()
        port.close()
        done.append("closed")

    with (
        yarpy.BufferedPort("/b", names=names),
        yarpy.BufferedPort("/c", names=names),
        yarpy.Port("/a", names=names, on_connection=call) as port,
    ):
        with pytest.raises(yarpy.PortClosed):
            port.connect("/b")
        assert done == ["begun", "closed"]


def test_a_close_that_was_cut_is_finished_by_the_next(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    with yarpy.Port("/b", names=names):
        port = yarpy.Port("/a", names=names)
        port.connect("/b")
        hub = port._hub
        real, cuts = hub.actions.close_output, []

        def cut(hub: object, link: object) -> None:
            cuts.append(link)
            if len(cuts) == 1:
                raise KeyboardInterrupt
            real(hub, link)  # type: ignore[arg-type]

        object.__setattr__(hub, "actions", _with(hub.actions, close_output=cut))
        with pytest.raises(KeyboardInterrupt):
            port.close()
        assert names.query("/a") is None  # what comes behind the cut is done all the same
        assert not _listens(port)
        port.close()
        assert len(cuts) == 2
        assert not port.outputs


def _with(actions: object, **changes: object) -> object:
    from dataclasses import replace

    return replace(actions, **changes)  # type: ignore[type-var]


def _listens(port: yarpy.Port) -> bool:
    try:
        socket.create_connection(("127.0.0.1", port.contact.port), 1.0).close()
    except OSError:
        return False
    return True


def test_a_second_close_returns_when_the_port_is_closed(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/b", names=names):
        for _ in range(10):
            port = yarpy.Port("/a", names=names)
            port.connect("/b")
            threads = [threading.Thread(target=port.close) for _ in range(4)]
            for thread in threads:
                thread.start()
            port.close()
            assert names.query("/a") is None
            assert not _listens(port)
            for thread in threads:
                thread.join(HANG)


def test_a_question_that_never_left_is_asked_after_one_that_took_too_long(
    names: yarpy.LocalNames,
) -> None:
    go_on = threading.Event()
    heard: list[object] = []

    def handle(message: yarpy.Message) -> object:
        heard.append(message.value[0])
        if message.value[0] == "slow":
            go_on.wait(HANG)
        return message.value

    with (
        yarpy.RpcServer("/s", handle, names=names),
        yarpy.RpcClient("/s", names=names) as client,
    ):
        answers: list[object] = []

        def slow() -> None:
            try:
                client.call("slow", timeout=0.3)
            except yarpy.Timeout as error:
                answers.append(error)

        def quick() -> None:
            answers.append(client.call("quick", timeout=HANG))

        first = threading.Thread(target=slow)
        first.start()
        while not heard:
            time.sleep(0.001)
        second = threading.Thread(target=quick)
        second.start()
        first.join(HANG)
        second.join(HANG)
        go_on.set()
        assert isinstance(answers[0], yarpy.Timeout)
        assert answers[1] == ["quick"]
        assert heard.count("quick") == 1


def test_a_question_that_left_is_in_doubt_and_is_not_asked_again(names: yarpy.LocalNames) -> None:
    heard: list[object] = []

    def handle(message: yarpy.Message) -> object:
        heard.append(message.value[0])
        for link in server.inputs:
            link._link.driver.transport.interrupt()  # type: ignore[attr-defined]
        return "never arrives"

    with (
        yarpy.RpcServer("/s", handle, names=names) as server,
        yarpy.RpcClient("/s", names=names) as client,
    ):
        with pytest.raises(yarpy.LinkClosed, match="nobody knows whether it has done"):
            client.call("x", timeout=HANG)
        assert heard == ["x"]


@pytest.mark.parametrize("end", ["interrupt", "close"])
def test_a_call_that_runs_ends_with_its_client(end: str, names: yarpy.LocalNames) -> None:
    asked, go_on = threading.Event(), threading.Event()

    def handle(message: yarpy.Message) -> object:
        asked.set()
        go_on.wait(HANG)
        return 1

    with (
        yarpy.RpcServer("/s", handle, names=names),
        yarpy.RpcClient("/s", names=names) as client,
    ):
        errors: list[BaseException] = []

        def call() -> None:
            try:
                client.call("x")
            except yarpy.YarpError as error:
                errors.append(error)

        thread = threading.Thread(target=call)
        thread.start()
        assert asked.wait(HANG)
        getattr(client, end)()
        thread.join(HANG)
        assert [type(error) for error in errors] == [yarpy.PortClosed]
        go_on.set()
        if end == "interrupt":
            client.resume()
            assert client.call("again", timeout=HANG) == 1


def test_an_exception_of_a_server_is_raised_by_the_call(names: yarpy.LocalNames) -> None:
    answers = {"raise": lambda: 1 / 0, "fail": lambda: yarpy.Bottle([yarpy.Vocab("fail"), "no"])}
    with (
        yarpy.RpcServer("/s", lambda message: answers[message.value[0]](), names=names),
        yarpy.RpcClient("/s", names=names) as client,
    ):
        with pytest.raises(yarpy.RemoteError, match="division by zero") as raised:
            client.call("raise", timeout=HANG)
        assert raised.value.type == "ZeroDivisionError"
        assert client.call("fail", timeout=HANG) == [yarpy.Vocab("fail"), "no"]  # as of C++


def test_wait_for_inputs_ends_with_its_port(names: yarpy.LocalNames) -> None:
    port = yarpy.Port("/a", names=names)
    errors: list[BaseException] = []
    begun = threading.Event()

    def wait() -> None:
        begun.set()
        try:
            port.wait_for_inputs()
        except yarpy.YarpError as error:
            errors.append(error)

    thread = threading.Thread(target=wait)
    thread.start()
    begun.wait(HANG)
    port.close()
    thread.join(HANG)
    assert [type(error) for error in errors] == [yarpy.PortClosed]


def test_who_connects_two_ports_makes_two_connections(monkeypatch: pytest.MonkeyPatch) -> None:
    way = "connect_ex" if sys.platform == "win32" else "connect"
    mine, here, real = [], threading.get_ident(), getattr(socket.socket, way)

    def connect(self: socket.socket, address: tuple[str, int]) -> int | None:
        if threading.get_ident() == here:  # those of the ports, and of what looks after them, apart
            mine.append(address[1])
        return real(self, address)

    with (
        yarpy.NameServer() as server,
        yarpy.Port("/a") as a,
        yarpy.BufferedPort("/b"),
    ):
        host, _, number = server.address.rpartition(":")
        with YarpNameClient(host, int(number)) as client:
            monkeypatch.setattr(socket.socket, way, connect)
            yarpy.connect("/a", "/b", names=client)
        assert sorted(mine) == sorted((int(number), a.contact.port))
