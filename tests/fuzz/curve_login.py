"""CURVE of ZeroMQ as the side that was dialled: its greeting, and what is inside of its boxes.

Rules: keys, cookie and nonces are the same in every run, so that a greeting that was made once is
good for the next server, and changes of it come as far as they can.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from nacl import bindings as nacl

from yarpy.errors import YarpError
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.curve import Sealed
from yarpy.peers.zmq.curve_server import Server
from yarpy.testing import End

_PAIRS = [nacl.crypto_box_seed_keypair(bytes([number]) * 32) for number in range(4)]
(_PUBLIC, _SECRET), (_, _OWN), _BRIEF, _OWN_BRIEF = _PAIRS


def _server() -> Server:
    made = Server(_SECRET)
    made._cookie = bytes(96)
    made._brief_public, made._brief = _BRIEF
    return made


def _client() -> Sealed:
    made = Sealed(_PUBLIC, _OWN)
    made._brief_public, made._brief = _OWN_BRIEF
    return made


def _content(command: bytes) -> bytes:
    """What stands behind the name of a command."""
    body = command[2:] if command[0] == zmtp.COMMAND else command[9:]
    return zmtp.parse_command(body)[1]


def _met(properties: bytes) -> tuple[Sealed, Server, bytes]:
    """Both sides behind their greeting, and what the client has said in it."""
    client, server = _client(), _server()
    hello = client.hello()
    initiate = client.initiate(_content(server.welcome(_content(hello))), properties)
    return client, server, hello + initiate


def _split(data: bytes) -> tuple[bytes, bytes]:
    size = data[0] if data else 0
    return data[1 : 1 + size], data[1 + size :]


GREETINGS = tuple(
    _met(zmtp.properties_of(said))[2]
    for said in ({}, {"Socket-Type": b"SUB"}, {"Socket-Type": b"DEALER", "Identity": b"me"})
)
BOXES = tuple(
    bytes((len(said),)) + said + rest
    for said in (zmtp.properties_of({"Socket-Type": b"SUB"}), b"\1")
    for rest in (b"\0cam", b"\2\x09SUBSCRIBEcam", b"\2\4PING\0\1x", b"\1", b"")
)


def greet(data: bytes) -> None:
    """Whoever dials says this."""
    end = End(piece=1 + len(data) % 97, limit=1 << 22)

    def steps() -> Any:
        server = _server()
        yield from server.admit(end.stream)
        end.stream.write(server.ready_of({"Socket-Type": b"PUB"}))
        while True:
            server.open(*(yield from zmtp.read_frame(end.stream, 1 << 16)))

    end.begin(steps())
    end.feed(data)


def unbox(data: bytes) -> None:
    """Somebody with a good key has this in an INITIATE, and in a message."""
    properties, clear = _split(data)
    client, server, said = _met(properties)
    first = len(client.hello())
    with suppress(YarpError):
        zmtp.parse_properties(server.opened(_content(said[first:]))[1])
    client._number += 1
    with suppress(YarpError):
        server.open(0, clear)
    server.open(0, client._seal(clear[0] if clear else 0, clear[1:]))
