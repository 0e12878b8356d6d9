"""upgrade: both sides of the request, as wsproto reads and writes them."""

from __future__ import annotations

from typing import Any

import pytest
from wsproto import ConnectionType, WSConnection
from wsproto.events import AcceptConnection, Request

from yarpy.carriers.web.upgrade import ask_for_websocket, grant_websocket, offered_subprotocols
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.testing import End
from yarpy.wire.stream import ByteStream


def asked(end: End, host: str = "127.0.0.1") -> None:
    route = Route("/a", "/b", "mqtt", 9001, host)
    end.begin(ask_for_websocket(end.stream, route, "/mqtt", "mqtt"))


def test_wsproto_grants_what_is_asked_for() -> None:
    end, peer = End(), WSConnection(ConnectionType.SERVER)
    asked(end, "::1")
    peer.receive_data(end.take())
    event = next(peer.events())
    assert isinstance(event, Request)
    assert (event.host, event.target, event.subprotocols) == ("[::1]:9001", "/mqtt", ["mqtt"])
    end.feed(peer.send(AcceptConnection(subprotocol="mqtt")))
    assert end.done


@pytest.mark.parametrize("answer", [b"HTTP/1.1 404 Not Found\r\n\r\n", b"HTTP/1.1 101 x\r\n\r\n"])
def test_who_offers_no_websocket_is_told_of(answer: bytes) -> None:
    end = End()
    asked(end)
    with pytest.raises(RemoteProtocolError, match="offers no WebSocket"):
        end.feed(answer)


def test_wsproto_is_granted_what_it_asks_for() -> None:
    end, peer = End(), WSConnection(ConnectionType.CLIENT)
    stream = ByteStream()
    stream.feed(peer.send(Request("h:1", "/mqtt", subprotocols=["a", "mqtt"])))
    assert offered_subprotocols(stream) == ["a", "mqtt"]
    head = bytes(stream.view[: stream.tail]).decode()
    lines = (line.partition(": ") for line in head.splitlines()[1:])
    headers = {name.lower(): value for name, _, value in lines}
    end.begin(grant_websocket(end.stream, headers, "mqtt"))
    assert end.done
    peer.receive_data(end.take())
    event: Any = next(peer.events())
    assert isinstance(event, AcceptConnection)
    assert event.subprotocol == "mqtt"


@pytest.mark.parametrize("missed", ["upgrade", "sec-websocket-key"])
def test_other_requests_are_refused(missed: str) -> None:
    headers = {"upgrade": "websocket", "sec-websocket-key": "x", "sec-websocket-version": "13"}
    del headers[missed]
    end = End()
    end.begin(grant_websocket(end.stream, headers, ""))
    with pytest.raises(RemoteProtocolError, match="426"):
        end.feed_eof()
    assert end.take().startswith(b"HTTP/1.1 426 ")


@pytest.mark.parametrize(
    ("head", "offered"),
    [
        (b"GET / HTTP/1.1\r\nSec-WebSocket-Protocol: mqtt\r\n\r\n", []),
        (b"GET / HTTP/1.1\nupgrade: WebSocket\nSec-Websocket-Protocol: a,mqtt\n\n", ["a", "mqtt"]),
        (b"GET / HTTP/1.1\r\nUpgrade: websocket\r\n\r\n", []),
        (b"POST / HTTP/1.1\r\n\r\nUpgrade: websocket\r\nSec-WebSocket-Protocol: mqtt", []),
    ],
)
def test_what_is_offered_stays_unread(head: bytes, offered: list[str]) -> None:
    stream = ByteStream()
    stream.feed(head)
    assert offered_subprotocols(stream) == offered
    assert stream.waiting == len(head)
