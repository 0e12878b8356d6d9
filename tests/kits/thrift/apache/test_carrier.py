"""thrift: recorded calls in pieces, framed or not; ports with a service and without; our client."""

import asyncio
import logging
import socket
from collections.abc import Iterator
from typing import Any

import pytest
from support.port import free_port
from support.steps import chop, output
from support.thrift_module import SPELLINGS, apache, call, data, everything, head, service
from support.wait import HANG, wait_until

import yarpy
from yarpy import registry
from yarpy.errors import (
    AccessRefused,
    DecodeError,
    LocalProtocolError,
    RemoteProtocolError,
    YarpError,
)
from yarpy.kits.thrift.apache.carrier import Thrift
from yarpy.kits.thrift.apache.message import Call
from yarpy.kits.thrift.apache.protocol import Fault
from yarpy.link.begin.handshake import recognise
from yarpy.route import Route, parse_carrier
from yarpy.wire.effects import May
from yarpy.wire.stream import ByteStream

WAYS = [(spelling, framed) for spelling in SPELLINGS for framed in (False, True)]
CALLS = ("echo", "add", "nothing", "fire", "true")


def framed_data(name: str, spelling: str, framed: bool) -> bytes:
    found = data(name, spelling)
    return len(found).to_bytes(4, "big") + found if framed else found


def accept(pieces: list[bytes], may: str = "") -> tuple[Thrift, ByteStream, Call]:
    """The first call of a client; `may`: why it may not make one."""
    carrier = Thrift(Route("", "/server", "thrift", 0))
    stream = ByteStream()
    rest = b"".join(pieces)
    assert recognise(rest[:8]) is Thrift
    stream.feed(rest[:8])
    pieces = [rest[8 : len(pieces[0])], *pieces[1:]] if len(pieces[0]) > 8 else chop(rest[8:], 1)

    def run() -> Any:
        yield from stream.more(8)
        first = yield from stream.read_exact(8)
        yield from carrier.welcome(stream, bytes(first))
        return (yield from carrier.decode(stream))

    steps = run()
    effect = next(steps)
    while True:
        try:
            if isinstance(effect, May):
                effect = steps.send(may)
            else:
                stream.feed(pieces.pop(0))
                effect = steps.send(None)
        except StopIteration as stop:
            return carrier, stream, stop.value


@pytest.mark.parametrize("size", [0, 1])
@pytest.mark.parametrize(("spelling", "framed"), WAYS)
@pytest.mark.parametrize("name", CALLS)
def test_calls_are_told_apart_by_their_first_bytes(
    name: str, spelling: str, framed: bool, size: int
) -> None:
    carrier, stream, found = accept(chop(framed_data(name, spelling, framed), size))
    assert (carrier.spelled, carrier.framed) == (spelling, framed)
    assert found.head == head(name) and found.at == call(name, spelling).at
    assert bytes(found.payload) == data(name, spelling) and not stream.waiting


@pytest.mark.parametrize(("spelling", "framed"), WAYS)
def test_answers_are_those_of_apache(spelling: str, framed: bool) -> None:
    carrier, stream, found = accept([framed_data("add", spelling, framed)])
    carrier.encode_reply(stream, service()(found))
    carrier.encode_ack(stream, 1)
    assert output(stream) == framed_data("added", spelling, framed)


def test_an_acknowledgement_that_comes_late_answers_nothing() -> None:
    carrier, stream, _ = accept([data("fire", "binary")])
    stream.feed(data("add", "binary"))
    with pytest.raises(StopIteration):
        next(carrier.decode(stream))
    carrier.encode_ack(stream, 1)
    assert output(stream) == b""
    carrier.encode_ack(stream, 1)
    assert b"there is no service" in output(stream)


def test_who_may_not_write_hears_why() -> None:
    with pytest.raises(AccessRefused, match="not you"):
        accept([data("add", "binary")], may="not you")


@pytest.mark.parametrize(
    "first",
    [
        b"\0\0\1\0\0\0\0\0",
        b"\x80\x02\0\1\0\0\0\3",
        b"\x82\x22aaaaaa",
        b"\0\0\0\x10GET /",
        b"\x10MQTT",
    ],
)
def test_other_connections_are_not_taken(first: bytes) -> None:
    assert Thrift.recognises(first) == 0


def test_a_frame_has_a_limit() -> None:
    carrier, stream = Thrift(Route("", "/server", "thrift+framed", 0)), ByteStream(1000)
    for size in (0, 1001, -1):
        stream.feed(size.to_bytes(4, "big", signed=True))
        with pytest.raises(RemoteProtocolError, match=f"a frame of {size} bytes is announced"):
            next(carrier.decode(stream))


def test_answers_are_no_calls() -> None:
    carrier, stream = Thrift(Route("", "/server", "thrift", 0)), ByteStream()
    stream.feed(data("added", "binary"))
    with pytest.raises(RemoteProtocolError, match="a message of kind 2"):
        next(carrier.decode(stream))


def test_words_that_it_does_not_know() -> None:
    with pytest.raises(LocalProtocolError, match='thrift knows no "\\+frame"'):
        Thrift.of(parse_carrier("thrift+frame"))


# -- over sockets ---------------------------------------------------------------------------------


@pytest.fixture
def server() -> Iterator[yarpy.RpcServer]:
    with yarpy.RpcServer("/thrift", service(), register=False, names=yarpy.LocalNames()) as found:
        yield found


def way(spelling: str, framed: bool) -> str:
    return "thrift" + ("+compact" if spelling == "compact" else "") + ("+framed" if framed else "")


@pytest.mark.parametrize(("spelling", "framed"), WAYS)
def test_a_client_of_ours(server: yarpy.RpcServer, spelling: str, framed: bool) -> None:
    m = apache()
    target = f"{way(spelling, framed)}://{server.address}"
    with m.Test.connect(target, timeout=HANG) as client:
        assert client.ping() == "pong" and client.add(1) == 11 and client.add(1, b=2) == 3
        assert client.nothing() is None and client.is_on(True) is False
        assert client.echo(everything()) == everything()
        client.fire("x")
        assert client.fail(0) == "x"
        with pytest.raises(m.Bad, match="bad"):
            client.fail(1)
        with pytest.raises(m.Worse):
            client.fail(2)
        with pytest.raises(Fault, match="the server refuses fail: no"):
            client.fail(3)
        with pytest.raises(Fault, match="missing has no result"):
            client.missing()
        assert client.numbers(100_000).sum() == 99_999 * 100_000 / 4
        with pytest.raises(TypeError, match=r"add\.a: expected an integer"):
            client.add("x")
        with pytest.raises(LocalProtocolError, match="tell no version"):
            client.remote_version()
        assert client.ping() == "pong"


def test_a_client_in_a_loop_and_one_of_a_port(server: yarpy.RpcServer) -> None:
    target = f"thrift+compact://{server.address}"

    async def main() -> None:
        async with apache().Test.connect_async(target, timeout=HANG) as client:
            assert await client.add(3, 4) == 7
            await client.fire("y")
            with pytest.raises(apache().Bad):
                await client.fail(1)
            with pytest.raises(LocalProtocolError, match="tell no version"):
                await client.remote_version()

    asyncio.run(main())
    names = yarpy.LocalNames()
    with yarpy.RpcClient[apache().Test](target, timeout=HANG, names=names) as port:
        assert port.remote.add(3, 4) == 7
        with pytest.raises(TypeError, match="only the clients of a service"):
            port.call("add", 3, 4)
        assert port.remote.fail(0) == "y"


def test_a_service_in_a_loop() -> None:
    m = apache()

    class Server(m.Test):  # type: ignore[misc, name-defined]
        async def add(self, a: int, b: int) -> int:
            await asyncio.sleep(0)
            return a + b

    async def main() -> None:
        names = yarpy.LocalNames()
        server = yarpy.aio.RpcServer("/thrift", Server(), names=names)
        async with (
            server,
            m.Test.connect_async(f"thrift://{server.address}", timeout=HANG) as client,
        ):
            assert await client.add(1, 2) == 3
            with pytest.raises(Fault, match="does not have this method"):
                await client.ping()

    asyncio.run(main())


def test_a_server_that_is_gone_and_comes_again() -> None:
    names = yarpy.LocalNames()
    port = free_port()
    server = yarpy.RpcServer("/thrift", service(), names=names, tcp_port=port)
    client = apache().Test.connect(f"thrift://{server.address}", timeout=HANG)
    with client:
        assert client.ping() == "pong"
        server.close()
        with pytest.raises(YarpError):
            client.ping()
        with yarpy.RpcServer("/thrift", service(), names=names, tcp_port=port):
            assert client.ping() == "pong"


def ask_raw(address: str, sent: bytes) -> bytes:
    """What comes for bytes that are sent, until nothing more does."""
    host, port = address.rsplit(":", 1)
    with socket.create_connection((host, int(port)), HANG) as sock:
        sock.sendall(sent)
        sock.shutdown(socket.SHUT_WR)
        found = b""
        while part := sock.recv(1 << 16):
            found += part
        return found


@pytest.mark.parametrize(("spelling", "framed"), WAYS)
def test_calls_that_come_at_once_are_answered_in_order(
    server: yarpy.RpcServer, spelling: str, framed: bool
) -> None:
    sent = b"".join(
        framed_data(name, spelling, framed) for name in ("add", "fire", "true", "nothing")
    )
    found = ask_raw(server.address, sent)
    expected = [framed_data(name, spelling, framed) for name in ("added", "false", "done")]
    assert found == b"".join(expected)


@pytest.mark.parametrize("reader", ["handler", "none"])
def test_a_port_without_a_service_says_so(reader: str, caplog: pytest.LogCaptureFixture) -> None:
    names = yarpy.LocalNames()
    called: list[object] = []
    port: Any
    if reader == "handler":
        port = yarpy.RpcServer("/plain", lambda message: called.append(message.value), names=names)
    else:
        port = yarpy.BufferedPort("/plain", names=names)
    with port, caplog.at_level(logging.CRITICAL):
        found = ask_raw(port.address, data("add", "binary"))
    assert found.startswith(bytes.fromhex("80010003 00000003 616464 00000001 0b0001"))
    assert b"there is no service of Thrift at this port" in found and not called


def test_a_connection_of_nonsense_ends_alone(server: yarpy.RpcServer) -> None:
    assert ask_raw(server.address, data("add", "binary")[:15] + b"\xff" * 50) == b""
    with apache().Test.connect(f"thrift://{server.address}", timeout=HANG) as client:
        assert client.ping() == "pong"


def test_loggers_hear_of_calls(server: yarpy.RpcServer) -> None:
    with yarpy.BufferedPort("/log", strict=True, names=yarpy.LocalNames()) as log:
        server.connect(f"/{log.address}", "tcp+log.in")
        with apache().Test.connect(f"thrift://{server.address}", timeout=HANG) as client:
            client.add(1, 2)
        assert log.read(timeout=HANG).value.to_text() == "[rpc] ([add] 1 2) ((3))"


def test_a_port_that_reads_calls_cannot_read_their_value() -> None:
    with yarpy.Port("/reads", names=yarpy.LocalNames()) as port:
        host, number = port.address.rsplit(":", 1)
        with socket.create_connection((host, int(number)), HANG) as sock:
            sock.sendall(data("fire", "binary"))
            wait_until(lambda: port.inputs)
            message = port.read(timeout=HANG)
            with pytest.raises(DecodeError, match='a call of "fire"'):
                assert message.value


def test_it_is_found_by_its_first_bytes_alone() -> None:
    row = registry.carriers.row("thrift")
    assert row is not None and row.home == "kits.thrift"
    for name in CALLS:
        for spelling, framed in WAYS:
            assert row.may_begin(framed_data(name, spelling, framed)[:8])
