"""What a PUB, a PUSH and a REQ were recorded to send, and what they are answered."""

from __future__ import annotations

import pytest
from support.zmq_end import accepted, read

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.peers.zmq import zmtp
from yarpy.wire.message import CALL, DATA


def test_what_a_pub_sends_has_a_topic_in_front() -> None:
    end, carrier = accepted(b"PUB")
    assert end.take().endswith(zmtp.command(b"SUBSCRIBE"))
    assert read(end, carrier, b"\1\3cam\0\3[1]").value == Bottle([1])
    assert read(end, carrier, b"\0\5alone").value == "alone"
    assert read(end, carrier, b"\1\3cam\1\x011\0\x012").value == Bottle([1, 2])
    end, carrier = accepted(b"PUB", minor=0)
    assert end.take().endswith(b"\0\1\1")


def test_yarps_own_spelling_comes_in() -> None:
    end, carrier = accepted(b"PUSH")
    body = b"".join(codec.encode([1, "two"]))
    data = b"".join(map(bytes, zmtp.encode([b"raw:", body])))
    message = read(end, carrier, data)
    assert (message.key, message.value) == (DATA, Bottle([1, "two"]))


@pytest.mark.parametrize(
    ("kind", "question", "answer"),
    [
        (b"REQ", b"\1\0\0\3[1]", b'\1\0\0\4"ok"'),
        (b"DEALER", b"\1\2id\1\0\0\3[1]", b'\1\2id\1\0\0\4"ok"'),
        (b"DEALER", b"\0\3[1]", b'\0\4"ok"'),
    ],
)
def test_questions_are_answered_on_the_way_that_they_came(
    kind: bytes, question: bytes, answer: bytes
) -> None:
    end, carrier = accepted(kind)
    for _ in range(2):
        end.take()
        message = read(end, carrier, question)
        assert (message.key, message.value) == (CALL, Bottle([1]))
        carrier.encode_reply(end.stream, "ok")
        assert end.take() == answer
