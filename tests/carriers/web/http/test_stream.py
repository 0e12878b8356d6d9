"""Messages of an endless response: their forms, and that nothing in them ends a line."""

from __future__ import annotations

import numpy as np
import pytest

import yarpy
from yarpy.carriers.web.http.intent import Form
from yarpy.carriers.web.http.stream import part, web_of
from yarpy.wire.message import Packet

FORMS: list[tuple[Form, object, bytes, bytes]] = [
    # form, message, envelope, what is sent
    ("events", ["a", 1], b"7 1.25", b'id: 7 1.25\ndata: ["a", 1]\n\n'),
    ("events", ["a\nb"], b"", b'data: ["a\\nb"]\n\n'),
    ("events", [1], b"7\ndata: evil\r\0", b"id: 7data: evil\ndata: [1]\n\n"),
    ("json", ["a", 1], b"7 1.25", b'["a", 1]\n'),
    ("text", ["a", 1], b"7 1.25", b"a 1\r\n"),
    ("reply_page", [["web", "<b>"]], b"", b"<b>"),
    ("reply_page", [["web", b"\xff"]], b"", b"\xff"),
    ("reply_page", [["web"]], b"", b"(web)\r\n"),
    ("reply_page", [1], b"", b"1\r\n"),
]


@pytest.mark.parametrize(("form", "value", "envelope", "said"), FORMS)
def test_forms(form: Form, value: object, envelope: bytes, said: bytes) -> None:
    assert part(Packet(value, envelope), form, False) == said


class Foreign:
    """A message whose bytes are no Bottle."""

    def to_wire(self) -> tuple[bytes, ...]:
        return (b"\xff\xff\xff",)


def test_what_has_no_text_is_an_empty_line_or_a_blob() -> None:
    assert part(Packet(Foreign()), "text", False) == b"\r\n"
    assert b'data: {"type": "blob", "base64": "////"}' in part(Packet(Foreign()), "events", False)


def test_a_message_is_spelled_once_for_all_readers() -> None:
    packet = Packet([1])
    first = part(packet, "events", False)
    packet.value = [2]
    assert part(packet, "events", False) == first
    assert part(packet, "json", False) == b"[2]\n"


def test_pictures() -> None:
    packet = Packet(yarpy.Image(np.zeros((48, 64, 3), "u1")))
    facts = b'{"type": "image", "width": 64, "height": 48, "pixel": "rgb"}'
    assert part(packet, "json", False) == facts + b"\n"
    assert len(part(packet, "json", True)) > 48 * 64 * 4


def test_what_a_program_put_under_web() -> None:
    assert web_of([["a", 1], ["web", 5]]) == b"5"
    assert web_of(["web", 5]) is None
