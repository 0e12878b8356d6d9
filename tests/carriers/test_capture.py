"""Every recorded connection said again to our carriers, byte for byte, in both roles.

Whole and one byte at a time; with bytes alone, so what a port's owner answers is given. The
dialogues are replayed against real ports in tests/port/test_capture.py.
"""

from __future__ import annotations

from typing import Any

import pytest
from support.capture import Capture, Step, groups, load_capture
from support.difference import DIFFERENT
from support.replay import (
    Answer,
    Served,
    answers_of,
    dial,
    echo,
    initiator_of,
    messages_of,
    read,
    scripted,
    send,
    serve,
    silent,
)

from yarpy.carriers.own.tcp import Tcp
from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.link.begin.handshake import find_carrier
from yarpy.route import parse_carrier
from yarpy.testing import End
from yarpy.testing.drive import GROUP
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import DatagramStream

PIECES = [0, 1]


def sig_answers() -> Answer:
    """What the server of the sig captures replied, in order."""
    import numpy

    import yarpy

    rows = numpy.array([[10 * i + j for j in range(3)] for i in range(2)], float)
    pixels = numpy.array([[0, 10, 20], [1, 11, 21]], numpy.uint8)
    return scripted(
        [
            yarpy.Vector([0.5, 1.5, 2.5]),
            yarpy.Matrix(rows),
            yarpy.Image(pixels, quantum=1),
            yarpy.Sound(numpy.array([[5, -6]], numpy.int16), 44100),
            Stamp(7, 1.25),
            ["?"],
        ]
    )


def answer_for(name: str) -> Answer:
    """The owner of the port that was dialled."""
    if "sig_replies" in name:
        return sig_answers()
    if name in SCRIPTED:
        return scripted(answers_of(load_capture(name)))
    return echo if name in ECHOING else silent


def names(*prefixes: str) -> list[str]:
    return [n for group in groups().values() for n in group if n.startswith(prefixes)]


STREAMED = [n for n in names("conn_") if "udp" not in n and "mcast" not in n and n != "conn_local"]
MALFORMED = groups()["malformed"]
ECHOING = {
    *(n for n in names("conn_") if "rpc" in n),
    *(n for n in MALFORMED if n not in ("body_trailing", "no_wait_for_ack")),
    "api_style_tcp_1",
}
# Dialogues in text whose answers depend on the port: here its answers are taken from the capture,
# so that this is about commands, lines and acknowledgements.
SCRIPTED = {
    *(n for n in groups()["administration"] if n not in ("admin_binary", "api_style_http_1",
                                                         "api_style_tcp_1")),
    *(n for n in groups()["telnet"]),
    "ns_admin",
    "ns_rpc_text_ack",
} - {
    # The port ends these connections in ways that belong to the link: tests/port/test_capture.py.
    *("admin_ros_getPid", "admin_ros_publisherUpdate", "admin_ros_requestTopic"),
    *("telnet_drop_self", "telnet_drop_self_after", "telnet_sender_spaces"),
    *("telnet_rooted_sender_dup", "telnet_reader", "telnet_env_reader"),
}  # fmt: skip


def expected(capture: Capture, step: Step) -> tuple[Step | None, bytes]:
    """What C++ answered to a step: the next one, or nothing."""
    following = capture.steps[step.index + 1 : step.index + 2]
    if following and following[0].sender == "b":
        return following[0], following[0].data
    return None, b""


def compare(capture: Capture, step: Step, got: bytes) -> None:
    difference = DIFFERENT.get(capture.name, {}).get(step.index)
    answer, data = expected(capture, step)
    if difference is None:
        if answer is not None:
            got, data = capture.masked(answer, got), capture.masked(answer, data)
        assert got == data
    elif callable(difference.ours):
        difference.ours(got)
    else:
        assert got == difference.ours


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
@pytest.mark.parametrize("name", sorted({*STREAMED, *MALFORMED, *SCRIPTED, "unix_stream_receiver",
                                         "unix_stream_receiver_ack", "unix_stream_handshake",
                                         "api_style_tcp_1"}))  # fmt: skip
def test_as_acceptor(name: str, piece: int) -> None:
    """Given the initiator's bytes we answer as C++ did."""
    capture = load_capture(name)
    end, served = End(piece), Served()
    end.begin(serve(end, served, answer_for(name), capture.ports.get("acceptor_port", 0)))
    for step in capture.steps:
        if step.sender == "a":
            if not end.done:
                end.feed(step.data)
            compare(capture, step, end.take())


# ---------------------------------------------------------------------------------- as initiator

# C++ writes these bytes in another way that means the same.
WRITTEN_OTHERWISE = {
    "conn_tcp_blob5000": "a blob of 4096 bytes or more is a block of its own: it needs no copy",
    "api_style_tcp_1": "C++ puts command and payload of such a call into one block",
}
# Their initiators were no C++ programs: what they mean is compared, not how they spell it.
BY_HAND = {
    *(n for n in SCRIPTED if n.startswith("admin_") and "_rpc_" not in n),
    "admin_binary",
}
NOT_INITIATED = {
    *MALFORMED,  # nobody of ours writes that
    *groups()["telnet"],  # nor types
    "ns_admin",
    "ns_rpc_text_ack",  # answers of several lines are for name clients: tests/names
}
INITIATED = sorted(
    {*STREAMED, *SCRIPTED, *BY_HAND, "api_style_tcp_1", "unix_stream_receiver",
     "unix_stream_receiver_ack"} - NOT_INITIATED
)  # fmt: skip


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
@pytest.mark.parametrize("name", INITIATED)
def test_as_initiator(name: str, piece: int) -> None:
    """Sending the same messages we write the same bytes, and understand every answer."""
    capture = load_capture(name)
    _, messages = messages_of(capture)
    end = End(piece)
    replies: list[Message | None] = []
    carrier = initiator_of(capture)
    if name == "unix_stream_receiver_ack":
        carrier.route.spec = parse_carrier("unix_stream+ack")
    waits = name != "conn_name_ser_stream"  # of which nobody wanted answers
    end.begin(dial(end, carrier, messages, replies if waits else None))
    said = b""
    for step in capture.steps:
        if step.sender == "b":
            end.feed(step.data)
        said += end.take()
    wanted = capture.said("a")
    if name in WRITTEN_OTHERWISE or name in BY_HAND:
        assert reread(said) == reread(wanted)
    elif name == "unix_stream_receiver_ack":
        # A C++ sender names its modifiers; the hand-made one of the capture did not.
        assert said.replace(b"\x12\0\0\0/cap/pysend (ack)", b"\x0c\0\0\0/cap/pysend") == wanted
    else:
        assert said == wanted
    assert end.done
    # The sender of text does not look at its welcome.
    assert end.stream.waiting == (len(capture.steps[1].data) if unread(capture) else 0)
    if waits:
        assert len(replies) == sum(m.key in ("d", "a") for m in messages)
        assert None not in replies


def unread(capture: Capture) -> bool:
    return capture.steps[0].data.startswith(b"CONNECT ") and not any(
        m.key in "da" for m in messages_of(capture)[1]
    )


def reread(said: bytes) -> list[tuple[str, str, Any]]:
    """What an initiator means by its bytes."""
    end, served = End(), Served()
    end.begin(serve(end, served, lambda message: []))
    end.feed(said)
    return [
        (m.key, m.envelope, m.as_(Bottle) if m.key in "dDa" else m.text) for m in served.messages
    ]


def test_reply_of_a_call_over_text_is_not_the_welcome() -> None:
    """The C++ client takes "Welcome /cap/rc" for its first answer; ours steps over it."""
    capture = load_capture("conn_text_rpc_attempt")
    _, messages = messages_of(capture)
    end = End()
    replies: list[Message | None] = []
    end.begin(dial(end, initiator_of(capture), messages, replies))
    end.feed(capture.said("b"))
    (reply,) = replies
    assert reply is not None
    assert reply.as_(Bottle).to_text() == "[ok] echo (1 ping)"


# ---------------------------------------------------------------------------------- reversed


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
@pytest.mark.parametrize("name", names("reverse_"))
def test_reversed_connection_writes_as_cpp_does(name: str, piece: int) -> None:
    """A reader dials and says `r`: from then on the port writes what the capture has."""
    capture = load_capture(name)
    end, served = End(piece), Served()
    end.begin(serve(end, served, silent, capture.ports["acceptor_port"]))
    for step in capture.steps[:3]:
        if step.sender == "a":
            end.feed(step.data)
            got = end.take()
            if step.index == 0:
                assert got == capture.steps[1].data
    assert served.reversed
    carrier = served.carrier
    assert carrier is not None
    assert carrier.route.source == "/cap/reader"
    # The messages that the port then wrote, read as the reader does.
    found = messages_written(capture)
    assert [m.as_(Bottle).to_text() for m in found] == [
        "",
        "1 ping 3.14000000000000012434",
        '(a (1 2)) (1.5 "x y") [set]',
        "9",
    ]
    for message in found:
        end.begin(send(end, carrier, message))
        got += end.take()
        for step in capture.steps[4:]:
            if step.sender == "a" and not end.done:
                end.feed(step.data)
    assert got == b"".join(s.data for s in capture.steps[3:] if s.sender == "b")


def messages_written(capture: Capture) -> list[Message]:
    """What the reader of a reversed connection reads and acknowledges."""
    end = End()
    accepting, _ = messages_of(capture)
    carrier = find_carrier(parse_carrier(accepting.name))(accepting.route)
    found: list[Message] = []
    end.begin(read(end, carrier, 4, found))
    written = b"".join(s.data for s in capture.steps[3:] if s.sender == "b")
    if carrier.acks:  # of the word `r`
        ack = End()
        carrier.encode_ack(ack.stream, 1)
        written = written.removeprefix(ack.take())
    end.feed(written)
    assert len(found) == 4
    if carrier.acks:
        said = b"".join(s.data for s in capture.steps[4:] if s.sender == "a")
        # C++ never saw the last one: the reader hung up
        assert end.take().startswith(said)
    return found


# ---------------------------------------------------------------------------------- datagrams

DATAGRAMS = [n for n in names("conn_") if "udp" in n or "mcast" in n]


def cut_short(capture: Capture) -> bool:
    return any(step.whole for step in capture.steps)


@pytest.mark.parametrize("name", DATAGRAMS)
def test_datagrams_are_read(name: str) -> None:
    """The greeting over tcp, then every datagram, that of a closing receiver included."""
    capture = load_capture(name)
    tcp = [s for s in capture.steps if not s.transport.startswith("udp")]
    for greeting in [s for s in tcp if s.sender == "a"]:
        end, served = End(1), Served()
        end.begin(serve(end, served, silent))
        end.feed(greeting.data)
        assert isinstance(end.stream, DatagramStream)
        answers = [s for s in tcp if s.sender == "b"]
        assert len(end.take()) == sum(len(s.data) for s in answers)
        for step in capture.steps:
            if step.transport.startswith("udp"):
                end.feed(step.data)
        assert served.carrier is not None
        assert served.carrier.route.source == "/cap/out"
        texts = [(m.as_(Bottle).to_text()[:40], m.envelope) for m in served.messages]
        assert texts == WRITTEN[name]
        assert served.carrier.lost == (1 if cut_short(capture) else 0)


PING = "1 ping 3.14000000000000012434"
NESTED = '(a (1 2)) (1.5 "x y") [set]'
WRITTEN = {
    "conn_udp_stream": [("", ""), (PING, ""), (NESTED, "")],  # the fourth was recorded cut
    "conn_udp_stream_envelope": [("", "1 0.25"), (PING, "2 1.25"), (NESTED, "3 2.25")],
    "conn_udp_fragmented": [("1 {" + "120 " * 9 + "1", "1 0.5"), ("2", "1 0.5")],
    "conn_mcast_stream_envelope": [("", "1 0.25"), (PING, "2 1.25"), (NESTED, "3 2.25")],
    "conn_mcast_two_receivers": [(PING, ""), ("2 ping", "")],
}


@pytest.mark.parametrize("name", DATAGRAMS)
def test_datagrams_are_written(name: str) -> None:
    """Sending the same messages we write the same datagrams."""
    capture = load_capture(name)
    end = End()
    kind = "mcast" if "mcast" in name else "udp"
    carrier = initiator_of_datagrams(kind)
    end.begin(carrier.greet(end.stream))
    greeting = [s for s in capture.steps if s.sender == "a" and "udp" not in s.transport]
    assert end.take() == greeting[0].data  # the made-up group is the recorded one
    assert GROUP == ("224.1.1.3", 21604)
    for answer in [s for s in capture.steps if s.sender == "b" and s.transport == "tcp"]:
        end.feed(answer.data)
    assert end.done
    if name == "conn_udp_fragmented":
        carrier.datagram_size = 1000  # type: ignore[attr-defined]
    receiver, served = End(), Served()
    receiver.begin(serve(receiver, served, silent))
    receiver.feed(greeting[0].data)
    for step in capture.steps:
        if step.transport.startswith("udp") and not step.whole:
            receiver.feed(step.data)
    for message in served.messages:
        carrier.encode(end.stream, Packet(message.as_(Bottle), message.envelope.encode()))
    end.collect()
    recorded = [s.data for s in capture.steps if "udp" in s.transport and s.sender == "a"
                and not s.whole]  # fmt: skip
    assert end.outbox == recorded


def initiator_of_datagrams(kind: str) -> Any:
    from yarpy.route import Route

    return find_carrier(parse_carrier(kind))(Route("/cap/out", "/cap/in", kind))


# ---------------------------------------------------------------------------------- name server


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
@pytest.mark.parametrize("name", ["ns_events", "ns_rpc_tcp", "ns_rpc_fast_tcp"])
def test_name_server_over_binary_carriers(name: str, piece: int) -> None:
    """What is asked is understood; the answers are compared in tests/names and tests/nameserver."""
    capture = load_capture(name)
    end, served = End(piece), Served()
    end.begin(serve(end, served, lambda message: []))
    for step in capture.steps:
        if step.sender == "a":
            end.feed(step.data)
    assert isinstance(served.carrier, Tcp) == (name != "ns_rpc_fast_tcp")
    asked = [step for step in capture.steps[2:] if step.sender == "a"]
    assert len(served.messages) == len(asked)
    for message, step in zip(served.messages, asked, strict=True):
        assert step.data.endswith(message.as_(Bottle).to_bytes())
