"""Every kind of message over the carriers that are text, of the web, or without lengths."""

from __future__ import annotations

import http.client
import json
import sys
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

import pytest
from support import kinds
from support.kinds import NEXT, as_sent, every, read, walk

import yarpy
from yarpy.data import codec
from yarpy.data.xmlrpc import encode_call

HERE = pytest.mark.skipif(
    sys.platform == "win32", reason="Unix sockets: CPython has none on Windows"
)


JSON_ALONE = ("long integer",)  # has integers of any length


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


def as_text(name: str, came: Any, value: Any) -> bool:
    """The text is that of what was written, and so is that of what is read from it."""
    line = codec.encode_text(value)
    natural = codec.decode(b"".join(codec.encode(value)))
    kept = not isinstance(natural, (yarpy.Sound, yarpy.PointCloud)) or came.value == natural
    return kept and bytes(came.payload) == line


def readable(name: str, came: Any, value: Any) -> bool:
    """It is a message; XML-RPC has no floats of 32 bits and no words for much of it."""
    return isinstance(came.value, (list, str, float, int, yarpy.Vector))


CARRIERS: dict[str, Callable[[str, Any, Any], bool]] = {
    "tcp": as_sent,
    "websocket": as_sent,
    "unix_stream": as_sent,
    "text": as_text,
    "text_ack": as_text,
    "http": as_text,
    "xmlrpc": readable,
}


@pytest.mark.parametrize(
    "carrier", [pytest.param(name, marks=HERE if "unix" in name else ()) for name in CARRIERS]
)
def test_every_kind_arrives(carrier: str, names: yarpy.LocalNames) -> None:
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as reader,
    ):
        out.connect("/in", carrier)
        walk(out, read(reader), CARRIERS[carrier])


@pytest.mark.parametrize("carrier", ["tcp", "websocket", "text_ack", "unix_stream"])
def test_every_kind_is_an_answer(carrier: str, names: yarpy.LocalNames) -> None:
    """Replies have no length, whatever the carrier."""
    if carrier == "unix_stream" and sys.platform == "win32":
        pytest.skip("Unix sockets: CPython has none on Windows")
    answers = every()
    with (
        yarpy.RpcServer("/server", lambda message: answers[message.value], names=names)
        if carrier != "text_ack"
        else yarpy.RpcServer("/server", lambda message: answers[message.value[0]], names=names),
        yarpy.RpcClient("/server", carrier=carrier, names=names) as client,
    ):
        for name, value in answers.items():
            reply = client.ask(name, timeout=kinds.HANG)
            if carrier == "text_ack":
                assert bytes(reply.payload) == codec.encode_text(value), name
            else:
                assert as_sent(name, reply, value), name


# -- readers that know nothing of YARP -----------------------------------------------------------


@pytest.mark.parametrize("query", ["", "?format=json", "?sse", "?sse&pixels"])
def test_every_kind_is_a_part_of_a_response(query: str, names: yarpy.LocalNames) -> None:
    with ExitStack() as open_, yarpy.Port("/out", names=names) as out:
        connection = http.client.HTTPConnection(
            out.contact.host, out.contact.port, timeout=kinds.HANG
        )
        open_.callback(connection.close)
        connection.request("GET", f"/r{query}")
        response = connection.getresponse()
        open_.callback(response.close)  # it does not end, and holds the connection
        out.wait_for_outputs()

        def arrived() -> bytes:
            while True:
                line = response.readline()
                assert line, "the response has ended"
                if "sse" not in query:
                    return line
                if line.startswith(b"data: "):
                    return line.removeprefix(b"data: ")

        def same(name: str, came: bytes, value: Any) -> bool:
            if not query:
                return came == codec.encode_text(value) + b"\r\n"
            found = json.loads(came)
            natural = codec.decode(b"".join(codec.encode(value)))
            if isinstance(natural, yarpy.PointCloud):
                return tells(found, natural, "pixels" in query)
            return bool(came == yarpy.to_json(value, pixels="pixels" in query).encode() + b"\n")

        walk(out, arrived, same, () if not query else JSON_ALONE)


def tells(found: dict[str, Any], cloud: yarpy.PointCloud, points: bool) -> bool:
    """The JSON of a cloud says what it is, and where its points are if they are wanted."""
    wanted = {"type": "pointcloud", "kind": cloud.kind, "width": cloud.width}
    wanted |= {"height": cloud.height}
    if points:
        wanted["points"] = [list(point) for point in cloud.array.reshape(-1).tolist()]
    return found == wanted


@pytest.mark.parametrize("options", ["", "&pixels", "&envelope"])
def test_every_kind_is_a_message_for_a_page(options: str, names: yarpy.LocalNames) -> None:
    websocket = pytest.importorskip("websockets.sync.client", reason="pip install websockets")
    with (
        yarpy.Port("/out", names=names) as out,
        websocket.connect(
            f"ws://{out.contact.host}:{out.contact.port}/?ws&read{options}",
            subprotocols=["yarp.json"],
            max_size=None,
        ) as page,
    ):
        out.wait_for_outputs()

        def same(name: str, came: str, value: Any) -> bool:
            found = json.loads(came)
            if options == "&envelope":
                found = found["data"]
            return bool(found == json.loads(yarpy.to_json(value, pixels=options == "&pixels")))

        walk(out, lambda: page.recv(timeout=kinds.HANG), same, JSON_ALONE)


def test_xmlrpc_leaves_descriptions_out() -> None:
    for value in (yarpy.PointCloud([[1, 2, 3]]), 1 + 2j, yarpy.Sound([1])):
        assert b"yarpy.type" not in encode_call([NEXT, value])
