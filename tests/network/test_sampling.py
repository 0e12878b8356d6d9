"""Asking the ports of a network, again and again."""

from __future__ import annotations

import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.peer import brings
from support.wait import HANG, wait_until

import yarpy
from yarpy.carriers.base import Carrier
from yarpy.data.value import Vocab
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError, Timeout, UnknownName
from yarpy.link.begin.handshake import greet
from yarpy.link.driver import Driver
from yarpy.network import sampling
from yarpy.network.sampling import Sampler, ends, flow, flows, state_of
from yarpy.network.traffic import Flow


def test_every_connection_once_as_both_ends_see_it(names: yarpy.LocalNames) -> None:
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.BufferedPort("/b", names=names) as b,
        yarpy.RpcServer("/s", lambda message: message.value, names=names),
        yarpy.RpcClient("/s", name="/c", names=names) as client,
    ):
        a.connect("/b", "udp")
        for number in range(5):
            a.write([number])
        client.call("hello")
        wait_until(lambda: b.inputs and b.inputs[0].stats.messages == 5)
        found: dict[tuple[str, str], Flow] = {}

        def look() -> bool:
            found.update({(flow.source, flow.target): flow for flow in flows(names)})
            return len(found) > 1  # a port that is slow to answer is left out

        wait_until(look)
        assert sorted(found) == [("/a", "/b"), ("/c", "/s")]
        one = found["/a", "/b"]
        assert one.carrier == "udp"
        assert one.sender is not None
        assert one.receiver is not None
        assert (one.sender.messages, one.receiver.messages) == (5, 5)
        assert one.drops == one.receiver.drops
        assert one.measured("rate") > 0
        assert found["/c", "/s"].measured("latency") > 0
        assert flow("/a", "/b", names).carrier == "udp"
        assert [one[:2] for one in ends(b.contact)] == [("/a", "/b")]
        with pytest.raises(UnknownName, match="yarpy ping /b"):
            flow("/b", "/a", names)


def test_rates_are_counted_between_two_looks(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/a", names=names) as a, yarpy.BufferedPort("/b", names=names) as b:
        a.connect("/b")
        with Sampler(names, timeout=HANG) as sampler:
            first = sampler.look()
            assert first.flows["/a", "/b"].rate is None
            for number in range(20):
                a.write([number], wait=True)
            second = sampler.look()
            assert (second.flows["/a", "/b"].rate or 0) > 0
            assert (second.flows["/a", "/b"].speed or 0) > 0
            assert len(b.inputs) + len(a.inputs) == 1, "those who ask are no inputs"
            port = second.ports["/a"]
            assert (port.state, port.ours, port.is_rpc) == ("answers", True, False)
            assert port.pid
            assert "python" in port.program
            assert port.answer_time is not None
            a.close()
            assert set(sampler.look().ports) == {"/b"}
        wait_until(
            lambda: not [link for link in b._hub.inputs.links if link.route.source == "admin"]
        )


def test_messages_of_a_connection_that_ends_are_no_rate(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/a", names=names) as a, yarpy.BufferedPort("/b", names=names):
        a.write([1.5])  # while nobody listens: counted as sent to nobody
        a.connect("/b")
        for number in range(20):
            a.write([number], wait=True)
        with Sampler(names, timeout=HANG) as sampler:
            assert sampler.look().flows["/a", ""].measured("messages") == 0
            a.disconnect("/b")
            wait_until(lambda: not a.outputs)
            past = sampler.look().flows["/a", ""]
            again = sampler.look().flows["/a", ""]
        assert past.measured("messages") == 20
        assert (past.rate, past.speed, again.rate) == (None, None, None)


def test_a_port_that_comes_back_is_asked_again(names: yarpy.LocalNames) -> None:
    with Sampler(names, ["/a", "/nobody"], HANG) as sampler:
        for _ in range(2):
            with yarpy.Port("/a", names=names):
                assert sampler.look().ports["/a"].state == "answers"
        assert sampler.look().ports == {}


def test_what_is_wrong_with_ports_that_do_not_answer(names: yarpy.LocalNames) -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent, socket.socket() as closed:
        closed.bind(("127.0.0.1", 0))
        names.register("/silent", "tcp", "127.0.0.1", silent.getsockname()[1])
        names.register("/dead", "tcp", "127.0.0.1", closed.getsockname()[1])
        names.register("/nowhere", "tcp", "no.such.host.invalid", 9)
        names.register("/camera", "mjpeg", "127.0.0.1", 9)
        with Sampler(names, ["/dead", "/nowhere", "/camera"], HANG) as sampler:
            snapshot = sampler.look()
            states = {name: port.state for name, port in snapshot.ports.items()}
            assert states == {
                "/dead": "refused",
                "/nowhere": "unreachable",
                "/camera": "foreign",
            }
            assert snapshot.flows == {}
        with Sampler(names, ["/silent"], 0.2) as sampler:
            assert sampler.look().ports["/silent"].state == "silent"
            sampler.look()
        silent.settimeout(2)
        silent.accept()[0].close()
        silent.settimeout(0.05)
        with pytest.raises(TimeoutError):
            silent.accept()  # it was left alone the second time
        assert ends(yarpy.Contact("tcp", "/dead", "127.0.0.1", closed.getsockname()[1])) == []


def test_errors_as_states() -> None:
    unreachable = LinkClosed("no route")
    unreachable.__cause__ = OSError(113, "No route to host")
    refused = LinkClosed("refused")
    refused.__cause__ = ConnectionRefusedError()
    found = map(
        state_of,
        (unreachable, refused, Timeout("x"), AccessRefused("x"), RemoteProtocolError("x")),
    )
    assert [*found] == ["unreachable", "refused", "silent", "denied", "other"]


NONSENSE = [
    b"\0" * 100,
    b"HTTP/1.1 400 Bad Request\r\n\r\n",
    # an answer of a gigabyte
    b"\x59\x41\x0a\0\0\0\x52\x50" + b"\1\0" + b"\xff" * 8 + (1 << 30).to_bytes(4, "little"),
]


@pytest.mark.parametrize("nonsense", NONSENSE)
def test_nonsense_costs_its_port_its_place(names: yarpy.LocalNames, nonsense: bytes) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            with server.accept()[0] as peer, suppress(ConnectionError):  # it may leave in a hurry
                peer.sendall(nonsense)
                peer.settimeout(HANG)
                while peer.recv(1000):
                    pass

        thread = threading.Thread(target=answer, daemon=True)
        thread.start()
        names.register("/liar", "tcp", "127.0.0.1", server.getsockname()[1])
        with Sampler(names, timeout=0.3) as sampler:
            port = sampler.look().ports["/liar"]
            assert port.state in ("other", "silent")
        thread.join(HANG)


def test_a_liar_about_others_is_passed_over(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/liar", names=names) as liar:
        lie = [["source", "/x"], ["target", "/y"], ["messages", 5]]
        odd = [["source", "/liar"], ["target", "/y"], ["messages", "many"], ["rate", "fast"]]
        liar._hub.callbacks.node = lambda request: (
            yarpy.Bottle([lie, odd, 7, [["policy", 99]]]) if request[0] == Vocab("stat") else None
        )
        [found] = flows(names)
        assert (found.source, found.target, found.measured("messages")) == ("/liar", "/y", None)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows marks no packets for a program")
def test_a_line_that_cannot_be_made_urgent_is_closed(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Driver] = []

    def greeted(*arguments: Any, **options: Any) -> tuple[Driver, Carrier]:
        driver, carrier = greet(*arguments, **options)
        made.append(driver)
        return driver, carrier

    def silent(*arguments: object, **options: object) -> None:
        raise Timeout("no answer")

    monkeypatch.setattr(sampling, "greet", greeted)
    monkeypatch.setattr(sampling.Line, "ask", silent)
    with yarpy.Port("/a", names=names) as port, pytest.raises(Timeout):
        sampling.Line(port.contact, urgent="/urgent")
    (driver,) = made
    assert driver.transport.sock is not None and driver.transport.sock.fileno() < 0


@pytest.fixture(scope="module")
@brings("cpp")
def cpp(tmp_path_factory: pytest.TempPathFactory) -> Iterator[CppYarp]:
    programs = CppYarp.prepare(tmp_path_factory.mktemp("cpp"))
    with yarpy.NameServer() as server, programs.at("127.0.0.1", server.port) as found:
        yield found


def test_ports_of_cpp_tell_what_they_know(cpp: CppYarp) -> None:
    with CppProgram(cpp) as peer, yarpy.BufferedPort("/py/in") as in_:
        peer.do("port = yarp.BufferedPortBottle(); port.open('/cpp/out')")
        peer.do("yarp.Network.connect('/cpp/out', '/py/in', 'fast_tcp')")
        assert in_.wait_for_inputs(timeout=HANG)
        with Sampler() as sampler:
            for _ in range(2):
                snapshot = sampler.look()
                port, found = snapshot.ports["/cpp/out"], snapshot.flows["/cpp/out", "/py/in"]
                assert (port.state, port.ours) == ("answers", False)
                assert port.pid == peer.process.pid
                assert found.sender is not None and found.receiver is not None
                assert (found.sender.carrier, found.sender.messages) == ("fast_tcp", None)
                assert found.receiver.messages == 0
