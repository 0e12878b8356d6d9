"""Every call of the ROS group of captures (rosmaster, rospy, rosnode, rostopic, C++ YARP), replayed
in both roles: asked, we understand what they ask and can answer as they do; asking, we ask the same
and understand their answers."""

from __future__ import annotations

import gzip
from typing import Any, NamedTuple
from xmlrpc.client import loads

import pytest
from support.capture import Capture, groups, load_capture
from support.replay import Served, serve

from yarpy.carriers.web.xmlrpc import XmlRpc
from yarpy.data import xmlrpc
from yarpy.data.bottle import Bottle
from yarpy.route import Route
from yarpy.testing import End

CALLS = [name for name in groups()["ros"] if "_xmlrpc_" in name]
#: what nodes are asked; the others are questions to the master, and data for a port
ASKED = {"getBusInfo", "getPid", "publisherUpdate", "requestTopic"}


class Exchange(NamedTuple):
    """A call and its answer, as bytes of HTTP."""

    asked: bytes
    answered: bytes


def exchanges(capture: Capture) -> list[Exchange]:
    """The calls of a dialogue; a side may have sent its bytes in pieces."""
    found: list[Exchange] = []
    asked = answered = b""
    for step in capture.steps:
        if step.sender == "a":
            if answered:
                found.append(Exchange(asked, answered))
                asked = answered = b""
            asked += step.data
        else:
            answered += step.data
    return [*found, Exchange(asked, answered)] if asked and answered else found


def body_of(data: bytes) -> bytes:
    """What a request or an answer carries."""
    head, _, body = data.partition(b"\r\n\r\n")
    return gzip.decompress(body) if b"Content-Encoding: gzip" in head else body


def call_of(data: bytes) -> tuple[str, list[Any]]:
    """The name of a method, and its arguments, as the standard library reads them."""
    arguments, method = loads(body_of(data))
    assert method is not None
    return method, [*arguments]


def test_there_are_calls() -> None:
    assert len(CALLS) == 46
    assert sum(len(exchanges(load_capture(name))) for name in CALLS) > 80


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize("name", CALLS)
def test_asked(name: str, piece: int) -> None:
    """Their requests are read, and an answer with the same value is written."""
    for exchange in exchanges(load_capture(name)):
        method, arguments = call_of(exchange.asked)
        (value,), _ = loads(body_of(exchange.answered))
        end, served = End(piece), Served()
        end.begin(serve(end, served, lambda message, value=value: xmlrpc.Plain(value)))
        end.feed(exchange.asked)
        message = served.messages[0]
        assert isinstance(served.carrier, XmlRpc)
        assert message.key == ("a" if method in ASKED else "d")
        words = message.as_(Bottle)
        assert [words[0], *map(_plain, words[1:])] == [method, *map(_plain, arguments)]
        head, _, body = end.take().partition(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 200 OK\r\n")
        assert loads(body)[0] == (value,)


def _plain(value: Any) -> Any:
    """Lists, whatever kind of list they are; a struct is one in a Bottle."""
    if isinstance(value, dict):
        return ["dict", *([key, _plain(each)] for key, each in value.items())]
    return [*map(_plain, value)] if isinstance(value, (list, tuple)) else value


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize("name", CALLS)
def test_asking(name: str, piece: int) -> None:
    """Our request says the same as theirs, and their answer is read."""
    for exchange in exchanges(load_capture(name)):
        method, arguments = call_of(exchange.asked)
        end, carrier = End(piece), XmlRpc(Route("", "/cap", "xmlrpc"))
        carrier.post(end.stream, xmlrpc.encode_plain_call(method, arguments))
        assert call_of(end.take()) == (method, arguments)
        end.begin(carrier.read_response(end.stream))
        head, _, _ = exchange.answered.partition(b"\r\n\r\n")
        answered = exchange.answered
        if b"gzip" in head:  # we do not say that we take it, so we are not sent it
            body = body_of(answered)
            answered = b"HTTP/1.1 200 OK\r\nContent-length: %d\r\n\r\n" % len(body) + body
        end.feed(answered)
        assert end.done
        (value,), _ = loads(body_of(exchange.answered))
        assert xmlrpc.decode_plain_answer(end.result) == value
