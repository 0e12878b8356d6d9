"""Messages one after another in an HTTP response that does not end.

    events        id: 7 1.25 LF data: [1, 2] LF LF      for JavaScript's EventSource
    json          [1, 2] LF
    text          1 2 CR LF
    reply_page    what the program put under `web`

Rules: each form of a message is made once for all its readers. A picture or a cloud of points is
sent as size and kind only, unless a JSON reader asks for pixels; to see a picture, use mjpeg.
"""

from __future__ import annotations

from typing import Final

from yarpy.carriers.web.http.intent import Form
from yarpy.carriers.web.http.message import TEXT
from yarpy.data.bottle import Bottle
from yarpy.wire.message import Packet

KINDS: Final[dict[str, str]] = {
    "text": TEXT,
    "json": "application/x-ndjson",
    "events": "text/event-stream",
}


def part(packet: Packet, form: Form, pixels: bool) -> bytes:
    """A message as it appears in such a response."""
    key = ("http", form, pixels)
    found = packet.forms.get(key)
    if found is None:
        found = packet.forms[key] = (_made(packet, form, pixels),)
    return bytes(found[0])


def _made(packet: Packet, form: Form, pixels: bool) -> bytes:
    if form in ("events", "json"):
        from yarpy.data.json import to_json

        text = to_json(packet.value, pixels=pixels).encode()
        if form == "json":
            return text + b"\n"
        # Nothing in it may end the line, and browsers ignore an id with a NUL.
        envelope = packet.envelope.translate(None, b"\r\n\0")
        mark = b"id: " + envelope + b"\n" if envelope else b""
        return mark + b"data: " + text + b"\n\n"
    if form == "reply_page":
        value = packet.value
        reply_page = web_of(value) if isinstance(value, (list, tuple)) else None
        if reply_page is not None:
            return reply_page
    return packet.line + b"\r\n"


def web_of(value: list[object] | tuple[object, ...]) -> bytes | None:
    """Return the bytes that a program put under the key `web`; None if there are none."""
    web = Bottle(value).group("web")
    if web is None or len(web) < 2:
        return None
    return web[1] if isinstance(web[1], bytes) else str(web[1]).encode("utf-8", "replace")
