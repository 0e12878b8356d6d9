"""zenoh: what a port writes and reads there, without any medium."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import yarpy
from yarpy.data import codec
from yarpy.errors import LocalProtocolError
from yarpy.link.begin.handshake import find_carrier
from yarpy.peers.zenoh.carrier import (
    DELETE,
    GONE,
    HERE,
    Asker,
    Incoming,
    Outgoing,
    Server,
    Subscriber,
    Zenoh,
    encoding_of,
)
from yarpy.route import Route, parse_carrier
from yarpy.testing import End
from yarpy.wire.message import CALL, DATA, Encoded, Packet
from yarpy.wire.stream import ObjectStream


def opened(spec: str) -> tuple[Any, End]:
    """A carrier that was greeted, and its side of the medium."""
    carrier = find_carrier(parse_carrier(spec))(Route("/port", "/zenoh://robot/arm", spec))
    end = End()
    end.stream = ObjectStream()
    end.stream.feed_object("the endpoint")
    end.begin(carrier.greet(end.stream))
    assert end.done
    return carrier, end


def said(end: End) -> list[Outgoing]:
    found: list[Any] = [*end.outbox, *end.stream.take_output()]
    end.outbox.clear()
    return found


def test_what_a_carrier_string_makes() -> None:
    kinds = {
        "zenoh": Zenoh, "zenoh+sub": Subscriber, "zenoh+srv": Asker, "zenoh+sub+srv": Server
    }  # fmt: skip
    for spec, kind in kinds.items():
        assert find_carrier(parse_carrier(spec)) is kind


@pytest.mark.parametrize(
    ("value", "payload", "encoding"),
    [
        ([1, 2.5, "hi"], b'[1, 2.5, "hi"]', "application/json"),
        ({"a": 1}, b'{"a": 1}', "application/json"),
        (b"raw", b"raw", "zenoh/bytes"),
        ([b"raw"], b"raw", "zenoh/bytes"),
        (Encoded(b"".join(codec.encode([b"raw"]))), b"raw", "zenoh/bytes"),
    ],
)
def test_what_is_put(value: object, payload: bytes, encoding: str) -> None:
    carrier, end = opened("zenoh")
    packet = Packet(value)
    assert carrier.prepare(packet)
    carrier.encode(end.stream, packet)
    assert said(end) == [Outgoing(payload, encoding)] and carrier.encode_quit(end.stream) is None


def test_a_picture_is_a_jpeg_file() -> None:
    carrier, end = opened("zenoh")
    carrier.encode(end.stream, Packet(np.zeros((4, 6, 3), np.uint8)))
    (item,) = said(end)
    assert item.encoding == "image/jpeg" and bytes(item.payload[:2]) == b"\xff\xd8"
    assert item.size == len(item.payload)


def test_what_cannot_be_sent_is_the_writers_error() -> None:
    carrier, _ = opened("zenoh")
    with pytest.raises(TypeError):
        carrier.prepare(Packet([object()]))


def test_raw_is_yarps_own_spelling() -> None:
    carrier, end = opened("zenoh+raw")
    packet = Packet([1, "x"])
    assert carrier.prepare(packet)
    carrier.encode(end.stream, packet)
    data = b"".join(codec.encode([1, "x"]))
    assert said(end) == [Outgoing(data)]
    carrier, end = opened("zenoh+sub+raw")
    end.begin(carrier.decode(end.stream))
    end.feed(Incoming(data))
    assert end.result.value == yarpy.Bottle([1, "x"])


def test_what_comes() -> None:
    carrier, end = opened("zenoh+sub")
    assert not carrier.push
    for payload, value in ((b"[1]", [1]), (b"free", "free"), (b"\xff", b"\xff"), (b"", "")):
        end.begin(carrier.decode(end.stream))
        end.feed(Incoming(payload))
        assert (end.result.key, end.result.value) == (DATA, value)


@pytest.mark.parametrize(
    ("encoding", "payload", "value"),
    [
        ("zenoh/bytes", b"42", 42),
        ("application/json", b"42", 42),
        ("text/plain", b"42", "42"),
        ("text/plain;charset=utf-8", b"[1]", "[1]"),
        ("text/plain", b"\xff", b"\xff"),
        ("zenoh/string", b"", ""),
        ("application/octet-stream", b"42", b"42"),
    ],
)
def test_what_comes_as_text_or_bytes_is_that(encoding: str, payload: bytes, value: object) -> None:
    carrier, end = opened("zenoh+sub")
    end.begin(carrier.decode(end.stream))
    end.feed(Incoming(payload, encoding=encoding, attachment=b"7 1.5"))
    assert (end.result.value, end.result.envelope) == (value, "7 1.5")
    assert type(end.result.value) is type(value)


@pytest.mark.parametrize("spec", ["zenoh+sub+srv", "zenoh+sub+srv+raw"])
def test_a_question_without_a_payload_asks_with_its_parameters(spec: str) -> None:
    carrier, end = opened(spec)
    end.begin(carrier.decode(end.stream))
    asked = [("x", "1"), ("name", "left arm"), ("quick", "")]
    end.feed(Incoming(b"", place="robot/arm?x=1;...", parameters=asked))
    assert end.result.value == [["x", 1], ["name", "left arm"], ["quick", ""]]
    assert end.result.as_(dict) == {"x": 1, "name": "left arm", "quick": ""}
    assert end.result.source == "/zenoh://robot/arm?x=1;..."
    end.begin(carrier.decode(end.stream))
    end.feed(Incoming(b"", parameters=[]))
    assert end.result.value == []


def test_asking() -> None:
    carrier, end = opened("zenoh+srv")
    carrier.encode(end.stream, Packet(["get", 1]))
    assert said(end) == [Outgoing(b'["get", 1]', "application/json")]
    for came, value in (
        (Incoming(b'["ok"]'), ["ok"]),
        (Incoming(b"", failure="nobody"), [yarpy.Vocab("fail"), "nobody"]),
    ):
        end.begin(carrier.expect_reply(end.stream))
        end.feed(came)
        assert end.result.value == value


@pytest.mark.parametrize(
    ("spec", "payload"), [("zenoh+sub+srv", b"[2]"), ("zenoh+sub+srv+raw", None)]
)
def test_answering(spec: str, payload: bytes | None) -> None:
    carrier, end = opened(spec)
    end.begin(carrier.decode(end.stream))
    data = b"".join(codec.encode([1]))
    end.feed(Incoming(data if payload is None else b"[1]", "the question"))
    assert (end.result.key, end.result.value) == (CALL, [1])
    carrier.encode_reply(end.stream, [2])
    (item,) = said(end)
    assert item.to == "the question"
    assert item.payload == (b"".join(codec.encode([2])) if payload is None else payload)


def test_encodings() -> None:
    assert encoding_of(b"[1, 2]", [1, 2]) == "application/json"
    assert encoding_of(b"\xff\xd8\xff\xe0", None) == "image/jpeg"


def test_an_envelope_goes_and_comes() -> None:
    carrier, end = opened("zenoh")
    carrier.encode(end.stream, Packet([1], b"7 1.5"))
    assert said(end) == [Outgoing(b"[1]", "application/json", attachment=b"7 1.5")]
    carrier, end = opened("zenoh+sub")
    for attachment, envelope in (
        (b"7 1.5", "7 1.5"),
        (b"", ""),
        (b"\xff", "\ufffd"),
        (b"7 1.5\r\nd 8 2.5", "7 1.5"),
    ):
        end.begin(carrier.decode(end.stream))
        end.feed(Incoming(b"[1]", attachment=attachment))
        assert (end.result.value, end.result.envelope) == ([1], envelope)


@pytest.mark.parametrize("event", [DELETE, HERE, GONE])
def test_what_happens_at_a_key_is_told_by_a_vocab(event: str) -> None:
    carrier, end = opened("zenoh+sub+delete")
    end.begin(carrier.decode(end.stream))
    end.feed(Incoming(b"", place="robot/arm", event=event))
    assert (end.result.value, end.result.source) == ([yarpy.Vocab(event)], "/zenoh://robot/arm")


@pytest.mark.parametrize("spec", ["zenoh+delete", "zenoh+delete+raw"])
def test_the_vocab_is_a_delete_where_it_is_asked_for(spec: str) -> None:
    carrier, end = opened(spec)
    for value in (yarpy.Vocab("delete"), [yarpy.Vocab("delete")], yarpy.Bottle(["delete"]), [1]):
        carrier.encode(end.stream, Packet(value))
    assert [item.deletes for item in said(end)] == [True, True, False, False]
    carrier, end = opened("zenoh")
    carrier.encode(end.stream, Packet([yarpy.Vocab("delete")]))
    assert said(end) == [Outgoing(b'["dele"]', "application/json")]


@pytest.mark.parametrize(
    ("spec", "why"),
    [
        ("zenoh+priority.FAST", "Zenoh has REAL_TIME"),
        ("zenoh+sub+priority.DATA", "for ports that put"),
        ("zenoh+srv+block", "for ports that put"),
        ("zenoh+sub+express", "for ports that put"),
        ("zenoh+sub+srv+delete", "for messages"),
        ("zenoh+srv+timestamp", "for messages"),
        ("zenoh+srv+liveliness", "not for ports that ask"),
    ],
)
def test_additions_that_do_not_fit(spec: str, why: str) -> None:
    with pytest.raises(LocalProtocolError, match=why):
        find_carrier(parse_carrier(spec))
