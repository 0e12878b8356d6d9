"""text and text_ack: what a person types, and the conformance suite."""

from __future__ import annotations

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.steps import chop

from yarpy.carriers.own.text import Text, TextAck, read_text
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import RemoteProtocolError, YarpError
from yarpy.route import Route
from yarpy.testing import CarrierConformance, Dialogue, End, said
from yarpy.wire.message import Lines, Packet
from yarpy.wire.stream import ByteStream, run


class TestText(CarrierConformance):
    carrier = Text


class TestTextAck(CarrierConformance):
    carrier = TextAck


MESSAGES = [
    # key, value, envelope, the lines of C++ 3.9.1
    ("D", [], "", b"D\r\n\r\n"),
    ("D", [], "1 0.25", b"D 1 0.25\r\n\r\n"),
    ("D", [1, "ping", 3.14], "", b"D\r\n1 ping 3.14000000000000012434\r\n"),
    ("D", [1, "ping", 3.14], "2 1.25", b"D 2 1.25\r\n1 ping 3.14000000000000012434\r\n"),
    (
        "d",
        [["a", [1, 2]], [1.5, "x y"], Vocab("set")],
        "",
        b'd\r\n(a (1 2)) (1.5 "x y") [set]\r\n',
    ),
    ("a", [Vocab("list"), Vocab("out"), "/cap/in"], "", b'a\r\n[list] [out] "/cap/in"\r\n'),
    ("D", ["two\nlines"], "", b'D\r\n"two\\nlines"\r\n'),
]


@pytest.mark.parametrize(("key", "value", "envelope", "data"), MESSAGES)
def test_golden_messages(key: str, value: object, envelope: str, data: bytes) -> None:
    carrier, stream = Text(Route("/a", "/b")), ByteStream()
    carrier.encode(stream, Packet(value, envelope.encode(), key))
    assert b"".join(stream.take_output()) == data
    for piece in (0, 1, 3):
        stream = ByteStream()
        message = run(carrier.decode(stream), stream, chop(data, piece))
        assert message.key == key
        assert message.envelope == envelope
        assert message.value == value
        assert message.spelling == "text"


TYPED = [
    # what somebody types after the greeting: key, text or payload, envelope
    (b"d\nhello there\n", ("d", ["hello", "there"], "")),  # bare LF
    (b"d\r\n1 2\r\n", ("d", [1, 2], "")),
    (b"do\r\n1\r\n", ("d", [1], "")),
    (b"d 7 1.5\r\n1\r\n", ("d", [1], "7 1.5")),
    (b"D 8 2.5\r\n1\r\n", ("D", [1], "8 2.5")),
    (b"dx10 4.5\r\n1\r\n", ("d", [1], "10 4.5")),
    (b"d\r\n(a b\r\nc) d\r\n", ("d", [["a", "b", "c"], "d"], "")),  # goes on until balanced
    (b'd\r\n"open\r\nquote" x\r\n', ("d", ["open\nquote", "x"], "")),
    (b"d\r\none \\\r\ntwo\r\n", ("d", ["one", "two"], "")),  # a backslash joins lines
    (b"q\r\n", ("q", None, "")),
    (b"quit\r\n", ("q", None, "")),
    (b"*\r\n", ("*", None, "")),
    (b"r\r\n", ("r", None, "")),
    (b"?\r\n", ("?", None, "")),
    (b"/cap/in\r\n", ("/", None, "")),
    (b"\r\n", ("", None, "")),
]


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize(("typed", "wanted"), TYPED)
def test_what_a_person_types(typed: bytes, wanted: tuple[str, object, str], piece: int) -> None:
    key, value, envelope = wanted
    carrier, stream = Text(Route("/a", "/b")), ByteStream()
    message = run(carrier.decode(stream), stream, chop(typed, piece))
    assert message.key == key
    assert message.envelope == envelope
    if value is not None:
        assert message.value == value


GREETINGS = [
    # carrier, first eight bytes, the rest, who that is, over what, what we answer
    (Text, b"CONNECT ", b"test\r\n", "test", "text", b"Welcome test\r\n"),
    (Text, b"CONNECT ", b"test\n", "test", "text", b"Welcome test\r\n"),
    (Text, b"CONNECT ", b"\r\n", "", "text", b"Welcome \r\n"),
    (Text, b"CONNECT ", b"/my port (recv x)\r\n", "/my", "text+port+recv.x", b"Welcome /my\r\n"),
    (TextAck, b"CONNACK ", b"admin\r\n", "admin", "text_ack", b"Welcome admin\r\n"),
    (TextAck, b"CONNACK ", b"\xff\xfe\r\n", "\ufffd\ufffd", "text_ack", None),
]


@pytest.mark.parametrize(("kind", "first", "rest", "source", "carrier", "answer"), GREETINGS)
def test_greetings(
    kind: type[Text], first: bytes, rest: bytes, source: str, carrier: str, answer: bytes | None
) -> None:
    assert kind.recognises(first) == 8
    for piece in (0, 1):
        spoken, end = kind(Route("", "/b", kind.name)), End()
        end.begin(spoken.welcome(end.stream, first))
        for part in chop(rest, piece):
            end.feed(part)
        assert (spoken.route.source, spoken.route.carrier) == (source, carrier)
        if answer is not None:
            assert end.take() == answer


@pytest.mark.parametrize("first", [b"connect ", b"CONNECT\n", b"CONNECTX", b"HELLO..."])
def test_greeting_is_exact(first: bytes) -> None:
    assert not Text.recognises(first)
    assert not TextAck.recognises(first)


def test_sender_of_text_does_not_wait_for_its_welcome() -> None:
    """As in C++; whoever then reads a reply must step over the welcome."""
    end = End()
    carrier = Text(Route("/a", "/b", "text"))
    end.begin(carrier.greet(end.stream))
    assert end.done
    assert end.take() == b"CONNECT /a\r\n"
    end.begin(carrier.expect_reply(end.stream))
    end.feed(b"Welcome /a\r\n")
    assert not end.done
    end.feed(b"[ok] echo\r\n")
    assert end.result.value == [Vocab("ok"), "echo"]
    end.begin(carrier.expect_reply(end.stream))
    end.feed(b"second\r\n")
    assert end.result.value == ["second"]


def test_sender_of_text_ack_waits() -> None:
    end = End()
    end.begin(TextAck(Route("/a", "/b", "text_ack")).greet(end.stream))
    assert not end.done
    end.feed(b"Welcome /a\r\n")
    assert end.done


def test_answer_that_is_no_welcome_is_refused() -> None:
    """A port with a key speaks first, and says something else."""
    end = End()
    end.begin(TextAck(Route("/a", "/b", "text_ack")).greet(end.stream))
    with pytest.raises(RemoteProtocolError, match=r"auth\.conf"):
        end.feed(b"\x01\x02\xff\n" * 10)


@pytest.mark.parametrize("kind", [Text, TextAck])
def test_reversed_connection_can_be_asked(kind: type[Text]) -> None:
    """The side that was dialled never greeted, so no welcome is to be stepped over."""
    end = End()
    carrier = kind(Route("", "/b", kind.name))
    end.begin(carrier.welcome(end.stream, kind.magic))
    end.feed(b"reader\r\n")
    end.begin(carrier.expect_reply(end.stream))
    end.feed(b"answer\r\n")
    assert end.result.value == ["answer"]


def test_reply_and_acknowledgement_are_lines() -> None:
    talk = Dialogue(TextAck)
    talk.greet()
    talk.traffic.clear()
    talk.send(["x"], key="d")
    talk.reply([Vocab("ok"), [1, 2], 3.5])
    assert said(talk.traffic, "acceptor") == b"[ok] (1 2) 3.5\r\n<ACK>\r\n"


def test_acknowledgement_of_an_unanswered_call_is_not_a_reply() -> None:
    talk = Dialogue(TextAck, piece=1)
    talk.greet()
    talk.send(["x"], key="d")
    assert talk.acknowledge(replied=True) is None
    talk.send(["y"], key="d")
    reply = talk.reply(["<ACK>"])  # quoted, so it differs
    assert reply is not None
    assert reply.value == ["<ACK>"]


def test_lines_are_not_quoted() -> None:
    carrier, stream = TextAck(Route("/a", "/b")), ByteStream()
    carrier.encode_reply(stream, Lines(["registration name /x", "*** end of message"]))
    carrier.encode_lines(stream, ["This is /x", "so"])
    assert b"".join(stream.take_output()) == (
        b"registration name /x\r\n*** end of message\r\nThis is /x\r\nso\r\n"
    )


def test_something_else_than_an_acknowledgement() -> None:
    carrier, stream = TextAck(Route("/a", "/b")), ByteStream()
    with pytest.raises(RemoteProtocolError, match="expected an acknowledgement"):
        run(carrier.expect_ack(stream), stream, [b"hello\r\n"])


# ---------------------------------------------------------------------------------- bad peers


def test_text_is_limited() -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match="more than 100 bytes"):
        run(read_text(stream, 100), stream, [b"(" + b"x" * 30 + b"\n"] * 10)
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match="more than 100 bytes"):
        run(read_text(stream, 100), stream, [b"x" * 101 + b"\n"])


def test_limit_of_the_port_counts() -> None:
    carrier, stream = Text(Route("/a", "/b")), ByteStream(limit=50)
    with pytest.raises(RemoteProtocolError):
        run(carrier.decode(stream), stream, [b"d\n", b"x" * 51, b"\n"])


def test_long_name_is_refused() -> None:
    carrier, stream = Text(Route("", "/b")), ByteStream()
    with pytest.raises(RemoteProtocolError):
        run(carrier.welcome(stream, b"CONNECT "), stream, [b"x" * 2000])


def test_open_brackets_over_many_lines_cost_no_more() -> None:
    def cost(lines: int) -> float:
        stream = ByteStream()
        data = b"(\n" * lines + b")" * lines + b"\n"
        started = time.process_time()
        text = run(read_text(stream, 1 << 24), stream, chop(data, 10_000))
        assert len(text) == len(data) - 1
        return time.process_time() - started

    small = max(min(cost(6_000) for _ in range(3)), 0.02)  # some clocks tick 64 times a second
    assert min(cost(60_000) for _ in range(2)) < 10 * 3 * small


@given(st.binary(max_size=200), st.integers(0, 5))
def test_any_bytes_are_messages_or_our_errors(data: bytes, piece: int) -> None:
    carrier = TextAck(Route("/a", "/b"))
    stream = ByteStream()
    feeds = iter(chop(data, piece))
    try:
        while True:
            steps = carrier.decode(stream)
            while True:
                try:
                    next(steps)
                except StopIteration as stop:
                    if stop.value.key in ("d", "D", "a"):
                        stop.value.as_(Bottle)
                    break
                part = next(feeds, None)
                stream.feed_eof() if part is None else stream.feed(part)
    except YarpError:
        pass  # ours, at the latest when the bytes end


@pytest.mark.parametrize("name", ["/a\x1b]0;title\x07", "/a (log in\x9b)", "/\u202egnp"])
def test_a_name_that_a_terminal_would_obey(name: str) -> None:
    for kind, first in ((Text, b"CONNECT "), (TextAck, b"CONNACK ")):
        carrier = kind(Route("", "/in"))
        stream = ByteStream()
        with pytest.raises(RemoteProtocolError, match="control characters"):
            run(carrier.welcome(stream, first), stream, [name.encode() + b"\r\n"])


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        ("plain é 日本 🙂 \u05d0\u200f", "plain é 日本 🙂 \u05d0\u200f"),
        ("\x1b]0;title\x07\x1b[2J", "\\x1b]0;title\\x07\\x1b[2J"),
        ("\x9b2J\x85\x7f\x01", "\\x9b2J\\x85\\x7f\x01"),
        ("a\tb", "a\tb"),
        ("caf\udce9 \udc9b2J", "caf\udce9 \\x9b2J"),
    ],
)
def test_what_a_stranger_stored_does_not_command_a_terminal(said: str, shown: str) -> None:
    carrier, stream = Text(Route("/a", "/b")), ByteStream()
    carrier.encode_lines(stream, [said])
    carrier.encode_reply(stream, Lines([said, said]))
    carrier.encode_reply(stream, [said])
    expected = [shown] * 3 + [f'"{shown}"']
    lines = b"".join(stream.take_output()).decode("utf-8", "surrogateescape")
    assert lines == "".join(f"{line}\r\n" for line in expected)
    carrier.encode(stream, Packet([said]))  # data are the program's
    sent = b"".join(stream.take_output()).decode("utf-8", "surrogateescape")
    assert sent == f'D\r\n"{said}"\r\n'
