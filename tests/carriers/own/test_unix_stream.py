"""unix_stream: no index, messages tell their own end; acknowledgements on request."""

from __future__ import annotations

import pytest
from support.capture import load_capture
from support.steps import chop
from support.system import NO_UNIX_SOCKETS

from yarpy.carriers.own.unix_stream import UnixStream
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.testing import CarrierConformance, Dialogue, End
from yarpy.wire.message import Packet
from yarpy.wire.stream import ByteStream, run


class TestUnixStream(CarrierConformance):
    carrier = UnixStream
    missing = NO_UNIX_SOCKETS


class TestUnixStreamAck(CarrierConformance):
    carrier = UnixStream
    modifiers = "+ack"
    missing = NO_UNIX_SOCKETS


MESSAGES = [
    # value, envelope, the bytes of C++ 3.9.1
    ([], "", load_capture("unix_stream_receiver").steps[1].data),
    ([5], "", load_capture("unix_stream_receiver").steps[2].data),
    ([6], "1 .5", load_capture("unix_stream_receiver").steps[3].data),
]


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize(("value", "envelope", "data"), MESSAGES)
def test_golden_messages(value: object, envelope: str, data: bytes, piece: int) -> None:
    carrier, stream = UnixStream(Route("/a", "/b")), ByteStream()
    carrier.encode(stream, Packet(value, envelope.encode()))
    assert b"".join(stream.take_output()) == data
    message = run(carrier.decode(stream), stream, chop(data, piece))
    assert (message.key, message.value, message.envelope) == ("D", value, envelope)


def test_golden_quit() -> None:
    carrier, stream = UnixStream(Route("/a", "/b")), ByteStream()
    carrier.encode_quit(stream)
    assert b"".join(stream.take_output()) == load_capture("unix_stream_receiver").steps[4].data


@pytest.mark.parametrize(
    ("carrier", "capture", "source"),
    [
        ("unix_stream", "unix_stream_handshake", "/cap/out"),
        ("unix_stream", "unix_stream_receiver", "/cap/pysend"),
    ],
)
def test_golden_greeting(carrier: str, capture: str, source: str) -> None:
    end = End()
    end.begin(UnixStream(Route(source, "/cap/in", carrier)).greet(end.stream))
    assert end.done
    assert end.take() == load_capture(capture).steps[0].data
    assert (end.opened[0].kind, end.opened[0].listen) == ("unix", False)


def test_greeting_with_acknowledgements() -> None:
    """Our greeting also names the modifier, as a C++ sender's does; the recorded hand-made one
    did not."""
    end = End()
    carrier = UnixStream(Route("/cap/pysend", "/cap/in", "unix_stream+ack"))
    end.begin(carrier.greet(end.stream))
    assert end.take() == b"UNIX_ACK\x12\0\0\0/cap/pysend (ack)\0"
    assert carrier.acks
    data = load_capture("unix_stream_receiver_ack").steps[0].data
    acceptor, end = UnixStream(Route("", "/cap/in", "unix_stream")), End()
    end.begin(acceptor.welcome(end.stream, data[:8]))
    end.feed(data[8:])
    assert end.done
    assert acceptor.acks
    assert acceptor.route.source == "/cap/pysend"


def test_acknowledgement_is_four_bytes() -> None:
    talk = Dialogue(UnixStream, "+ack", piece=1)
    talk.greet()
    talk.send([1])
    talk.traffic.clear()
    talk.acknowledge()
    assert talk.traffic == [("acceptor", load_capture("unix_stream_receiver_ack").steps[2].data)]


def test_something_else_than_an_acknowledgement() -> None:
    carrier, stream = UnixStream(Route("/a", "/b", "unix_stream+ack")), ByteStream()
    with pytest.raises(RemoteProtocolError, match="expected an acknowledgement"):
        run(carrier.expect_ack(stream), stream, [b"NACK"])


def test_message_without_port_command() -> None:
    carrier, stream = UnixStream(Route("/a", "/b")), ByteStream()
    with pytest.raises(RemoteProtocolError, match="port command"):
        run(carrier.decode(stream), stream, [b"no command at all"])


def test_commands_without_payload() -> None:
    carrier, stream = UnixStream(Route("/a", "/b")), ByteStream()
    for key in ("q", "r", "*"):
        data = b"\0\0\0\0~" + key.encode() + b"\0\1"
        assert run(carrier.decode(stream), stream, [data]).key == key
        stream = ByteStream()
