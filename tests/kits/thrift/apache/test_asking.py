"""Calls leave over both ways in the same form, and nothing else does."""

import pytest
from support.steps import output
from support.thrift_module import SPELLINGS, apache, data

from yarpy.errors import RemoteProtocolError
from yarpy.kits.thrift.apache.asking import Asking
from yarpy.kits.thrift.apache.carrier import Thrift
from yarpy.kits.thrift.apache.client import question
from yarpy.kits.thrift.apache.message import Asked
from yarpy.kits.thrift.apache.post import Post
from yarpy.route import Route
from yarpy.wire.message import Packet
from yarpy.wire.stream import ByteStream

WAYS = ((Thrift, "thrift"), (Post, "thrift+http"))


@pytest.mark.parametrize(("kind", "way"), WAYS)
def test_only_calls_leave(kind: type[Asking], way: str) -> None:
    carrier, stream = kind(Route("/a", "/b", way, 0)), ByteStream()
    assert not carrier.prepare(Packet([1]))
    for value in ([1], Asked("compact", 1, "add", b"\0")):
        with pytest.raises(TypeError, match="only the clients of a service speak"):
            carrier.encode(stream, Packet(value))
    assert output(stream) == b""


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize(("kind", "way"), WAYS)
def test_calls_are_numbered(kind: type[Asking], way: str, spelling: str) -> None:
    added = "+compact" if spelling == "compact" else ""
    carrier, stream = kind(Route("/a", "/b", way + added, 0)), ByteStream()
    asked = question(spelling, apache().Test._methods["add"], (1, -2))
    carrier.encode(stream, Packet(asked))
    assert output(stream).endswith(data("add", spelling))
    assert carrier._returned(data("added", spelling)).head.number == 1
    carrier.encode(stream, Packet(asked))
    with pytest.raises(RemoteProtocolError, match="the call 1, where 2 was asked last"):
        carrier._returned(data("added", spelling))
