"""Upgrade: how a connection of HTTP becomes a WebSocket, on either side (RFC 6455, section 4).

Rules: what a page may do is asked elsewhere (`refusal`), before it is granted anything here.
"""

from __future__ import annotations

import os
from base64 import b64encode
from collections.abc import Mapping

from yarpy.carriers.web.http.header import read_headers
from yarpy.carriers.web.http.refusal import refuse
from yarpy.errors import RemoteProtocolError
from yarpy.limit import HTTP_LINE
from yarpy.route import Route
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


def ask_for_websocket(stream: ByteStream, route: Route, path: str, protocol: str) -> Steps[None]:
    """Ask the server that was dialled for a WebSocket with a subprotocol. Raises
    RemoteProtocolError if it offers none."""
    from wsproto.utilities import generate_accept_token

    key = b64encode(os.urandom(16))
    host = f"[{route.host}]" if ":" in route.host else route.host
    stream.write(
        f"GET {path} HTTP/1.1\r\nHost: {host}:{route.port}\r\nUpgrade: websocket\r\n"
        f"Connection: Upgrade\r\nSec-WebSocket-Key: {key.decode()}\r\n"
        f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: {protocol}\r\n\r\n".encode()
    )
    line = yield from stream.read_line(HTTP_LINE)
    headers = yield from read_headers(stream)
    accepted = generate_accept_token(key).decode()
    if line.split()[1:2] != [b"101"] or headers.get("sec-websocket-accept") != accepted:
        text = line[:80].decode("utf-8", "replace")
        raise RemoteProtocolError(f'the peer offers no WebSocket; it answered "{text}"')


def grant_websocket(stream: ByteStream, headers: Mapping[str, str], protocol: str) -> Steps[None]:
    """Answer a request for a WebSocket, with the subprotocol that was chosen ("": none). One that
    is no such request is refused. Raises RemoteProtocolError."""
    from wsproto.utilities import generate_accept_token

    key = headers.get("sec-websocket-key", "")
    known = headers.get("sec-websocket-version", "13") == "13"
    if not (key and known and "websocket" in headers.get("upgrade", "").lower()):
        more = [("Upgrade", "websocket"), ("Sec-WebSocket-Version", "13")]
        yield from refuse(stream, 426, "this address is for WebSockets", more)
    answer = (
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: WebSocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Accept: {generate_accept_token(key.encode('latin-1')).decode()}\r\n"
    )
    if protocol:
        answer += f"Sec-WebSocket-Protocol: {protocol}\r\n"
    stream.write(answer.encode("latin-1") + b"\r\n")


def offered_subprotocols(stream: ByteStream) -> list[str]:
    """Return the subprotocols that a request for a WebSocket offers, whose head waits in a stream,
    and stays there; nothing of any other request."""
    head = bytes(stream.view[stream.head : stream.tail]).partition(b"\n\r\n")[0]
    lines = head.decode("latin-1").splitlines()
    found = {name.strip().lower(): value for name, _, value in (x.partition(":") for x in lines)}
    if "websocket" not in found.get("upgrade", "").lower():
        return []
    return found.get("sec-websocket-protocol", "").replace(",", " ").split()
