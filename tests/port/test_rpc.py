"""Remote procedure calls: answers, failures, limits, servers that come and go."""

from __future__ import annotations

import socket
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any
from urllib.request import urlopen

import pytest
from support.build import replaces_a_method
from support.guest import guest
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.errors import (
    DecodeError,
    LinkClosed,
    LocalProtocolError,
    PortClosed,
    RemoteError,
    Timeout,
    UnknownName,
)
from yarpy.link.begin.handshake import greet
from yarpy.link.receive.inbound import Inbound
from yarpy.nameserver.local import LocalNames
from yarpy.port import inputs
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.route import Route
from yarpy.wire import framing
from yarpy.wire.message import Encoded, Message


def echo(message: Message) -> object:
    return message.value


CALLS = [
    # arguments, what the server hears
    ((), []),
    (("add", 1, 2), ["add", 1, 2]),
    (("one",), ["one"]),
    ((5,), [5]),
    ((True,), [True]),
    ((["a", "list"],), ["a", "list"]),
    (({"key": 1},), [["key", 1]]),
    ((Vector([1.0, 2.0]),), [1.0, 2.0]),
]


@pytest.mark.parametrize("carrier", ["tcp", "memory"])
@pytest.mark.parametrize(
    "how", ["waits", "was read", "was read, then interrupted", "was read from the socket"]
)
def test_a_question_that_a_closed_port_never_answered_is_no_empty_answer(
    how: str, carrier: str, names: LocalNames
) -> None:
    """An empty answer is one, of a server that has nothing to say."""
    failed: list[str] = []
    reader = Port("/in", names=names)
    with RpcClient("/in", carrier=carrier, names=names) as client:
        if how == "was read from the socket":  # by a reader that waits there: the second question
            first = threading.Thread(target=lambda: reader.read(timeout=HANG).reply("yes"))
            first.start()
            assert client.call("first", timeout=HANG) == "yes"
            first.join(HANG)

        def ask() -> None:
            try:
                failed.append(repr(client.call("go", timeout=HANG)))
            except LinkClosed as error:
                failed.append(str(error))

        asking = threading.Thread(target=ask)
        asking.start()
        if how == "waits":
            wait_until(lambda: reader.waiting == 1)
        else:
            assert reader.read(timeout=HANG).wants_reply
        if "interrupted" in how:
            reader.interrupt()
        reader.close()
        asking.join(HANG)
        assert len(failed) == 1
        assert "nobody knows whether it has done what it was told" in failed[0]


@pytest.mark.parametrize("carrier", ["tcp", "memory", "local", "http", "text", "websocket"])
def test_a_question_to_an_interrupted_server_is_no_empty_answer(
    carrier: str, names: LocalNames
) -> None:
    """Nothing was done, and nobody says so. After `resume` the next one is answered."""
    with (
        RpcServer("/server", lambda message: "done", names=names) as server,
        RpcClient("/server", carrier=carrier, names=names) as client,
    ):
        server.interrupt()
        with pytest.raises(LinkClosed, match="nobody knows whether it has done"):
            client.call("go", timeout=HANG)
        server.resume()
        assert client.call("go", timeout=HANG) in ("done", ["done"])


def test_a_question_that_waits_for_its_turn_is_not_answered_by_an_interrupted_server(
    names: LocalNames,
) -> None:
    begun, go_on = threading.Event(), threading.Event()
    asked: list[str] = []

    def answer(message: Message) -> str:
        asked.append(message.value[0])
        begun.set()
        assert go_on.wait(HANG)
        return "done"

    with (
        RpcServer("/server", answer, lock=True, names=names) as server,
        RpcClient("/server", names=names) as first,
        RpcClient("/server", names=names) as second,
        ThreadPoolExecutor() as pool,
    ):
        one = pool.submit(first.call, "one", timeout=HANG)
        assert begun.wait(HANG)
        two = pool.submit(second.call, "two", timeout=HANG)
        wait_until(lambda: sum(link.stats.messages for link in server.inputs) == 2)
        server.interrupt()
        go_on.set()
        assert one.result(HANG) == "done"  # it was at work
        with pytest.raises(LinkClosed):
            two.result(HANG)
        assert asked == ["one"]


@pytest.mark.parametrize("carrier", ["tcp", "memory"])
@pytest.mark.parametrize(
    "how", ["waits", pytest.param("was read from the socket", marks=replaces_a_method)]
)
def test_a_question_that_an_interrupted_port_drops_is_no_empty_answer(
    how: str, carrier: str, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (
        Port("/in", names=names) as reader,
        RpcClient("/in", carrier=carrier, names=names) as client,
        ThreadPoolExecutor() as pool,
    ):
        if how == "waits":
            asking = pool.submit(client.call, "go", timeout=HANG)
            wait_until(lambda: reader.waiting == 1)
            reader.interrupt()
        else:  # by a reader that waits there; the interrupt comes right behind it
            read, armed = Inbound.read, threading.Event()

            def read_then_interrupted(link: Inbound, *arguments: Any) -> Message | None:
                found = read(link, *arguments)
                if found is not None:
                    armed.set() if found.value == ["go on"] else reader.interrupt()
                return found

            def serve() -> None:
                while True:
                    reader.read(timeout=HANG).reply("yes")

            monkeypatch.setattr(Inbound, "read", read_then_interrupted)
            serving = pool.submit(serve)
            wait_until(lambda: client.call("go on", timeout=HANG) == "yes" and armed.is_set())
            asking = pool.submit(client.call, "go", timeout=HANG)
            with pytest.raises(PortClosed):
                serving.result(HANG)
        with pytest.raises(LinkClosed, match="nobody knows whether it has done"):
            asking.result(HANG)
        reader.resume()
        again = pool.submit(client.call, "again", timeout=HANG)
        reader.read(timeout=HANG).reply("yes")
        assert again.result(HANG) == "yes"


@pytest.mark.parametrize(("arguments", "heard"), CALLS)
def test_arguments_are_the_message(
    arguments: tuple[object, ...], heard: object, names: LocalNames
) -> None:
    with (
        RpcServer("/server", lambda m: ["heard", m.as_(Bottle)], names=names),
        RpcClient("/server", names=names) as client,
    ):
        assert client.call(*arguments, timeout=HANG) == ["heard", heard]


def test_who_wants_to_read_is_told_that_there_is_nothing(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    guest("zmq")
    from yarpy.peers.zmq import zmtp

    with RpcServer("/server", echo, names=names) as server:
        where = "127.0.0.1", server.contact.port
        with socket.create_connection(where, HANG) as sock, sock.makefile("rwb") as line:
            line.write(b"CONNECT me\r\nr\r\nd\r\n5\r\n")
            line.flush()
            assert [line.readline() for _ in range(3)] == [
                b"Welcome me\r\n",
                b"this port sends nothing by itself, it answers what it is asked\r\n",
                b"5\r\n",
            ]
        driver, _ = greet(server.contact, Route("/me", "/server"))
        driver.stream.write(*framing.encode_text_command("r"))
        driver.flush()
        with pytest.raises(LinkClosed):  # binary, where nothing can be said
            driver.run(driver.stream.more(1000), time.monotonic() + HANG)
        driver.transport.close()
        wait_until(lambda: "/me over tcp closed: it wants to read: this port" in caplog.text)
        with socket.create_connection(where, HANG) as sock, sock.makefile("rb") as said:
            sock.sendall(zmtp.GREETING + zmtp.ready({"Socket-Type": b"SUB"}))
            assert b"ERROR" in (told := said.read()) and b"sends nothing by itself" in told
        assert not server.outputs


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text_ack", "unix_stream", "local"])
def test_calls_over_carriers(carrier: str, names: LocalNames) -> None:
    with (
        RpcServer("/server", echo, names=names),
        RpcClient("/server", carrier=carrier, names=names) as client,
    ):
        for number in range(50):
            assert client.call("n", number, timeout=HANG) == ["n", number]
        assert client.outputs[0].carrier == carrier
        assert client.outputs[0].stats.messages == 50
        assert client.outputs[0].stats.latency > 0


def test_answer_may_be_anything_or_nothing(names: LocalNames) -> None:
    answers = iter([None, [], "text", 7, [1, [2]], {"a": 1}, Stamp(1, 2.5), Vector([1.5])])
    with (
        RpcServer("/server", lambda message: next(answers), names=names),
        RpcClient("/server", names=names) as client,
    ):
        assert client.call("x", timeout=HANG) == []
        assert client.call("x", timeout=HANG) == []
        assert client.call("x", timeout=HANG) == "text"
        assert client.call("x", timeout=HANG) == 7
        assert client.call("x", timeout=HANG) == [1, [2]]
        assert client.call("x", timeout=HANG) == [["a", 1]]
        reply = client.ask(["x"], 5)
        assert reply is not None
        assert reply.as_(Stamp) == Stamp(1, 2.5)
        assert list(client.call("x", timeout=HANG)) == [1.5]


@pytest.mark.parametrize(("returned", "told"), [(["ignored"], True), (None, False)])
def test_handler_may_answer_itself(
    returned: object, told: bool, names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    def handle(message: Message) -> object:
        message.reply(["mine"])
        return returned

    with (
        RpcServer("/server", handle, names=names),
        RpcClient("/server", names=names) as client,
    ):
        assert [client.call("x", timeout=HANG) for _ in range(3)] == [["mine"]] * 3
    assert ("does not wait for a reply" in caplog.text) is told


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "unix_stream", "local", "text_ack"])
def test_question_that_nobody_answers(carrier: str, names: LocalNames) -> None:
    """A handler that gives nothing, a monitor that drops the question: nobody waits for ever."""
    with (
        RpcServer("/server", lambda message: None, names=names) as server,
        RpcClient("/server", carrier=carrier, names=names) as client,
    ):
        assert client.call("x", timeout=HANG) == []
        server._hub.monitoring.attach("in", Property(monitor="throttleDown"))
        assert client.call("x", timeout=HANG) == []
        assert client.call("x", timeout=HANG) == []


def test_failing_handler_says_why_and_goes_on(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    def handle(message: Message) -> object:
        return [10 / message.value[0]]

    with (
        RpcServer("/server", handle, names=names),
        RpcClient("/server", names=names) as client,
    ):
        with pytest.raises(RemoteError, match="division by zero") as failed:
            client.call(0, timeout=HANG)
        assert failed.value.type == "ZeroDivisionError"
        answer = client.ask([0], timeout=HANG)  # what a client of C++ sees
        assert answer is not None
        fail, text, mark = answer.value
        assert (fail, text) == (Vocab("fail"), "ZeroDivisionError: division by zero")
        assert mark == ["raised", "ZeroDivisionError"]
        assert client.call(5, timeout=HANG) == [2.0]
    assert "Traceback" in caplog.text


def test_message_that_cannot_be_decoded_is_refused(names: LocalNames) -> None:
    with (
        RpcServer("/server", lambda m: [m.as_(Stamp).count], names=names),
        RpcClient("/server", names=names) as client,
    ):
        with pytest.raises(RemoteError, match="no stamp") as failed:
            client.call("no stamp", timeout=HANG)
        assert failed.value.type == "DecodeError"
        assert client.call(Stamp(5, 1.0), timeout=HANG) == [5]


class Missing:
    """A value whose own method fails."""

    def to_wire(self) -> tuple[bytes]:
        raise KeyError("no such joint")


@pytest.mark.parametrize(
    ("odd", "why"),
    [
        (object(), "cannot be sent"),
        (2**70, "64 bits"),
        ("\ud800", "surrogates"),
        (Missing(), "no such joint"),
    ],
)
def test_answer_that_cannot_be_sent_is_an_answer_too(
    odd: object, why: str, names: LocalNames
) -> None:
    """The asker does not wait for ever for an object that has no spelling."""
    with (
        RpcServer("/server", lambda message: odd, names=names),
        RpcClient("/server", names=names) as client,
    ):
        for _ in range(2):
            with pytest.raises(RemoteError, match=why):
                client.call("x", timeout=HANG)


def test_reader_that_answers_with_something_odd_may_answer_again(names: LocalNames) -> None:
    with Port("/server", names=names) as server, RpcClient("/server", names=names) as client:
        answers: list[object] = []
        thread = threading.Thread(target=lambda: answers.append(client.call("x", timeout=HANG)))
        thread.start()
        message = server.read(timeout=HANG)
        with pytest.raises(TypeError, match="cannot be"):
            message.reply([object()])
        message.reply(["better"])
        thread.join(HANG)
        assert answers == [["better"]]


def test_client_decodes_only_when_asked(names: LocalNames) -> None:
    with (
        RpcServer("/server", echo, names=names),
        RpcClient("/server", names=names) as client,
    ):
        reply = client.ask([1, 2], 5)
        assert reply is not None
        assert reply.source == "/server"
        with pytest.raises(DecodeError):
            reply.as_(Stamp)


# ---------------------------------------------------------------------------------- limits


def test_slow_server_is_a_timeout_and_its_late_answer_is_lost(names: LocalNames) -> None:
    over = threading.Event()

    def handle(message: Message) -> object:
        if message.value == ["slow"]:
            over.wait(HANG)
        return message.value

    with (
        RpcServer("/server", handle, names=names),
        RpcClient("/server", names=names) as client,
    ):
        with pytest.raises(Timeout, match=r'"/server" did not reply within 0\.\d+ s'):
            client.call("slow", timeout=0.3)
        over.set()
        assert client.call("quick", timeout=HANG) == ["quick"]


def test_a_handler_that_exits_answers_and_goes_on(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    def handle(message: Message) -> object:
        return sys.exit("enough") if message.value == ["exit"] else "alive"

    with RpcServer("/s", handle, names=names), RpcClient("/s", names=names) as client:
        with pytest.raises(RemoteError, match="SystemExit: enough"):
            client.call("exit", timeout=HANG)
        assert client.call("x", timeout=HANG) == "alive"
    assert "sys.exit() in a thread of a port ends no program" in caplog.text
    assert "defect" not in caplog.text


def test_a_stuck_handler_keeps_nobody_waiting(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inputs, "SETTLING", 1000.0)
    stuck = threading.Event()

    def handle(message: Message) -> object:
        if message.value == ["slow"]:
            stuck.wait()
        return message.value

    with (
        RpcServer("/server", handle, names=names),
        RpcClient("/server", name="/client", names=names) as client,
    ):
        with pytest.raises(Timeout):
            client.call(["slow"], timeout=0.05)
        assert client.call(["quick"], timeout=HANG) == ["quick"]
        stuck.set()


def test_a_server_that_is_silent_when_it_is_dialled(
    names: LocalNames,
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        number = listener.getsockname()[1]
        with pytest.raises(LinkClosed, match="silent"):
            RpcClient(f"/127.0.0.1:{number}", names=names, timeout=0.1)
        with pytest.raises(LinkClosed, match="silent"):
            RpcClient(f"tcp://127.0.0.1:{number}/named", names=names, timeout=0.1)


def test_clients_are_served_side_by_side(names: LocalNames) -> None:
    meeting = threading.Barrier(3)

    def handle(message: Message) -> object:
        meeting.wait(HANG)
        return ["met"]

    with RpcServer("/server", handle, names=names):
        answers: list[object] = []

        def ask() -> None:
            with RpcClient("/server", names=names) as client:
                answers.append(client.call("x", timeout=HANG))

        threads = [threading.Thread(target=ask) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(HANG)
        assert answers == [["met"]] * 3


def test_locked_server_takes_one_at_a_time(names: LocalNames) -> None:
    inside = 0
    most = 0

    def handle(message: Message) -> object:
        nonlocal inside, most
        inside += 1
        most = max(most, inside)
        time.sleep(0.01)
        inside -= 1
        return []

    with RpcServer("/server", handle, names=names, lock=True):

        def ask() -> None:
            with RpcClient("/server", names=names) as client:
                for _ in range(3):
                    client.call("x", timeout=HANG)

        threads = [threading.Thread(target=ask) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(HANG)
        assert most == 1


def test_one_client_may_be_used_by_several_threads(names: LocalNames) -> None:
    with (
        RpcServer("/server", echo, names=names),
        RpcClient("/server", names=names) as client,
    ):
        wrong: list[object] = []

        def ask(who: int) -> None:
            for number in range(100):
                if client.call(who, number, timeout=HANG) != [who, number]:
                    wrong.append((who, number))

        threads = [threading.Thread(target=ask, args=(who,)) for who in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(HANG)
        assert wrong == []


# --------------------------------------------------------------------------------- coming and going


def test_no_server(names: LocalNames) -> None:
    with pytest.raises(UnknownName, match='did you mean "/server"'), Port("/server", names=names):
        RpcClient("/servr", names=names)
    with (
        RpcClient(name="/client", names=names) as client,
        pytest.raises(LocalProtocolError, match="not connected to a server"),
    ):
        client.call("x")


def test_server_that_is_restarted_is_found_by_the_next_call(names: LocalNames) -> None:
    with RpcServer("/server", echo, names=names):
        client = RpcClient("/server", names=names)
        assert client.call(1, timeout=HANG) == [1]
    with client:
        with pytest.raises((UnknownName, LinkClosed)):
            client.call(2, timeout=HANG)
        with RpcServer("/server", echo, names=names):
            assert client.call(3, timeout=HANG) == [3]


def test_server_that_goes_away_during_the_call(names: LocalNames) -> None:
    import socket

    with (
        socket.create_server(("127.0.0.1", 0)) as listener,
        RpcClient(name="/client", names=names) as client,
    ):

        def serve() -> None:
            sock, _ = listener.accept()
            sock.recv(100)
            sock.sendall(b"YA\x01\0\0\0RP")
            sock.recv(1000)
            listener.close()
            sock.close()

        threading.Thread(target=serve, daemon=True).start()
        client.connect(f"/127.0.0.1:{listener.getsockname()[1]}")
        with pytest.raises(LinkClosed):
            client.call("x", timeout=HANG)


def test_client_is_connected_from_outside(names: LocalNames) -> None:
    """`yarp connect /client /server`, as for any port; once only."""
    with (
        RpcServer("/server", echo, names=names),
        RpcServer("/other", echo, names=names),
        RpcClient(name="/client", names=names) as client,
    ):
        network.connect("/client", "/server", names=names)
        assert client.call("x", timeout=HANG) == ["x"]
        with pytest.raises(LocalProtocolError, match="RPC output already connected"):
            network.connect("/client", "/other", names=names)
        assert client.call("y", timeout=HANG) == ["y"]
        network.disconnect("/client", "/server", names=names)
        network.connect("/client", "/other", names=names)
        assert client.call("z", timeout=HANG) == ["z"]


def test_server_takes_no_outputs(names: LocalNames) -> None:
    with RpcServer("/server", echo, names=names) as server, Port("/in", names=names):
        with pytest.raises(LocalProtocolError, match="Outputs not allowed"):
            server.connect("/in")
        with pytest.raises(LocalProtocolError, match="Outputs not allowed"):
            network.connect("/server", "/in", names=names)


def test_closed_client(names: LocalNames) -> None:
    with RpcServer("/server", echo, names=names) as server:
        client = RpcClient("/server", names=names)
        assert client.call("x", timeout=HANG) == ["x"]
        client.close()
        with pytest.raises(PortClosed):
            client.call("x")
        wait_until(lambda: not server.inputs)


def test_unnamed_clients_do_not_displace_each_other(names: LocalNames) -> None:
    with (
        RpcServer("/server", echo, names=names) as server,
        RpcClient("/server", names=names) as first,
        RpcClient("/server", names=names) as second,
    ):
        assert first.name != second.name
        for number in range(3):
            assert first.call(number, timeout=HANG) == [number]
            assert second.call(number, timeout=HANG) == [number]
        assert len(server.inputs) == 2


# ---------------------------------------------------------------------------------- log.in


def test_logger_hears_questions_and_answers(names: LocalNames) -> None:
    """A connection with `+log.in` gets what the server is asked, and what it answers."""
    with (
        RpcServer("/server", lambda m: ["yes", *m.value], names=names),
        RpcClient("/server", names=names) as client,
        Port("/logger", names=names) as logger,
        Port("/writer", names=names) as writer,
    ):
        line = network.connect("/server", "/logger", "tcp+log.in", names=names).reply
        assert line == (
            "Added connection from /server to tcp+log.in://logger; "
            "/server will forward messages and replies (if any) to /logger"
        )
        assert client.call("ask", 1, timeout=HANG) == ["yes", "ask", 1]
        assert logger.read(timeout=HANG).value == [Vocab("rpc"), ["ask", 1], ["yes", "ask", 1]]
        writer.connect("/server")
        writer.write(["told"])
        assert logger.read(timeout=HANG).value == ["told"]
        with pytest.raises(LocalProtocolError, match=r"only log\.in is supported"):
            network.connect("/server", "/logger", "tcp+log.out", names=names)


def test_a_question_that_comes_while_the_server_still_opens_is_answered():
    """The name is known, and a client that waits for it asks, before the constructor is done."""
    answers = []

    class Eager(LocalNames):
        def announce(self, name: str, ok: bool = True) -> None:
            if name == "/server":
                asking.start()
                time.sleep(0.2)

    def ask() -> None:
        with RpcClient("/server", names=names) as client:
            answers.append(client.call(1, 2, timeout=HANG))

    names = Eager()
    asking = threading.Thread(target=ask)
    with RpcServer("/server", echo, names=names):
        asking.join(HANG)
    assert answers == [[1, 2]]


def test_servers_and_clients_hear_of_connections(names: LocalNames) -> None:
    heard: list[str] = []
    with RpcServer(
        "/server", lambda m: m.value, names=names, on_connection=lambda e: heard.append(str(e))
    ):
        RpcClient(
            "/server", name="/client", names=names, on_connection=lambda e: heard.append(str(e))
        ).close()
        wait_until(lambda: len(heard) == 4)
    assert sorted(heard) == [
        "Receiving input from /client to /server using tcp",
        "Removing input from /client to /server",
        "Removing output from /client to /server",
        "Sending output from /client to /server using tcp",
    ]


def test_tell_sends_without_waiting_for_an_answer(names: LocalNames) -> None:
    heard: list[Message] = []
    with (
        RpcServer("/server", heard.append, names=names),
        RpcClient("/server", names=names) as client,
    ):
        client.tell(["go", 1])
        assert client.call("and", 2) == []
        assert [message.value for message in heard] == [["go", 1], ["and", 2]]
        assert [message.answer is None for message in heard] == [True, False]
    with pytest.raises(PortClosed):
        client.tell([1])


@pytest.mark.parametrize("asks", [True, False], ids=["call", "tell"])
def test_what_never_left_goes_again_by_itself(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch, asks: bool
) -> None:
    """The connection ends behind the look at whether it has."""
    heard: list[Message] = []
    with (
        RpcServer("/server", heard.append, names=names),
        RpcClient("/server", names=names) as client,
    ):
        (link,) = client._hub.outputs.links
        monkeypatch.setattr(link, "ended", lambda: False)
        link.driver.transport.interrupt()
        if asks:
            assert client.call("x", timeout=HANG) == []
        else:
            client.tell(["x"], HANG)
            assert client.call("y", timeout=HANG) == []
        assert [message.value for message in heard] == [["x"], ["y"]][: 2 - asks]
        assert client._hub.outputs.links != (link,)


@pytest.mark.parametrize("carrier", ["tcp", "memory", "local"])
def test_no_handler_begins_while_its_server_closes_and_what_is_dropped_is_counted(
    carrier: str, names: LocalNames
) -> None:
    begun, go_on = threading.Event(), threading.Event()
    heard: list[int] = []

    def handler(message: Message) -> None:
        heard.append(message.value[0])
        begun.set()
        assert go_on.wait(HANG)

    server = RpcServer("/server", handler, names=names)
    with RpcClient("/server", carrier=carrier, names=names) as client, ThreadPoolExecutor() as pool:
        for number in range(5):
            client.tell([number], HANG)
        assert begun.wait(HANG)
        closing = pool.submit(server.close, HANG)
        wait_until(lambda: server._hub.inputs.mailbox.stopped)
        assert not closing.done()
        go_on.set()
        closing.result(HANG)
        counts = server.stats.as_dict()["past"]["inputs"]
        assert heard == [0]
        assert counts["messages"] == len(heard) + counts["drops"]


def test_what_may_have_left_is_not_told_again(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard: list[Message] = []
    with (
        RpcServer("/server", heard.append, names=names),
        RpcClient("/server", names=names) as client,
    ):
        (link,) = client._hub.outputs.links

        def send(packet: object, until: float | None = None) -> bool:
            link.driver.bytes_out += 1
            link.sender.fail()
            raise LinkClosed("it ends")

        monkeypatch.setattr(link, "send", send)
        with pytest.raises(LinkClosed, match="it ends"):
            client.tell(["x"])
        assert client.call("y") == []
        assert [message.value for message in heard] == [["y"]]


def test_a_handler_with_a_page_shows_it(names: LocalNames) -> None:
    class Handler:
        def __call__(self, message: Message) -> object:
            return message.value

        def page(self, path: str, fields: object) -> str | None:
            return "<p>mine</p>" if path == "/" else None

    with RpcServer("/server", Handler(), names=names) as server:
        with urlopen(f"http://{server.address}/", timeout=HANG) as page:
            assert page.read() == b"<p>mine</p>"
        with urlopen(f"http://{server.address}/*", timeout=HANG) as page:
            assert b"/server" in page.read()


def test_questions_may_say_where_their_reply_ends(names: LocalNames) -> None:
    """A list of lists as C++ writes it, which is no Bottle."""
    data = bytes.fromhex("0001000001000000 0101000001000000 0101000001000000 07000000")

    class Question:
        def to_wire(self) -> tuple[bytes, ...]:
            return (b"\4\1\0\0\1\0\0\0\2\0\0\0hi",)

        @staticmethod
        def reply_end(limit: int) -> object:
            class Walk:
                done = False

                def advance(self, view: memoryview) -> int:
                    self.done = len(view) >= len(data)
                    return len(data)

            return Walk()

    with RpcServer("/server", lambda message: Encoded(data), names=names):
        for carrier in ("tcp", "fast_tcp"):
            with RpcClient("/server", names=names, carrier=carrier) as client:
                for _ in range(2):
                    message = client.ask(Question())
                    assert message is not None and message.payload == data


def test_a_class_is_no_handler(names: LocalNames) -> None:
    class Camera:
        def __call__(self, message: object) -> object:
            return message

    with pytest.raises(TypeError, match=r"is the class Camera, not an object of it: .*Camera\(\)"):
        RpcServer("/camera", Camera, names=names)  # type: ignore[arg-type]
