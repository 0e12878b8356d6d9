"""websocket: the captures, JSON for page authors, control frames, the conformance suite."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.capture import load_capture
from support.guest import guest
from support.replay import Served, echo, serve
from support.steps import chop
from wsproto import ConnectionType, WSConnection
from wsproto.events import (
    AcceptConnection,
    BytesMessage,
    CloseConnection,
    Event,
    Ping,
    Pong,
    RejectConnection,
    Request,
    TextMessage,
)

from yarpy.carriers.web.websocket import WebSocket
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LinkClosed, RemoteProtocolError, YarpError
from yarpy.route import Route
from yarpy.testing import CarrierConformance, End
from yarpy.wire.message import Message, Packet

PIECES = [0, 1]


class TestWebSocket(CarrierConformance):
    carrier = WebSocket
    names_sender = False


# ------------------------------------------------------------------------------------ the captures

ANSWERED = ["websocket_admin", "websocket_split", "websocket_text_frame"]


def answer(message: Message) -> Any:
    return [Vocab("ver"), 1, 2, 3] if message.key == "a" else echo(message)


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("name", ANSWERED)
def test_pages_are_answered_as_by_cpp(name: str, piece: int) -> None:
    capture = load_capture(name)
    end, served = End(piece), Served()
    end.begin(serve(end, served, answer))
    for step in capture.steps:
        if step.sender == "a":
            end.feed(step.data)
            assert end.take() == capture.steps[step.index + 1].data
    assert served.carrier is not None
    assert served.carrier.route.source == "web"


@pytest.mark.parametrize("piece", PIECES)
def test_ping_and_close_are_answered_where_cpp_breaks(piece: int) -> None:
    """The ping and the close frame of the capture: C++ desynchronises on the first and spins on
    the second."""
    capture = load_capture("websocket_rpc")
    end, served = End(piece), Served()
    end.begin(serve(end, served, answer))
    for step in capture.steps[:6]:
        if step.sender == "a":
            end.feed(step.data)
            assert end.take() == capture.steps[step.index + 1].data
    end.feed(capture.steps[6].data)
    assert end.take() == b"\x8a\x00\x88\x00"
    assert end.done
    assert [m.key for m in served.messages] == ["d", "d", "q"]


@pytest.mark.parametrize("piece", PIECES)
def test_data_without_reply(piece: int) -> None:
    capture = load_capture("websocket_write")
    end, served = End(piece), Served()
    end.begin(serve(end, served, answer))
    end.feed(capture.steps[0].data)
    assert end.take() == capture.steps[1].data
    end.feed(capture.steps[2].data)
    assert [(m.key, m.value) for m in served.messages[:1]] == [("D", [5])]
    assert end.take() == b"\x88\x00"


def test_handshake_without_a_key_is_refused() -> None:
    """C++ accepts it, without the line that makes it a WebSocket."""
    end, served = End(), Served()
    end.begin(serve(end, served, answer))
    end.feed(load_capture("websocket_bad_handshake").steps[0].data)
    said = end.take()
    assert said.startswith(b"HTTP/1.1 426 Upgrade Required\r\n")
    assert b"Upgrade: websocket\r\n" in said
    head, _, body = said.partition(b"\r\n\r\n")
    assert b"Content-Length: %d" % len(body) in head
    with pytest.raises(RemoteProtocolError, match="426"):
        end.feed_eof()


def test_handshake_of_another_version_is_refused() -> None:
    end, served = End(), Served()
    end.begin(serve(end, served, answer))
    end.feed(
        b"GET /?ws HTTP/1.1\r\nHost: h\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        b"Sec-WebSocket-Version: 8\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
    said = end.take()
    assert said.startswith(b"HTTP/1.1 426 ")
    assert b"Sec-WebSocket-Version: 13\r\n" in said


def test_messages_go_out_block_by_block_as_from_cpp() -> None:
    """`82 08` and the port command, `82 1a` and a Bottle of 26 bytes."""
    page = Page()
    page.carrier.encode(page.end.stream, Packet([1, "abc"]))
    body = Bottle([1, "abc"]).to_bytes()
    command = bytes.fromhex("00 00 00 00 7e 44 00 01")
    assert page.end.take() == b"\x82\x08" + command + b"\x82" + bytes((len(body),)) + body
    page.carrier.encode(page.end.stream, Packet([b"x" * 70_000], b"36 1.5"))
    frames = page.end.take()
    command = bytes.fromhex("09 00 00 00 7e 00 00 01") + b"D 36 1.5\0"
    assert frames.startswith(b"\x82\x11" + command + b"\x82")
    assert frames.endswith(b"\x82\x7f" + (70_000).to_bytes(8, "big") + b"x" * 70_000)
    page.carrier.encode_reply(page.end.stream, ["x" * 200])
    assert page.end.take().startswith(b"\x82\x7e\x00\xd4")


# ---------------------------------------------------------------------------------------- as a page


class Page:
    """A page with wsproto as its browser, at a port's end of the connection."""

    def __init__(self, options: str = "", *protocols: str, piece: int = 0) -> None:
        self.ws = WSConnection(ConnectionType.CLIENT)
        self.end = End(piece)
        self.messages: list[Message] = []
        self.carrier = WebSocket(Route("", "/p", "websocket"))
        request = self.ws.send(
            Request(host="h:1", target=f"/?ws{options}", subprotocols=list(protocols))
        )
        assert request.startswith(b"GET /?ws")
        self.end.begin(self.carrier.welcome(self.end.stream, request[:8]))
        self.end.feed(request[8:])
        (self.opened,) = self.hear()
        if self.end.done:
            self.end.begin(self._read())

    def _read(self) -> Any:
        while True:
            message = yield from self.carrier.decode(self.end.stream)
            self.messages.append(message)
            if message.key in ("q", "r"):
                return

    def say(self, event: Event) -> None:
        self.end.feed(self.ws.send(event))

    def hear(self) -> list[Event]:
        data = self.end.take()
        if data:
            self.ws.receive_data(data)
        return list(self.ws.events())


def test_json_messages_and_replies() -> None:
    page = Page("", "other", "yarp.json")
    assert isinstance(page.opened, AcceptConnection)
    assert page.opened.subprotocol == "yarp.json"
    for text, value in (
        ('[1, "two", [3.5]]', [1, "two", [3.5]]),
        ('"hello"', "hello"),
        ("5", 5),
        ('{"a": 1}', [["a", 1]]),
        ("[]", []),
    ):
        page.say(TextMessage(text))
        message = page.messages.pop()
        assert message.key == "d"
        assert message.value == value
        page.carrier.encode_reply(page.end.stream, value)
        (reply,) = page.hear()
        assert isinstance(reply, TextMessage)
    page.carrier.encode_reply(page.end.stream, ["x", ["y", 2.5], True])
    (reply,) = page.hear()
    assert json.loads(reply.data) == ["x", ["y", 2.5], "true"]


@pytest.mark.parametrize("piece", PIECES)
def test_json_in_many_frames(piece: int) -> None:
    page = Page("", "yarp.json", piece=piece)
    for part, finished in (('["gr', False), ("\u00fc\u00df", False), ('e", 2]', True)):
        page.say(TextMessage(part, message_finished=finished))
    page.say(Ping(b"there?"))
    assert [m.value for m in page.messages] == [["gr\u00fc\u00dfe", 2]]
    assert page.hear() == [Pong(b"there?")]


def test_what_is_no_json_is_answered() -> None:
    page = Page("", "yarp.json")
    for text in ("no json", "[1", "", "[NaN]", '"\\', "[" * 5000):
        page.say(TextMessage(text))
        (reply,) = page.hear()
        assert json.loads(reply.data)[0] == "fail"
    page.say(TextMessage("[1]"))
    assert [m.value for m in page.messages] == [[1]]


def test_json_for_the_administration() -> None:
    page = Page("&admin", "yarp.json")
    page.say(TextMessage('["list", "out"]'))
    assert [(m.key, m.value) for m in page.messages] == [("a", ["list", "out"])]


def test_page_that_only_reads() -> None:
    page = Page("&read", "yarp.json")
    assert not page.carrier.push
    packet = Packet([1, 2.5, ["a"]], b"7 1.25")
    assert page.carrier.prepare(packet)
    page.carrier.encode(page.end.stream, packet)
    assert [json.loads(e.data) for e in page.hear()] == [[1, 2.5, ["a"]]]
    page = Page("&read&envelope", "yarp.json")
    page.carrier.encode(page.end.stream, packet)
    assert [json.loads(e.data) for e in page.hear()] == [
        {"envelope": "7 1.25", "data": [1, 2.5, ["a"]]}
    ]


def test_reader_is_listened_to() -> None:
    page = Page("&read", "yarp.json")
    page.end.begin(page.carrier.listen(page.end.stream))
    page.say(Ping(b"x"))
    assert page.hear() == [Pong(b"x")]
    page.say(TextMessage("ignored"))
    assert not page.end.done
    page.say(CloseConnection(code=1001))
    assert page.end.done
    assert [type(e) for e in page.hear()] == [CloseConnection]


def test_protocol_that_was_asked_for_is_confirmed() -> None:
    assert Page("", "yarp").opened == AcceptConnection(subprotocol="yarp")
    assert Page("").opened == AcceptConnection()


def test_binary_message_in_small_frames() -> None:
    """What C++ 3.9.1 corrupts: a value that straddles two frames."""
    page = Page()
    whole = bytes.fromhex("00 00 00 00 7e 64 00 01") + Bottle(["straddling", 2.5]).to_bytes()
    for part in chop(whole, 3):
        page.say(BytesMessage(part))
    assert [(m.key, m.value) for m in page.messages] == [("d", ["straddling", 2.5])]


def test_close_ends_in_good_order() -> None:
    page = Page()
    page.say(CloseConnection(code=1000, reason="bye"))
    assert [m.key for m in page.messages] == ["q"]
    (event,) = page.hear()
    assert isinstance(event, CloseConnection)
    assert event.code == 1000


@pytest.mark.parametrize(
    "frame",
    [
        b"\x82\x01x",
        b"\x83\x80\0\0\0\0",
        b"\xc2\x80\0\0\0\0",
        b"\x89\xfe\1\0\0\0\0\0",
        b"\x80\x81\0\0\0\0x",
        b"\x02\x81\0\0\0\0x" * 2,
    ],
)
def test_broken_frames(frame: bytes) -> None:
    """Not masked, an unknown kind, a reserved bit, a ping that is too long, the end of a message
    that nobody has begun, a message within another."""
    page = Page()
    with pytest.raises(RemoteProtocolError, match="frame"):
        page.end.feed(frame)
        page.end.feed_eof()


@pytest.mark.parametrize(
    ("setting", "origin", "options", "host", "admitted"),
    [
        ("http://good:1", "http://good:1", "", "", True),
        ("http://good:1", "http://bad", "", "", False),
        ("", "http://bad", "", "", False),
        ("", "http://bad", "&admin", "", False),
        ("", "http://bad", "&read", "", True),  # a computer of this network
        ("", "http://bad.test", "&read", "", False),
        ("http://bad.test", "http://bad.test", "&read", "", True),
        ("", "http://h:1", "", "", True),
        ("*", "http://bad", "", "", True),
        ("", "http://h.evil.test", "&read", "127.0.0.1", False),  # a name that points to us
        ("", "http://bad", "&read mqtt", "", False),
        ("", "http://h:1", " mqtt", "", True),
    ],
)
def test_other_origins(
    setting: str,
    origin: str,
    options: str,
    host: str,
    admitted: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("YARPY_WEB_ORIGINS", setting)
    end, carrier = End(), WebSocket(Route("", "/p", "websocket", 0, host))
    ws = WSConnection(ConnectionType.CLIENT)
    headers = [(b"Origin", origin.encode())]
    name = "h.evil.test" if host else "h:1"
    wished, _, inner = options.partition(" ")
    if inner:
        guest(inner)
    offered = [inner] if inner else []
    target = f"/?ws{wished}"
    said = Request(host=name, target=target, subprotocols=offered, extra_headers=headers)
    request = ws.send(said)
    end.begin(carrier.welcome(end.stream, request[:8]))
    end.feed(request[8:])
    ws.receive_data(end.take())
    events = [type(event) for event in ws.events()]
    assert events[0] is (AcceptConnection if admitted else RejectConnection)


@pytest.mark.parametrize(
    "said",
    [
        b"HTTP/1.1 200 OK\r\n\r\n",
        b"HTTP/1.1 101 Switching Protocols\r\nSec-WebSocket-Accept: x\r\n\r\n",
        b"\r\n\r\n",
    ],
)
def test_answers_that_are_no_websocket(said: bytes) -> None:
    end = End()
    end.begin(WebSocket(Route("/a", "/b", "websocket", 80, "::1")).greet(end.stream))
    assert b"\r\nHost: [::1]:80\r\n" in end.take()
    with pytest.raises(RemoteProtocolError, match="no WebSocket"):
        end.feed(said)


@settings(max_examples=150)
@given(st.binary(max_size=300), st.booleans(), st.sampled_from([0, 1, 7]))
def test_whatever_comes_only_our_errors(data: bytes, as_json: bool, piece: int) -> None:
    page = Page("", *(["yarp.json"] if as_json else []), piece=piece)
    try:
        page.end.feed(data)
        page.end.feed_eof()
    except YarpError:
        pass
    for message in page.messages:
        try:
            _ = message.value
        except YarpError:
            pass


def test_end_without_a_goodbye_is_noticed() -> None:
    page = Page()
    with pytest.raises(LinkClosed):
        page.end.feed_eof()
