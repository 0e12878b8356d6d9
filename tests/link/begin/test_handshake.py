"""The two beginnings of a connection, over real sockets."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from support.lasted import lasted
from support.port import free_port
from support.transport import ScriptTransport
from support.wait import HANG

from yarpy.carriers.own.tcp import Tcp
from yarpy.carriers.own.text import Text
from yarpy.contact import Contact
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    RemoteProtocolError,
    Timeout,
    UnknownPlugin,
    YarpError,
)
from yarpy.link.begin import handshake
from yarpy.link.begin.admission import Admission, Gate, Peer
from yarpy.link.begin.handshake import (
    UNKNOWN_PROTOCOL,
    asked_carrier,
    find_carrier,
    greet,
    recognise,
    welcome,
)
from yarpy.route import Route, parse_carrier
from yarpy.shipped import CARRIERS
from yarpy.transports.tcp import TcpTransport
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


@contextmanager
def answering(serve: Callable[[socket.socket], Any]) -> Iterator[tuple[Contact, list[Any]]]:
    """A listener whose first connection is given to `serve`; its result or error is kept."""
    found: list[Any] = []
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def run() -> None:
            sock, _ = listener.accept()
            try:
                found.append(serve(sock))
            except YarpError as error:
                found.append(error)
                sock.close()  # as the port does

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        yield Contact("tcp", "/target", *listener.getsockname()), found
        thread.join(HANG)
        assert not thread.is_alive()


def welcomed(**options: Any) -> Callable[[socket.socket], Any]:
    return lambda sock: welcome(TcpTransport(sock), "/target", 21602, **options)


@pytest.mark.parametrize("name", [row.name for row in CARRIERS.values() if row.home == "core"])
def test_what_a_carrier_does_not_know_is_refused_where_it_is_asked_for(name: str) -> None:
    for text in ("bla.3", "tls+bla"):
        with pytest.raises(LocalProtocolError, match=f'{name} knows no "\\+bla", but .*log.in'):
            asked_carrier(parse_carrier(f"{name}+{text}"))
    for text in ("", "+log.in", "+recv.priority+bla.3", "+peer_timeout.60"):
        spec = parse_carrier(name + text)
        assert asked_carrier(spec) is find_carrier(spec)


def test_a_carrier_that_names_no_words_takes_any(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of another package, say; and what a peer has added is the peer's matter."""
    assert find_carrier(parse_carrier("tcp+bla.3")) is Tcp
    monkeypatch.setattr(Tcp, "words", None)
    assert asked_carrier(parse_carrier("tcp+bla.3")) is Tcp


def test_both_sides_know_each_other() -> None:
    with answering(welcomed()) as (contact, found):
        driver, carrier = greet(contact, Route("/me", "/target", "tcp+a.b", contact.port))
    assert isinstance(carrier, Tcp)
    (far,) = found
    assert far[1].route == Route("/me", "/target", "tcp+a.b", 21602, "127.0.0.1")
    for side in (driver, far[0]):
        side.transport.close()


def test_with_a_key_both_prove_that_they_know_it() -> None:
    with answering(welcomed(key=b"secret")) as (contact, found):
        driver, _ = greet(contact, Route("/me", "/target", "text_ack"), key=b"secret")
        driver.transport.close()
    found[0][0].transport.close()


def test_wrong_key_is_an_error_on_the_side_that_sees_it() -> None:
    with (
        answering(welcomed(key=b"secret")) as (contact, found),
        pytest.raises(RemoteProtocolError, match=r"auth\.conf"),
    ):
        greet(contact, Route("/me", "/target"), key=b"another")
    assert isinstance(found[0], YarpError)


def test_without_a_key_nobody_gets_in() -> None:
    """The acceptor waits two seconds for the proof, as C++; here less."""
    with (
        answering(welcomed(key=b"secret")) as (contact, found),
        pytest.raises((RemoteProtocolError, LinkClosed, Timeout)),
    ):
        greet(contact, Route("/me", "/target", "text_ack"), timeout=0.5)
    assert isinstance(found[0], YarpError)


@pytest.mark.skipif(not hasattr(socket, "TCP_USER_TIMEOUT"), reason="an option of Linux")
def test_a_connection_says_for_both_ends_when_a_silent_host_is_dead() -> None:
    with answering(welcomed()) as (contact, found):
        driver, _ = greet(contact, Route("/me", "/target", "tcp+peer_timeout.60"))
    for side in (driver, found[0][0]):
        sock = side.transport.sock
        assert sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) == 60_000
        side.transport.close()


def test_what_cannot_be_a_time_limit_is_refused_at_both_ends() -> None:
    contact = Contact("tcp", "/target", "127.0.0.1", free_port())
    with pytest.raises(LocalProtocolError, match=r"as in tcp\+peer_timeout\.60"):
        greet(contact, Route("/me", "/target", "tcp+peer_timeout.soon"))

    with answering(welcomed()) as (contact, found):
        route = Route("/me (peer_timeout 0)", "/target", "text")
        greet(contact, route)[0].transport.close()
    assert isinstance(found[0], RemoteProtocolError)
    assert "peer_timeout.0" in str(found[0])


def test_a_connection_over_datagrams_takes_no_time_limit_for_silence() -> None:
    with (
        answering(welcomed()) as (contact, found),
        pytest.raises(LocalProtocolError, match="peer_timeout is for connections over TCP"),
    ):
        greet(contact, Route("/me", "/target", "udp+peer_timeout.60"))
    assert isinstance(found[0], RemoteProtocolError)


@pytest.mark.parametrize("error", [TypeError("unhashable\nlist"), RecursionError("deep")])
def test_a_greeting_that_finds_a_defect_ends_its_own_connection(error: Exception) -> None:
    class Broken(Tcp):
        @classmethod
        def recognises(cls, first: bytes) -> int:
            return 8

        def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
            raise error
            yield

    with answering(welcomed(carriers=[Broken])) as (contact, found):
        assert contact.host and contact.port
        with socket.create_connection((contact.host, contact.port)) as sock:
            sock.settimeout(20)
            sock.sendall(b"anything")
            with sock.makefile("rb") as file:
                (line,) = file.readlines()
    kind = type(error).__name__
    assert line.startswith(f"* the port has a defect: its greeting led to {kind}".encode())
    assert isinstance(found[0], RemoteProtocolError)
    assert found[0].__cause__ is error


def test_nobody_there() -> None:
    contact = Contact("tcp", "/target", "127.0.0.1", free_port())
    with pytest.raises(LinkClosed, match="nobody answers at 127"):
        greet(contact, Route("/me", "/target"))


def test_peer_that_hangs_up() -> None:
    with (
        answering(lambda sock: sock.close()) as (contact, _),
        pytest.raises(LinkClosed),
    ):
        greet(contact, Route("/me", "/target"))


def test_peer_that_never_answers() -> None:
    started = time.monotonic()
    with (
        answering(lambda sock: sock.recv(1000) and sock) as (contact, found),
        pytest.raises(Timeout),
    ):
        greet(contact, Route("/me", "/target"), timeout=0.2)
    assert lasted(started) < 4
    found[0].close()


def test_peer_that_speaks_something_else() -> None:
    def talk(sock: socket.socket) -> None:
        sock.recv(1000)
        sock.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
        sock.close()

    with answering(talk) as (contact, _), pytest.raises(YarpError):
        greet(contact, Route("/me", "/target", "udp"), timeout=2)


def test_wrong_carrier_name_is_found_before_dialling() -> None:
    contact = Contact("tcp", "/target", "127.0.0.1", free_port())
    with pytest.raises(UnknownPlugin, match='did you mean "tcp"'):
        greet(contact, Route("/me", "/target", "tpc"))


def test_carriers_by_name() -> None:
    assert find_carrier(parse_carrier("tcp")) is Tcp
    assert find_carrier(parse_carrier("text")) is Text
    with pytest.raises(UnknownPlugin, match=r"yarpy\.carriers"):
        find_carrier(parse_carrier("nosuch"))


def test_plugin_that_is_no_carrier() -> None:
    from yarpy import registry

    registry.carriers.add("odd", object())
    try:
        with pytest.raises(UnknownPlugin, match="not a Carrier class"):
            find_carrier(parse_carrier("odd"))
    finally:
        registry.carriers.remove("odd")


# ---------------------------------------------------------------------------------- welcoming


def answer_to(*pieces: bytes, pause: float = 0.0, shut: bool = False) -> tuple[bytes, Any]:
    """What a stranger gets who says this, and what the acceptor makes of it."""
    near, far = socket.socketpair()
    near.settimeout(HANG)
    found: list[Any] = []

    def run() -> None:
        transport = TcpTransport.__new__(TcpTransport)
        super(TcpTransport, transport).__init__(far)
        try:
            found.append(welcome(transport, "/target", 21602))
        except YarpError as error:
            found.append(error)
        far.shutdown(socket.SHUT_RDWR)

    thread = threading.Thread(target=run)
    thread.start()
    for piece in pieces:
        near.sendall(piece)
        time.sleep(pause)
    if shut:
        near.shutdown(socket.SHUT_WR)
    said = b""
    while part := near.recv(1000):
        said += part
    thread.join(HANG)
    near.close()
    far.close()
    return said, found[0]


@pytest.mark.parametrize("first", [b"GARBAGE!", b"\r\n\r\n\r\n\r\n", bytes(8), b"connect test\r\n"])
def test_person_is_told_what_to_type(first: bytes) -> None:
    said, found = answer_to(first)
    assert said == UNKNOWN_PROTOCOL
    assert isinstance(found, RemoteProtocolError)
    assert repr(first[:8]) in str(found)


def test_who_hangs_up_without_a_word_is_nobody() -> None:
    for said in ((), (b"abc",)):
        assert answer_to(*said, shut=True) == (b"", None)


def test_greeting_may_come_byte_by_byte() -> None:
    said, found = answer_to(*[bytes([b]) for b in b"CONNECT me\n"], pause=0.002, shut=True)
    assert said == b"Welcome me\r\n"
    driver, carrier = found
    assert carrier.route.source == "me"
    driver.transport.close()


def test_half_a_greeting_ends_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(handshake, "TIMEOUT", 0.1)
    started = time.monotonic()
    _, found = answer_to(b"CONNECT me and then nothing")
    assert isinstance(found, Timeout)
    assert lasted(started) < 10


def test_recognition_wants_eight_bytes_and_knows_the_installed() -> None:
    assert recognise(b"CONNECT ") is Text
    assert recognise(b"CONNECT?") is None
    assert recognise(b"CONNECT ", [Tcp]) is None


def test_who_says_himself_where_he_is_is_not_of_this_computer() -> None:
    """Inside Zenoh a peer could say that it is we."""
    admitted: list[Peer] = []

    class Asked(Gate):
        def admit(self, peer: Peer) -> Admission:
            admitted.append(peer)
            return super().admit(peer)

    for scheme in ("tcp", "zenoh"):
        transport = ScriptTransport([b"CONNECT /a\r\n"])
        transport.scheme = scheme
        transport.local = transport.remote = ("a1b2.zenoh", 1)
        assert welcome(transport, "/target", 1, gate=Asked()) is not None
    assert [peer.here for peer in admitted] == [True, False]
