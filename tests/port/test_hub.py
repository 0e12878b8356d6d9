"""A port's connections: opening and closing it, who displaces whom."""

from __future__ import annotations

import contextlib
import os
import socket
import threading
import time
from itertools import groupby
from types import SimpleNamespace

import pytest
from support.port import free_port
from support.wait import wait_until

from yarpy import network
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import (
    LinkClosed,
    NoNameServer,
    PortClosed,
    UnknownName,
    YarpError,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port import hub as hub_module
from yarpy.port import probe
from yarpy.port.hub import Crew, Hub
from yarpy.port.mailbox import Latest
from yarpy.port.port import Port
from yarpy.port.registration import Registration
from yarpy.wire import framing
from yarpy.wire.message import Message

# ---------------------------------------------------------------------------------- opening


def test_open_port_is_registered_and_says_what_it_is(names: LocalNames) -> None:
    with Port("/here", names=names, port_type="bottle") as port:
        contact = names.query("/here")
        assert contact == Contact("tcp", "/here", "127.0.0.1", port.contact.port)
        assert "tcp" in names.get("/here", "offers")
        assert "tcp" in names.get("/here", "accepts")
        assert names.get("/here", "process") == [str(os.getpid())]
        assert names.get("/here", "ips")
    assert names.query("/here") is None


def test_hub_knows_nobody_who_acts_on_it() -> None:
    """What commands, administration and reconnecting do is handed in."""
    told: list[str] = []
    reconnect = SimpleNamespace(
        watch=lambda hub: told.append(f"watch {hub.name}"),
        forget=lambda hub: told.append(f"forget {hub.name}"),
        input_lost=lambda hub, route: None,
    )
    crew = Crew(
        administer=lambda hub, message: Bottle(["as", "you", "like"]),
        obey=lambda hub, link, message: [f"{hub.name} heard {message.key}"],
        close_output=lambda hub, link: None,
        reconnect=reconnect,  # type: ignore[arg-type]
    )
    registration = Registration("/here", None, "", register=False)
    hub = Hub(registration, Latest(), crew)
    hub.open(0, "")
    try:
        contact = Contact("tcp", "/here", "127.0.0.1", hub.port)
        assert probe.ask(contact, ["whatever"]) == ["as", "you", "like"]
        assert probe.describe(contact)[0] == "/here heard *"
    finally:
        hub.close()
    assert told == ["watch /here", "forget /here"]


# ---------------------------------------------------------------------------------- closing


def test_closing_tells_senders_and_receivers(names: LocalNames) -> None:
    with (
        Port("/out", names=names) as out,
        Port("/middle", names=names) as middle,
        Port("/in", names=names) as in_,
    ):
        out.connect("/middle")
        middle.connect("/in")
        assert in_.wait_for_inputs(timeout=5)
        middle.close()
        middle.close()
        assert out.outputs == []
        wait_until(lambda: not in_.inputs)
        assert names.query("/middle") is None
        assert out.write([1]) == 0
        with pytest.raises(UnknownName):
            out.connect("/middle")


def test_closing_frees_the_number_and_its_threads(names: LocalNames) -> None:
    before = threading.active_count()
    for _ in range(5):
        with Port("/in", names=names) as in_, Port("/out", names=names) as out:
            out.connect("/in")
            out.write([1])
            in_.read(timeout=5)
            number = in_.contact.port
        with socket.socket() as sock:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            sock.bind(("", number))
    wait_until(lambda: threading.active_count() <= before + 1)


# ---------------------------------------------------------------------------------- displacing


def test_new_connection_of_the_same_sender_replaces_the_old(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for carrier in ("fast_tcp", "udp", "text_ack", "tcp"):
            out.connect("/in", carrier)
            assert [o.carrier for o in out.outputs] == [carrier]
            wait_until(lambda c=carrier: [i.carrier for i in in_.inputs] == [c])
            out.write([carrier])
            assert in_.read(timeout=5).value == [carrier]


def _dial_at_once(port: Port, greeting: bytes, count: int) -> list[socket.socket]:
    start = threading.Barrier(count)
    socks = [socket.socket() for _ in range(count)]

    def dial(sock: socket.socket) -> None:
        sock.connect(("127.0.0.1", port.contact.port))
        start.wait()
        sock.sendall(greeting)

    threads = [threading.Thread(target=dial, args=(sock,)) for sock in socks]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for sock in socks:
        sock.setblocking(False)
    return socks


def _is_over(sock: socket.socket) -> bool:
    try:
        while sock.recv(1000):
            pass  # the welcome
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True


def test_of_connections_that_one_sender_makes_at_once_one_stays(names: LocalNames) -> None:
    """With two of them every message would come twice."""
    events: list[bool] = []
    with Port("/in", names=names) as in_:
        in_.on_connection(lambda event: events.append(event.created))
        for number in range(50):
            socks = _dial_at_once(in_, b"CONNECT /same\r\n", 4)
            wait_until(lambda: sum(map(_is_over, socks)) == 3, what="three replaced")  # noqa: B023
            assert len(in_.inputs) == 1
            for sock in socks:
                with contextlib.suppress(OSError):
                    sock.sendall(b"D\r\n%d\r\n" % number)
            assert in_.read(timeout=5).value == [number]
            for sock in socks:
                sock.close()
            wait_until(lambda: len(events) == 8 * (number + 1))  # noqa: B023
            assert in_.inputs == []
        assert events == [True, False] * 200
        assert in_.stats["past"]["inputs"]["messages"] == 50


def test_nothing_of_a_replaced_connection_comes_after_its_successor(names: LocalNames) -> None:
    came: list[object] = []
    with Port("/in", names=names, callback=lambda message: came.append(message.value[0])) as in_:
        for _ in range(25):
            came.clear()
            socks = _dial_at_once(in_, b"", 4)
            for sock in socks:
                who = b"%d" % sock.fileno()
                sock.sendall(b"CONNECT /same\r\n" + b"D\r\n%b\r\n" % who * 20)
            wait_until(lambda: sum(map(_is_over, socks)) == 3)  # noqa: B023
            for sock in socks:
                sock.close()
            wait_until(lambda: not in_.inputs)
            runs = [who for who, _ in groupby(came)]
            assert runs and len(runs) == len(set(runs))


def test_closing_waits_for_a_callback_with_what_a_replaced_connection_brought(
    names: LocalNames,
) -> None:
    busy, go, done = threading.Event(), threading.Event(), threading.Event()

    def callback(message: Message) -> None:
        busy.set()
        go.wait()
        time.sleep(0.1)
        done.set()

    with contextlib.ExitStack() as stack:
        port = Port("/in", names=names, callback=callback)
        first, second = (
            stack.enter_context(socket.create_connection(("127.0.0.1", port.contact.port)))
            for _ in range(2)
        )
        first.sendall(b"CONNECT /same\r\nD\r\n1\r\n")
        assert busy.wait(5)
        second.sendall(b"CONNECT /same\r\n")
        first.setblocking(False)
        wait_until(lambda: _is_over(first))
        go.set()
        port.close()
        assert done.is_set()


def test_unrooted_names_do_not_displace(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        socks = [socket.create_connection(("127.0.0.1", in_.contact.port)) for _ in range(3)]
        for sock in socks:
            sock.sendall(b"CONNECT visitor\r\n")
        wait_until(lambda: len(in_.inputs) == 3)
        for sock in socks:
            sock.close()
        wait_until(lambda: not in_.inputs)


def test_sender_that_is_busy_does_not_hold_its_successor_up(names: LocalNames) -> None:
    """The old connection waits for a reader; the new one takes its place all the same."""
    with Port("/in", names=names) as in_:
        first = socket.create_connection(("127.0.0.1", in_.contact.port))
        first.sendall(b"CONNECT /same\r\nD\r\n1\r\n")
        wait_until(lambda: in_.waiting == 1)
        started = time.monotonic()
        second = socket.create_connection(("127.0.0.1", in_.contact.port))
        second.sendall(b"CONNECT /same\r\nD\r\n2\r\n")
        assert in_.read(timeout=5).value == [1]
        assert in_.read(timeout=5).value == [2]
        assert time.monotonic() - started < 4
        for sock in (first, second):
            sock.close()


# ---------------------------------------------------------------------------------- failures


def test_error_for_a_peer_that_is_not_there(names: LocalNames) -> None:
    names.register("/gone", "tcp", "127.0.0.1", free_port())
    with Port("/out", names=names) as out:
        with pytest.raises(LinkClosed, match='"/out" cannot connect to "/gone" over tcp'):
            out.connect("/gone")
        with pytest.raises(YarpError):
            out.connect("/127.0.0.1:1")
        assert out.outputs == []


def test_snapshot_tells_all(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        out.write([1])
        in_.read(timeout=5)
        stats = in_.stats
        assert stats["name"] == "/in"
        assert stats["inputs"][0]["source"] == "/out"
        assert stats["inputs"][0]["messages"] == 1
        assert stats["outputs"] == []
        assert stats["waiting"] == 0
        assert out.stats["outputs"][0]["target"] == "/in"


class Frozen(LocalNames):
    """A name service that at some time does not answer any more."""

    frozen = False
    asked = 0  # by the test's own thread, in vain

    def query(self, name: str) -> Contact | None:
        if self.frozen:
            self.asked += threading.current_thread() is threading.main_thread()
            raise NoNameServer("it does not answer within 10 s")
        return super().query(name)


def test_closing_waits_once_for_a_name_service_that_does_not_answer() -> None:
    """It used to wait for each connection: minutes, with a dozen of them."""
    names = Frozen()
    with contextlib.ExitStack() as stack:
        for number in range(3):
            stack.enter_context(Port(f"/out{number}", names=names))
        here = Port("/here", names=names)
        for number in range(3):
            network.connect(f"/out{number}", "/here", names=names)
        wait_until(lambda: len(here.inputs) == 3)
        names.frozen = True
        here.close()
        assert names.asked == 1
        names.frozen = False


def test_one_computer_does_not_take_all_inputs_over_datagrams(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(hub_module, "MAX_DATAGRAM_INPUTS", 8)
    monkeypatch.setattr(
        "yarpy.link.admission.same_computer", lambda remote, local: remote == "127.0.0.1"
    )
    greeting = framing.number(framing.BASE) + framing.encode_name("")
    with Port("/in", names=names) as port, Port("/out", names=names) as out:
        for _ in range(4):
            where = "127.0.0.1", port.contact.port
            with socket.create_connection(where, 5, ("127.0.0.2", 0)) as sock:
                sock.sendall(greeting)
                assert sock.recv(1)
        wait_until(lambda: caplog.text.count("too many inputs over datagrams already") == 2)
        out.connect("/in", "udp")
        wait_until(lambda: len(port.inputs) == 3)


def test_closed_port_cannot_be_resumed(names: LocalNames) -> None:
    """Its readers would wait for ever."""
    port = Port("/here", names=names)
    port.close()
    port.resume()
    with pytest.raises(PortClosed):
        port.read(timeout=5)


def test_greetings_over_datagrams_do_not_pile_up(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Each leaves a thread and a socket behind when its TCP connection is gone."""
    monkeypatch.setattr(hub_module, "MAX_DATAGRAM_INPUTS", 5)
    udp = framing.number(framing.BASE) + framing.encode_name("")
    mcast = framing.number(framing.BASE + 1) + framing.encode_name("/stranger")
    with Port("/in", names=names) as port, Port("/out", names=names) as out:
        for number in range(8):
            first = (udp, mcast.replace(b"stranger", b"strange%d" % number))[number % 2]
            with socket.create_connection(("127.0.0.1", port.contact.port)) as sock:
                sock.sendall(first + (bytes((224, 1, 200, 9, 40, 0)) if number % 2 else b""))
                wait_until(lambda: len(port.inputs) == min(number + 1, 5))  # noqa: B023
        wait_until(lambda: caplog.text.count("too many inputs over datagrams already, of 5") == 3)
        assert len(port.inputs) == 5
        out.connect("/in")  # other carriers are as welcome as ever
        port._hub.inputs[0].close()
        wait_until(lambda: len(port.inputs) == 5)
        out.connect("/in", "udp")
        assert port.inputs[-1].carrier == "udp"
