"""Short questions to ports, and to what only looks like one."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from support.lasted import lasted
from support.listener import listening
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.contact import Contact
from yarpy.data.value import Vocab
from yarpy.errors import LinkClosed, Timeout, YarpError
from yarpy.nameserver.local import LocalNames
from yarpy.port.connect import probe
from yarpy.port.port import Port
from yarpy.port.rpc import RpcServer


@contextmanager
def impostor(serve: Callable[[socket.socket], None]) -> Iterator[Contact]:
    """Something that listens and is no port."""

    def serve_once(sock: socket.socket) -> None:
        with sock:
            serve(sock)

    with listening(serve_once) as (port, _):
        yield Contact("tcp", "/it", "127.0.0.1", port)


def silent(sock: socket.socket) -> None:
    sock.settimeout(5)
    while sock.recv(100):
        pass


def web(sock: socket.socket) -> None:
    sock.recv(100)
    sock.sendall(b"HTTP/1.1 400 Bad Request\r\nConnection: close\r\n\r\n")


def hang_up(sock: socket.socket) -> None:
    pass


def test_whose_port_it_is(names: LocalNames) -> None:
    with Port("/it", names=names) as port:
        assert probe.is_ours(port.contact)
    with impostor(cpp) as contact:
        assert not probe.is_ours(contact)


def cpp(sock: socket.socket) -> None:
    """What a port of C++ says to words that it does not know."""
    file = sock.makefile("rb")
    sock.sendall(b"Welcome " + file.readline()[8:])
    while file.readline():
        sock.sendall(b'[fail] "send [help] for list of valid commands"\r\n<ACK>\r\n')
        file.readline()


UNKNOWN = b'[fail] "send [help] for list of valid commands"\r\n<ACK>\r\n'


def of_cpp(bus: bytes) -> Callable[[socket.socket], None]:
    """What a port of C++ was recorded to say, 4.0.0 or an older one."""

    def talk(sock: socket.socket) -> None:
        said = (
            b"This is /it at tcp://127.0.0.1:1/\r\nThere are no outgoing connections\r\n<ACK>\r\n"
        )
        file = sock.makefile("rb")
        file.read(len(b"CONNACK admin\r\n*\r\na\r\n[stat] in ?\r\n"))
        sock.sendall(b"Welcome admin\r\n" + said + UNKNOWN)
        if file.read(len(b"a\r\n[bus]\r\n")) == b"a\r\n[bus]\r\n":
            sock.sendall(bus)

    return talk


def says_no_more(sock: socket.socket) -> None:
    sock.sendall(b"Welcome admin\r\nThis is /it at tcp://127.0.0.1:1/\r\n")
    silent(sock)


def test_who_is_of_yarp_4(names: LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    with Port("/it", names=names) as port:
        assert probe.introduce(port.contact) == ("/it", False)
    monkeypatch.setattr(probe, "VERSION", HANG)
    with impostor(of_cpp(UNKNOWN)) as contact:
        assert probe.introduce(contact) == ("/it", True)
    with impostor(of_cpp(b'1 "" (())\r\n<ACK>\r\n')) as contact:
        assert probe.introduce(contact) == ("/it", False)
    monkeypatch.setattr(probe, "VERSION", 0.05)
    with impostor(says_no_more) as contact:
        assert probe.introduce(contact) == ("/it", False)


def test_no_more_is_asked_than_the_name() -> None:
    heard: list[bytes] = []

    def listens(sock: socket.socket) -> None:
        sock.sendall(b"Welcome admin\r\nThis is /it at tcp://127.0.0.1:1/\r\n")
        while data := sock.recv(100):
            heard.append(data)

    with impostor(listens) as contact:
        assert probe.who(contact) == "/it"
    assert b"".join(heard) == b"CONNACK admin\r\n*\r\n"


def test_port_answers(names: LocalNames) -> None:
    with Port("/it", names=names) as port:
        contact = port.contact
        assert probe.ask(contact, [Vocab("ver")]) == [Vocab("ver"), 1, 2, 3]
        assert probe.answers(contact)
        assert probe.is_alive(contact)
        lines = probe.describe(contact)
        assert lines[0] == f"This is /it at tcp://{port.address}/"
        assert "There is an input connection from <ping> to /it using text_ack" in lines
        wait_until(lambda: not port.inputs)  # the questions have left


def test_data_can_be_asked_for_too(names: LocalNames) -> None:
    with RpcServer("/it", lambda m: ["got", *m.value], names=names) as server:
        assert probe.ask(server.contact, ["x", 1], key="d", name="me") == ["got", "x", 1]


def test_questions_go_by_names_that_displace_nobody(names: LocalNames) -> None:
    with Port("/it", names=names) as port, Port("/out", names=names) as out:
        out.connect("/it")
        for _ in range(3):
            probe.ask(port.contact, [Vocab("list"), Vocab("in")])
        assert [i.source for i in port.inputs] == ["/out"]


def test_input_is_dropped_on_request(names: LocalNames) -> None:
    with Port("/it", names=names) as port:
        sock = socket.create_connection(("127.0.0.1", port.contact.port))
        sock.sendall(b"CONNECT /there\r\n")
        assert port.wait_for_inputs(timeout=HANG)
        probe.drop_input(port.contact, "/there")
        assert port.inputs == []
        probe.drop_input(port.contact, "/there")  # gone already
        sock.close()


def test_another_port_at_that_address_is_not_it(names: LocalNames) -> None:
    with Port("/it", names=names) as port:
        other = Contact("tcp", "/other", port.contact.host, port.contact.port)
        assert not probe.is_alive(other)
        assert probe.answers(other)  # something answers; `yarp exists` asks no more


@pytest.mark.parametrize("serve", [silent, web, hang_up])
def test_impostors_are_found_out_in_time(serve: Callable[[socket.socket], None]) -> None:
    with impostor(serve) as contact:
        started = time.monotonic()
        assert not probe.answers(contact, timeout=0.2)
        with pytest.raises(YarpError):
            probe.ask(contact, [Vocab("ver")], timeout=0.2)
        with pytest.raises(YarpError):
            probe.describe(contact, timeout=0.2)
        assert lasted(started) < 3


def test_nobody_there() -> None:
    contact = Contact("tcp", "/it", "127.0.0.1", free_port())
    assert not probe.answers(contact)
    assert not probe.is_alive(contact)
    with pytest.raises(LinkClosed):
        probe.ask(contact, [Vocab("ver")])


def test_port_that_does_not_get_round_to_answering(names: LocalNames) -> None:
    with RpcServer("/it", lambda m: time.sleep(0.5), names=names) as server:
        with pytest.raises(Timeout):
            probe.ask(server.contact, ["x"], key="d", timeout=0.1)
        assert probe.answers(server.contact)  # administration does not wait for handlers


def test_endless_description_ends() -> None:
    def talk(sock: socket.socket) -> None:
        sock.recv(100)
        sock.sendall(b"Welcome <ping>\r\n")
        while True:
            sock.sendall(b"There is an input connection from x to y using tcp\r\n" * 100)

    with impostor(talk) as contact:
        assert len(probe.describe(contact, timeout=HANG)) == 10_000


# -- a caller ----------------------------------------------------------------------------------


def test_asks_again_and_again_over_one_connection(names: LocalNames) -> None:
    sources = []

    def answer(message):
        sources.append(message.source)
        return ["ok", *message.value]

    with (
        yarpy.RpcServer("/server", answer, names=names) as server,
        probe.Caller(server.contact) as caller,
    ):
        first = caller.ask(["add", 1, 2], timeout=HANG)
        second = caller.ask(["x"], timeout=HANG)
        assert first is not None and first.value == ["ok", "add", 1, 2]
        assert second is not None and second.value == ["ok", "x"]
        assert sources == ["anon_rpc", "anon_rpc"]
        assert [link.source for link in server.inputs] == ["anon_rpc"]


def test_has_the_name_it_is_given_and_any_carrier_with_replies(names: LocalNames) -> None:
    with (
        yarpy.RpcServer("/server", lambda message: [message.source], names=names) as server,
        probe.Caller(server.contact, "/me", carrier="text_ack") as caller,
    ):
        reply = caller.ask(["who"], timeout=HANG)
        assert reply is not None and reply.value == ["/me"]


def test_asks_the_administrative_side(names: LocalNames) -> None:
    with (
        yarpy.RpcServer("/server", lambda message: ["data"], names=names) as server,
        probe.Caller(server.contact, admin=True) as caller,
    ):
        reply = caller.ask([yarpy.Vocab("ver")], timeout=HANG)
        assert reply is not None and reply.value == ["ver", 1, 2, 3]


def test_closing_ends_the_connection_in_good_order(names: LocalNames) -> None:
    reports = []
    with yarpy.Port("/reader", names=names, callback=lambda message: None) as port:
        port.on_connection(reports.append)
        caller = probe.Caller(port.contact, "/me")
        assert port.wait_for_inputs(timeout=HANG)
        caller.close()
        wait_until(lambda: len(reports) == 2)
        assert (reports[-1].created, reports[-1].reason) == (False, "")


def test_a_carrier_without_replies_is_refused(names: LocalNames) -> None:
    with (
        yarpy.RpcServer("/server", lambda message: [], names=names) as server,
        pytest.raises(yarpy.LocalProtocolError, match="udp"),
    ):
        probe.Caller(server.contact, carrier="udp")


def test_nobody_to_call() -> None:
    with pytest.raises(yarpy.LinkClosed):
        probe.Caller(yarpy.Contact("tcp", "/gone", "127.0.0.1", 1), timeout=2)


def test_a_port_that_goes_away_is_an_error_of_ours(names: LocalNames) -> None:
    server = yarpy.RpcServer("/server", lambda message: ["ok"], names=names)
    caller = probe.Caller(server.contact)
    assert caller.ask([1], timeout=HANG) is not None
    server.close()
    with pytest.raises(yarpy.LinkClosed):
        caller.ask([2], timeout=HANG)
