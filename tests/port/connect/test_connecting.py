"""Connecting: what is understood, what becomes of it, and the errors that programs get."""

from __future__ import annotations

import socket
import threading

import pytest
from support.system import NO_UNIX_SOCKETS
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    NotAllowed,
    RemoteProtocolError,
    UnknownName,
    UnknownPlugin,
    YarpError,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcServer

CASES = [
    # target, carrier, error, words
    ("/none", "tcp", UnknownName, "is registered"),
    ("/127.0.0.1:1", "tcp", LinkClosed, '"/out" cannot connect to "/127.0.0.1:1" over tcp: nobody'),
    ("/in", "tpc", UnknownPlugin, 'did you mean "tcp"'),
    ("/in", "tcp+send.nosuch", UnknownPlugin, "nosuch"),
    ("/in", "tcp+send.throttleDown+period_ms.x", LocalProtocolError, "takes a number"),
    ("/in", "tcp+recv.nosuch", LocalProtocolError, '"/in" hung up: most likely no monitor'),
    ("/in", "tcp+recv.throttleDown+period_ms.x", LocalProtocolError, "takes a number"),
    ("/in", "tcp+recv.portmonitor+file.x", LocalProtocolError, "over the network do not run here"),
    ("/in", "tcp+log.out", NotAllowed, '"/out" cannot connect to "/in" over tcp: Logger'),
    ("/127.0.0.1:99999999", "tcp", AddressError, "65535"),
]


@pytest.mark.parametrize(("target", "carrier", "kind", "words"), CASES)
def test_error_that_fits(
    target: str, carrier: str, kind: type[YarpError], words: str, names: LocalNames
) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        with pytest.raises(YarpError) as caught:
            out.connect(target, carrier)
        assert type(caught.value) is kind
        assert words in str(caught.value)
        assert not out.outputs


def test_what_a_port_does_not_do(names: LocalNames) -> None:
    with (
        RpcServer("/server", lambda m: None, names=names) as server,
        Port("/in", names=names) as in_,
    ):
        with pytest.raises(NotAllowed, match="Outputs not allowed"):
            server.connect("/in")
        with pytest.raises(NotAllowed, match='"/server" -> "/in" was refused: Outputs not'):
            in_.listen_to("/server")


def test_peer_that_breaks_the_rules(names: LocalNames) -> None:
    with socket.create_server(("127.0.0.1", 0)) as peer, Port("/out", names=names) as out:

        def serve() -> None:
            sock, _ = peer.accept()
            with sock:
                sock.recv(1000)
                sock.sendall(b"HTTP/1.1 400 No\r\n\r\n")

        threading.Thread(target=serve, daemon=True).start()
        with pytest.raises(RemoteProtocolError, match='"/out" cannot connect to'):
            out.connect(f"/127.0.0.1:{peer.getsockname()[1]}")


def test_own_multicast_group_does_not_count_as_a_name(names: LocalNames) -> None:
    with pytest.raises(UnknownName), Port("/out", names=names) as out:
        out.connect("/nobody", "mcast")


@pytest.mark.parametrize("end", ["", "/", "/in"])
def test_carrier_in_front_of_an_address_counts(names: LocalNames, end: str) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect(f"text://{in_.address}{end}")
        assert [link.carrier for link in out.outputs] == ["text"]


def test_unknown_carrier_in_front_of_an_address(names: LocalNames) -> None:
    with Port("/out", names=names) as out, pytest.raises(UnknownPlugin, match="texxt"):
        out.connect("texxt://127.0.0.1:10002/")


def test_what_pulls_is_ended_by_who_has_made_it(names: LocalNames) -> None:
    """A port that watches a camera has an input from it, and ends it in the words it began with."""
    with Port("/camera", names=names) as camera, BufferedPort("/view", names=names) as view:
        for target in ("/camera", f"/{camera.address}", f"mjpeg://{camera.address}/"):
            view.connect(target, "mjpeg")
            assert view.inputs
            assert view.disconnect(target)
            wait_until(lambda: not view.inputs and not camera.outputs)
            assert not view.disconnect(target)


@pytest.mark.parametrize(
    ("carrier", "words"),
    [
        ("websocket+recv.throttleDown", "websocket does not tell the receiver of throttleDown"),
        ("xmlrpc+recv.a+recv.b", "xmlrpc does not tell the receiver of a, b"),
        ("mjpeg+send.throttleDown", "mjpeg does not tell the sender of throttleDown"),
    ],
)
def test_monitor_that_the_other_end_would_not_hear_of(
    carrier: str, words: str, names: LocalNames
) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        with pytest.raises(LocalProtocolError, match=words):
            out.connect("/in", carrier)
        assert not out.outputs and not out.inputs


def test_what_stands_in_parentheses_is_the_parameter_of_a_monitor(names: LocalNames) -> None:
    carrier = "tcp+send.throttleDown+period_ms.1+(note a+log.in b)"
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", carrier)
        assert [link.carrier for link in out.outputs] == [carrier]
        assert out.write([1]) == 1
        assert in_.read(timeout=HANG).value == [1]


def test_what_is_fetched_is_an_input_at_once_or_refused(names: LocalNames) -> None:
    """Who dials a camera is the receiver, and hears what is wrong with its own monitors."""
    with Port("/camera", names=names) as camera, Port("/view", names=names) as view:
        with pytest.raises(UnknownPlugin, match="nosuch"):
            view.connect("/camera", "mjpeg+recv.nosuch")
        assert not view.inputs
        view.connect("/camera", "mjpeg+recv.throttleDown+period_ms.5")
        assert [link.source for link in view.inputs] == ["/camera"]
        told = yarpy.admin("/view", "get", "in", "/camera", names=names)
        assert told == [[["period_ms", 5.0]]]
        wait_until(lambda: len(camera.outputs) == 1)


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "mcast", "text_ack"])
def test_nothing_is_lost_after_connecting(carrier: str, names: LocalNames) -> None:
    """What is written right after `connect` arrives, over datagrams too."""
    with (
        Port("/out", names=names) as out,
        BufferedPort("/in", strict=True, names=names) as in_,
    ):
        for turn in range(6):
            out.connect("/in", carrier)
            out.write([turn])
            assert in_.read(timeout=HANG).value == [turn]


def test_port_that_waits_for_its_reader_is_not_connected_to_itself(names: LocalNames) -> None:
    """Its first thread would wait for ever for what it does itself."""
    with Port("/both", names=names) as both:
        for target in ("/both", f"/{both.address}", f"/localhost:{both.contact.port}"):
            with pytest.raises(NotAllowed, match=r"BufferedPort\(\) or a callback"):
                both.connect(target)
        with pytest.raises(yarpy.YarpError, match="waits until it is read"):
            yarpy.connect("/both", "/both", names=names)
        assert not both.outputs


def test_other_ports_may_be_connected_to_themselves(names: LocalNames) -> None:
    with BufferedPort("/both", strict=True, names=names) as both:
        both.connect("/both")
        for number in range(600):
            assert both.write([number]) == 1
        assert [both.read(timeout=HANG).value[0] for _ in range(600)] == [*range(600)]


@pytest.mark.skipif(bool(NO_UNIX_SOCKETS), reason=NO_UNIX_SOCKETS)
@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (
            b"* Error. Protocol not found.\r\n* Hello.\r\n",
            r'answers "\* Error. Protocol not found."',
        ),
        (b"", "the peer hung up; it does not take this carrier"),
    ],
)
def test_peer_that_does_not_come_to_the_meeting_place(
    answer: bytes, words: str, names: LocalNames
) -> None:
    """Nobody waits there until the time is over."""
    with socket.create_server(("127.0.0.1", 0)) as peer, Port("/out", names=names) as out:

        def serve() -> None:
            sock, _ = peer.accept()
            with sock:
                sock.recv(1000)
                sock.sendall(answer)

        threading.Thread(target=serve, daemon=True).start()
        with pytest.raises(RemoteProtocolError, match=words):
            out.connect(f"/127.0.0.1:{peer.getsockname()[1]}", "unix_stream")
        assert not out.outputs


def test_a_connection_whose_replacement_is_refused_comes_back(names: LocalNames) -> None:
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names):
        out.connect("/in", "fast_tcp")
        with pytest.raises(yarpy.YarpError):
            out.connect("/in", "udp+send.adaptive")
        wait_until(lambda: [str(link.carrier) for link in out.outputs] == ["fast_tcp"])
