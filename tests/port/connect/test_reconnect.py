"""Broken things come back by themselves: connections, registrations, with no line of user code."""

import os
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import pytest
from support.moments import Cut, cut, elsewhere, moments
from support.port import free_port
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.port.connect import connecting, disconnecting, identity, probe, reconnect
from yarpy.port.connect.lost import CALM, Lost
from yarpy.route import Route

RECOVERY = 20.0  # generous on a busy machine; the goal is 2 s, and the benchmark tells

SERVER = """
import sys, time, yarpy
with yarpy.NameServer(int(sys.argv[1])):
    print("ready", flush=True)
    time.sleep(600)
"""
WRITER = """
import time, yarpy
with yarpy.Port("/again/out") as port:
    if {connects}:
        port.connect("/again/in", timeout=10)
    print("ready", flush=True)
    for count in range(10**9):
        port.write([count])
        time.sleep(0.01)
"""


def start(code: str, *arguments: str) -> Process:
    """A Python program that says `ready`; environment variables are those of the test."""
    process = Process([sys.executable, "-c", code, *arguments], env=os.environ)
    process.wait_line("ready")
    return process


def flows(port: yarpy.BufferedPort) -> bool:
    """Whether something newly written arrives in time."""
    deadline = time.monotonic() + RECOVERY
    while (message := port.poll()) is not None:  # from before
        pass
    while time.monotonic() < deadline:
        try:
            message = port.read(timeout=0.2)
        except yarpy.Timeout:
            continue
        return isinstance(message.value[0], int)
    return False


@pytest.fixture
def number(monkeypatch: pytest.MonkeyPatch) -> int:
    """A port number for a name server that this process and its children use."""
    chosen = free_port()
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{chosen}")
    return chosen


@pytest.mark.timeout(180)
def test_everything_may_be_killed_in_the_middle_of_a_stream(number: int) -> None:
    """Name server and sender are killed in turn, again and again; the reader goes on getting
    data."""
    server = start(SERVER, str(number))
    with yarpy.BufferedPort("/again/in") as reader:
        writer = start(WRITER.format(connects=True))
        try:
            assert flows(reader)
            for turn in range(6):
                if turn % 2:
                    writer.kill()
                    writer = start(WRITER.format(connects=False))
                else:
                    server.kill()
                    assert flows(reader), "a stream does not need the name server"
                    server = start(SERVER, str(number))
                    deadline = time.monotonic() + RECOVERY
                    while None in (yarpy.query("/again/in"), yarpy.query("/again/out")):
                        assert time.monotonic() < deadline, f"turn {turn}: not registered again"
                        time.sleep(0.05)
                assert flows(reader), f"turn {turn}: no data after a restart"
        finally:
            writer.stop()
    server.stop()


READER = """
import sys, yarpy
with yarpy.BufferedPort("/again/in") as port:
    print("ready", flush=True)
    for message in port:
        print("got", message.value[0], flush=True)
"""


def test_a_killed_reader_is_connected_again(number: int) -> None:
    with start(SERVER, str(number)), yarpy.Port("/again/out") as writer:
        for turn in range(3):
            with start(READER) as reader:
                if turn == 0:
                    writer.connect("/again/in")
                assert writer.wait_for_outputs(timeout=RECOVERY), f"turn {turn}"
                deadline = time.monotonic() + RECOVERY
                while "got" not in reader.stdout and time.monotonic() < deadline:
                    writer.write([turn])
                    time.sleep(0.005)
                reader.wait_line(f"got {turn}", timeout=HANG)
                reader.kill()
            writer.write(["nobody"])
            writer.write(["there"])


def test_a_peer_that_hangs_delays_no_other(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A stopped program takes connections and answers nothing; others are restored meanwhile."""
    opened = connecting.open_output

    def patiently(hub: Any, contact: Any, target: str, spec: Any, lost: Any, timeout: Any) -> Any:
        return opened(hub, contact, target, spec, lost, 2 * HANG)

    with yarpy.Port("/out", names=names) as out, yarpy.Port("/other", names=names) as other:
        hanging = yarpy.BufferedPort("/hanging", names=names)
        with yarpy.BufferedPort("/in", names=names) as in_:
            out.connect("/hanging")
            other.connect("/in")
            wait_until(lambda: hanging.inputs and in_.inputs)
            monkeypatch.setattr(connecting, "open_output", patiently)
            with socket.create_server(("127.0.0.1", 0)) as stopped:
                names.register("/hanging", "tcp", "127.0.0.1", stopped.getsockname()[1])
                for link in hanging._hub.inputs.links:
                    link.driver.transport.interrupt()
                stopped.settimeout(RECOVERY)
                held = stopped.accept()  # it is being dialled, and says nothing
                before = other._hub.outputs.links
                for link in in_._hub.inputs.links:
                    link.driver.transport.interrupt()
                wait_until(lambda: other._hub.outputs.links not in ((), before), what="restored")
                assert not out.outputs, "the other one hangs still"
                held[0].close()
            hanging.close()


@contextmanager
def silent() -> Iterator[int]:
    """The number of a listener that accepts nobody and answers nothing."""
    with socket.create_server(("127.0.0.1", 0), backlog=8) as stopped:
        yield stopped.getsockname()[1]


def restored(names: yarpy.LocalNames) -> None:
    """Wait until a connection that breaks now is there again. What is to delay nobody lasts
    longer."""
    with yarpy.Port("/other", names=names) as other, yarpy.BufferedPort("/in", names=names) as in_:
        other.connect("/in")
        wait_until(lambda: in_.inputs)
        before = other._hub.outputs.links
        for link in in_._hub.inputs.links:
            link.driver.transport.interrupt()
        wait_until(lambda: other._hub.outputs.links not in ((), before), what="restored")


def test_a_name_that_turns_up_elsewhere_is_not_awaited_where_it_was(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its old host is dead and answers nothing, and the name is at another address by now."""
    monkeypatch.setattr(identity, "TIMEOUT", 3600.0)
    # The receiver, which lives here, asks for nothing.
    monkeypatch.setattr(Lost, "is_calm", lambda self, now: False)
    with (
        yarpy.BufferedPort("/out", names=names) as out,
        socket.create_server(("127.0.0.1", 0)) as dead,
    ):
        dead.settimeout(RECOVERY)
        with yarpy.BufferedPort("/in", names=names) as in_:
            out.connect("/in")
            wait_until(lambda: in_.inputs)
            names.register("/in", "tcp", "127.0.0.1", dead.getsockname()[1])
            for link in in_._hub.inputs.links:
                link.driver.transport.interrupt()
            held = dead.accept()  # it is being dialled, and says nothing
        names.unregister("/in")
        with held[0], yarpy.BufferedPort("/in", names=names):
            wait_until(lambda: out.outputs, RECOVERY, "connected to where the name is now")


def test_a_question_without_an_answer_delays_nobody(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A silent sender of datagrams is asked whether it still lives, and is stopped."""
    asked = threading.Event()
    real = probe.connection

    def connection(contact, *arguments, **options):
        if contact.port == number:
            asked.set()
        return real(contact, *arguments, **options)

    patient = {**probe.ask.__kwdefaults__, "timeout": 2 * HANG}
    monkeypatch.setattr(probe.ask, "__kwdefaults__", patient)
    with (
        yarpy.Port("/stopped", names=names) as sender,
        yarpy.BufferedPort("/listener", names=names) as listener,
        silent() as number,  # its end is the end of the question
    ):
        sender.connect("/listener", "udp")
        wait_until(lambda: listener.inputs)
        monkeypatch.setattr(probe, "connection", connection)
        names.register("/stopped", "tcp", "127.0.0.1", number)
        assert asked.wait(HANG)
        restored(names)


def test_a_name_server_that_hangs_delays_nobody(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that went away, and hangs when it is dialled."""
    dialled, go_on = threading.Event(), threading.Event()
    with yarpy.NameServer() as server:
        client = yarpy.YarpNameClient("127.0.0.1", server.port)
        port = yarpy.Port("/port", names=client)
        watched = reconnect.RECONNECTOR._servers._watched
        wait_until(lambda: any(one.client is client and one.is_there() for one in watched.values()))

    def connect() -> socket.socket:
        dialled.set()
        go_on.wait(2 * HANG)
        raise yarpy.NoNameServer("it hung")

    monkeypatch.setattr(client, "connect", connect)
    try:
        assert dialled.wait(HANG)
        restored(names)
    finally:
        go_on.set()
        port.close()


def test_a_callback_that_takes_its_time_delays_nobody(names: yarpy.LocalNames) -> None:
    told, go_on = threading.Event(), threading.Event()

    def slow(event: yarpy.ConnectionEvent) -> None:
        if not event.created:
            told.set()
            go_on.wait(2 * HANG)

    with (
        yarpy.Port("/slow", names=names, on_connection=slow) as port,
        yarpy.BufferedPort("/reader", names=names) as reader,
    ):
        port.connect("/reader")
        wait_until(lambda: reader.inputs)
        for link in reader._hub.inputs.links:
            link.driver.transport.interrupt()
        try:
            assert told.wait(HANG)
            restored(names)
        finally:
            go_on.set()


def test_what_was_disconnected_stays_disconnected() -> None:
    with (
        yarpy.NameServer(),
        yarpy.Port("/again/out") as writer,
        yarpy.BufferedPort("/again/in") as reader,
    ):
        writer.connect("/again/in")
        reader.wait_for_inputs(timeout=HANG)
        assert writer.disconnect("/again/in")
        time.sleep(1.2)
        assert not writer.outputs
        assert not reader.inputs


def test_what_is_found_dead_while_it_is_disconnected_stays_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its sender, who is told first, knows nothing of it any more: that is no failure."""
    with (
        yarpy.NameServer(),
        yarpy.BufferedPort("/again/out") as writer,
        yarpy.BufferedPort("/again/in") as reader,
    ):
        writer.connect("/again/in", "udp")
        assert reader.wait_for_inputs(timeout=HANG)
        (link,) = reader._hub.inputs.connections  # others ask how much has come
        ask_to_leave = disconnecting.goodbye.ask_to_leave

        wanted: list[object] = []

        def slowly(*arguments: Any) -> None:
            # The watch finds it out before the sender, on a busy machine, has answered.
            reconnect.RECONNECTOR._died(reader._hub, link)
            wanted.extend(item for item in reconnect.RECONNECTOR._lost if item.hub is reader._hub)
            ask_to_leave(*arguments)

        monkeypatch.setattr(disconnecting.goodbye, "ask_to_leave", slowly)
        probe.ask(reader.contact, ["del", "/again/out"])
        assert not reader.inputs
        assert not wanted


def test_what_has_come_back_and_said_goodbye_is_not_asked_for(names: yarpy.LocalNames) -> None:
    """The sender has dialled again by itself, and was disconnected before it would be asked."""
    with (
        yarpy.RpcServer("/server", lambda message: "yes", names=names) as server,
        yarpy.RpcClient("/server", name="/client", names=names) as client,
    ):

        def lost() -> list[Lost]:
            return [one for one in reconnect.RECONNECTOR._lost if one.hub is server._hub]

        server.interrupt()
        with pytest.raises(yarpy.LinkClosed):
            client.call("x", timeout=HANG)
        server.resume()
        assert client.call("x", timeout=HANG) == "yes"
        assert client.disconnect("/server")
        wait_until(lambda: not (server.inputs or lost()))
        assert not client.outputs


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text", "udp"])
def test_what_the_receiver_disconnected_stays_disconnected(carrier: str) -> None:
    """Its sender is told, and takes it for no failure."""
    with (
        yarpy.NameServer(),
        yarpy.BufferedPort("/again/out") as writer,
        yarpy.BufferedPort("/again/in") as reader,
    ):
        writer.connect("/again/in", carrier)
        assert reader.wait_for_inputs(timeout=HANG)
        answer = probe.ask(reader.contact, ["del", "/again/out"])
        assert answer == [0, "Removing connection from /again/out to /again/in\r\n"]
        for _ in range(12):
            writer.write(["x"])
            time.sleep(0.1)
        assert not reader.inputs
        assert not writer.outputs


def test_camera_that_is_away_can_be_disconnected(names: yarpy.LocalNames) -> None:
    """Its viewer dials it again and again; who disconnects the two is not told of a failure."""
    answer = b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace\r\n\r\n"
    with yarpy.BufferedPort("/view", names=names) as view:
        with socket.create_server(("127.0.0.1", 0)) as camera:
            name = f"/127.0.0.1:{camera.getsockname()[1]}"
            dialling = threading.Thread(target=view.connect, args=(name, "mjpeg"))
            dialling.start()
            sock, _ = camera.accept()
            sock.sendall(answer)
            dialling.join()
        sock.close()
        wait_until(lambda: not view.inputs)
        assert yarpy.disconnect(name, "/view", names=names)
        assert "Could not find" in yarpy.admin("/view", "del", f"{name}/", names=names)[1]


def test_the_way_back_is_another_connection() -> None:
    with (
        yarpy.NameServer(),
        yarpy.BufferedPort("/again/a") as a,
        yarpy.BufferedPort("/again/b") as b,
    ):
        a.connect("/again/b")
        b.connect("/again/a")
        assert a.wait_for_inputs(timeout=HANG) and b.wait_for_inputs(timeout=HANG)
        probe.drop_input(b.contact, "/again/a")
        time.sleep(0.7)
        assert not (b.inputs or a.outputs)
        assert [link.name for link in a.inputs] == ["/again/b"]


def test_a_closed_reader_is_not_dialled_again_under_the_same_name() -> None:
    """Closing says goodbye; a program of the same name that starts later begins unconnected."""
    with yarpy.NameServer(), yarpy.Port("/again/out") as writer:
        with yarpy.BufferedPort("/again/in"):
            writer.connect("/again/in")
        assert not writer.outputs
        with yarpy.BufferedPort("/again/in") as reader:
            time.sleep(1.2)
            assert not reader.inputs


def test_a_connection_to_an_address_comes_back_without_any_name_server(number: int) -> None:
    place = free_port()
    with yarpy.Port("", tcp_port=free_port()) as writer:
        for turn in range(2):
            with yarpy.BufferedPort("", tcp_port=place) as reader:
                if turn == 0:
                    writer.connect(f"/127.0.0.1:{place}")
                    # Whom it reached is asked afterwards: nobody else is dialled in its place.
                    wait_until(lambda: writer._hub.outputs.links[0].route.peer)
                # Until it is found out, what is written goes the way of the lost connection.
                wait_until(lambda: writer.write([turn]) and reader.poll())  # noqa: B023
                for link in reader._hub.inputs.links:  # as a crash would: without a goodbye
                    link.driver.transport.interrupt()
            assert _wait_until(lambda: not writer.outputs)


def _wait_until(condition) -> bool:
    deadline = time.monotonic() + RECOVERY
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.01)
    return bool(condition())


def test_nothing_is_dialled_for_a_port_that_is_closed(names: yarpy.LocalNames) -> None:
    """A connection that breaks while its port closes would be remembered for ever."""
    port = yarpy.Port("/out", names=names)
    port.close()
    reconnect.output_lost(port._hub, Route("/out", "/in", "tcp"))
    assert reconnect.pending(port._hub) == []


def lost(names: yarpy.LocalNames, port: yarpy.Port) -> Lost:
    """A connection of `port` to `/in`, which has failed."""
    return Lost(port._hub, Route(port.name, "/in", "tcp", peer="/in"), incoming=False)


def test_senders_that_are_waited_for_are_limited(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A stranger may connect under a new name again and again, and vanish."""
    monkeypatch.setattr(reconnect, "MOST_SENDERS", 5)
    monkeypatch.setattr(reconnect.Reconnector, "_dial", lambda self, lost: None)

    def waited(port: yarpy.Port) -> list[str]:
        lost = reconnect.RECONNECTOR._lost
        return [item.route.source for item in lost if item.hub is port._hub]

    with yarpy.Port("/in", names=names) as port, yarpy.Port("/other", names=names) as other:
        reconnect.input_lost(port._hub, Route("/camera", "/in", "mjpeg", peer="/camera"))
        reconnect.input_lost(other._hub, Route("/first", "/other"))
        for number in range(20):
            reconnect.input_lost(port._hub, Route(f"/fake{number}", "/in"))
        for _ in range(3):
            reconnect.input_lost(port._hub, Route("/fake17", "/in"))
        assert waited(port) == ["/camera", *(f"/fake{n}" for n in (15, 16, 18, 19, 17))]
        assert waited(other) == ["/first"]


def test_what_breaks_while_it_is_made_is_not_forgotten(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A camera may end its stream before whoever asked for it has the answer."""
    opened = connecting.open_output
    monkeypatch.setattr(reconnect.Reconnector, "_dial", lambda self, lost: None)

    def breaks(hub: Any, contact: Any, target: str, *others: Any) -> Any:
        found = opened(hub, contact, target, *others)
        reconnect.output_lost(hub, Route(hub.name, target, "tcp", peer=target))
        return found

    with yarpy.Port("/out", names=names) as port, yarpy.BufferedPort("/in", names=names):
        reconnect.output_lost(port._hub, Route("/out", "/in", "fast_tcp", peer="/in"))
        monkeypatch.setattr(connecting, "open_output", breaks)
        port.connect("/in", "tcp")
        [left] = reconnect.pending(port._hub)
        assert str(left.spec) == "tcp"


def test_why_something_stays_away_is_logged_once(
    names: yarpy.LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    """Another port has the number; then nobody; then a third port: two lines for all attempts."""
    with yarpy.Port("/out", names=names) as out:
        item = lost(names, out)
        reconnector = reconnect.Reconnector()
        reconnector._lost.append(item)

        def attempts(number: int) -> None:
            names.register("/in", "tcp", "127.0.0.1", number)
            names.set("/in", "process", 1)
            for _ in range(3):
                reconnector._attempt(item)
            assert reconnector._lost == [item] and not out.outputs

        with yarpy.BufferedPort("/other", names=names) as other:
            attempts(other.contact.port)
            number = other.contact.port
        attempts(number)
        with yarpy.BufferedPort("/third", names=names) as third:
            attempts(third.contact.port)
        assert not other.inputs and not third.inputs
    told = [record.getMessage() for record in caplog.records if "/in" in record.getMessage()]
    assert len(told) == 2
    assert told[0].startswith('/out: no connection to /in: "/other" listens at 127.0.0.1:')
    assert ', not "/in": start the program of /in again; ' in told[0]
    assert '"/third" listens at 127.0.0.1:' in told[1]


def test_a_signal_handler_closes_a_port_over_a_frame_that_changes_the_lists(
    names: yarpy.LocalNames,
) -> None:
    port = yarpy.Port("/beneath", names=names)

    def handle() -> None:
        with reconnect.RECONNECTOR._lock:
            port.close()

    thread = threading.Thread(target=handle, daemon=True)
    thread.start()
    thread.join(HANG)
    assert not thread.is_alive()
    assert names.query("/beneath") is None


def test_what_a_signal_handler_forgets_stays_forgotten(names: yarpy.LocalNames) -> None:
    """It comes in the middle of changes to the same lists."""
    tried = 0
    for one in moments():
        tried += 1
        with (
            yarpy.Port("/first", names=names) as first,
            yarpy.Port("/second", names=names) as second,
            yarpy.Port("/third", names=names) as third,
        ):
            for port in (first, second, third):
                for peer in ("/away", "/gone"):
                    reconnect.output_lost(port._hub, Route(port.name, peer, "tcp", peer=peer))

            def forget(second: yarpy.Port = second, third: yarpy.Port = third) -> None:
                reconnect.forget(second._hub)
                assert reconnect.give_up(third._hub, "/gone")

            with one.interrupts(forget):
                reconnect.forget(first._hub)
            watched = reconnect.RECONNECTOR._hubs
            if one.came:
                assert second._hub not in watched
                assert not reconnect.pending(second._hub)
                assert [route.target for route in reconnect.pending(third._hub)] == ["/away"]
            assert first._hub not in watched
            assert third._hub in watched
    assert tried > 10


def test_a_goodbye_that_comes_behind_the_end() -> None:
    """The end of a stream of datagrams may come first; it was meant all the same."""
    with yarpy.Port("/in", names=yarpy.LocalNames()) as port:
        hub = port._hub

        def lost(source: str) -> bool:
            reconnect.input_lost(hub, Route(source, "/in", "udp"))
            waits = [item.route.source for item in reconnect.RECONNECTOR._lost if item.hub is hub]
            return source in waits

        assert disconnecting.disconnect_input(hub, "/gone", by_sender=True)[0] is False
        assert not lost("/gone")
        assert lost("/other")
        assert disconnecting.disconnect_input(hub, "/other", by_sender=True)[0]
        assert lost("/other")  # that goodbye was for the one before


def test_no_signal_handler_leaves_the_watch_locked(names: yarpy.LocalNames) -> None:
    """Every port of the process would wait for ever, as soon as one of its connections broke."""
    number = 0
    with yarpy.Port("/in", names=names) as port:
        hub = port._hub
        for number, one in enumerate(moments()):
            with suppress(Cut), one.interrupts(cut):
                reconnect.input_lost(hub, Route("/away", "/in", "tcp"))

            def others() -> bool:
                reconnect.input_lost(hub, Route("/gone", "/in", "tcp"))
                return True

            assert elsewhere(others), f"moment {number}"
    assert number > 10


SENDER = Route("/out", "/in", "tcp")


def back(port: yarpy.Port) -> Lost:
    """An input of `port` whose sender was gone, and lives again."""
    return Lost(port._hub, SENDER, incoming=True, seen_gone=True)


def test_a_sender_that_begins_anew_may_dial_by_itself(names: yarpy.LocalNames) -> None:
    """Of two connections one ends, with what is on its way: it is not asked at once."""
    reconnector = reconnect.Reconnector()
    with yarpy.Port("/in", names=names) as port:
        item = back(port)
        assert not reconnector._ask_sender(item), "nobody is there"
        with yarpy.Port("/out", names=names) as out:
            assert not reconnector._ask_sender(item)
            item.put_off(time.perf_counter())
            assert not out.outputs and item.due == (item.back or 0.0) + CALM
            assert item.back is not None
            item.back -= CALM
            assert reconnector._ask_sender(item)
            wait_until(lambda: port.inputs)
        wait_until(lambda: not port.inputs)
        assert not reconnector._ask_sender(item) and item.back is None, "it is gone once more"


def test_a_sender_that_dials_while_it_answers_is_not_asked(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[object] = []
    ask = probe.AdminConnection.ask

    def dials(visit: probe.AdminConnection, question: Any) -> Any:
        asked.append(question[0])
        answer = ask(visit, question)
        out.connect("/in")
        wait_until(lambda: port.inputs)
        return answer

    monkeypatch.setattr(probe.AdminConnection, "ask", dials)
    with yarpy.Port("/in", names=names) as port, yarpy.Port("/out", names=names) as out:
        item = back(port)
        item.back = time.perf_counter() - CALM
        assert reconnect.Reconnector()._ask_sender(item)
    assert asked == [yarpy.Vocab("list")]


def test_a_port_that_got_the_number_of_a_sender_is_not_asked(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/in", names=names) as port, yarpy.Port("/other", names=names) as other:
        names.register("/out", "tcp", "127.0.0.1", other.contact.port)
        item = back(port)
        item.back = 0.0
        assert not reconnect.Reconnector()._ask_sender(item) and item.back is None
