"""Responses of HTTP: forms of an answer, what a program's page may do, heads that can be sent."""

from __future__ import annotations

import pytest

from yarpy.carriers.web.http.intent import Form, Intent, Refusal
from yarpy.carriers.web.http.message import HTML, JSON, TEXT
from yarpy.carriers.web.http.origin import origins_of
from yarpy.carriers.web.http.page import Page
from yarpy.carriers.web.http.response import (
    LATE,
    PRELUDE,
    Responder,
    Response,
    bare,
    complaint,
    refused,
)
from yarpy.errors import LocalProtocolError
from yarpy.route import Route
from yarpy.wire.message import Lines

PORT = Responder(Route("", "/cap/srv", "http"), origins_of("*"))
LOCKED = Responder(Route("", "/cap/srv", "http"), origins_of("http://dash:8080"))


def intent(form: Form) -> Intent:
    return Intent("d", form)


def headers(response: Response) -> dict[str, str]:
    lines = response.head().decode().split("\r\n")[1:-2]
    return dict(line.split(": ", 1) for line in lines)


# ---------------------------------------------------------------------------------- forms

REPLIES: list[tuple[Form, object, int, str, bytes]] = [
    # form, reply, what is answered: status, type, body
    ("json", [1, "a"], 200, JSON, b'[1, "a"]\n'),
    ("json", 7, 200, JSON, b"7\n"),
    ("json", Lines(["one", "two"]), 200, JSON, b'["one", "two"]\n'),
    ("text", [1, "a"], 200, TEXT, b"1 a\r\n"),
    ("text", Lines(["one", "two"]), 200, TEXT, b"one\r\ntwo\r\n"),
    ("none", [1], 204, TEXT, b""),
]


@pytest.mark.parametrize(("form", "value", "status", "kind", "body"), REPLIES)
def test_replies(form: Form, value: object, status: int, kind: str, body: bytes) -> None:
    assert PORT.reply(intent(form), value, "x") == Response(status, kind, body)


def test_reply_on_a_page() -> None:
    response = PORT.reply(intent("page"), ["<b>"], "x:1")
    assert (response.status, response.kind, response.endless) == (200, HTML, False)
    assert response.body is not None
    assert b"<h1>/cap/srv</h1>" in response.body
    assert b"&lt;b&gt;" in response.body and b"<b>" not in response.body


def test_page_leads_where_the_browser_can_go() -> None:
    line = "registration name /a ip 127.0.0.1 port 10002 type tcp"
    body = PORT.said(intent("page"), Lines([line]), "robot:10000").body
    assert body is not None and b'href="http://robot:10002/"' in body


def test_nothing_said() -> None:
    assert PORT.nothing(intent("json"), "x") == Response(200, JSON, b"[]\n")
    assert PORT.nothing(intent("text"), "x") == Response(204)
    body = PORT.nothing(intent("page"), "x").body
    assert body is not None and b"(no reply)" in body


# ---------------------------------------------------------- pages that programs put into replies

REPLY_PAGE = [["web", "<b>hi</b>"], ["mime", "text/x"]]


def test_page_that_a_program_put_into_its_reply() -> None:
    for form in ("page", "text"):
        response = PORT.reply(intent(form), REPLY_PAGE, "x")
        assert (response.kind, response.body) == ("text/x", b"<b>hi</b>")
        assert headers(response)["Content-Security-Policy"].startswith("sandbox")
    assert PORT.reply(intent("page"), REPLY_PAGE[:1], "x").kind == HTML
    assert PORT.reply(intent("json"), REPLY_PAGE, "x").kind == JSON
    assert PORT.reply(intent("none"), REPLY_PAGE, "x").status == 204


def test_type_that_is_no_header_makes_it_a_reply_like_any_other() -> None:
    evil = [["web", "<b>"], ["mime", "a\r\nEvil: 1"]]
    assert PORT.reply(intent("text"), evil, "x").kind == TEXT


def test_page_that_goes_on() -> None:
    response = PORT.reply(intent("page"), [*REPLY_PAGE, ["stream", 1]], "x")
    assert response.endless
    assert response.body == b" " * PRELUDE + b"<b>hi</b>"
    assert "Content-Length" not in headers(response)


@pytest.mark.parametrize(
    ("form", "kind", "begins"),
    [
        ("events", "text/event-stream", b": reading\n\n"),
        ("json", "application/x-ndjson", b""),
        ("text", TEXT, b""),
    ],
)
def test_beginning_of_what_a_reader_gets(form: Form, kind: str, begins: bytes) -> None:
    response = PORT.reading(intent(form))
    assert (response.kind, response.endless) == (kind, True)
    assert response.body == begins


# ---------------------------------------------------------------------------------- who may act


def test_pages_are_not_for_others_to_frame_where_only_some_may_act() -> None:
    frame = "frame-ancestors 'self' http://dash:8080"
    for response in (LOCKED.said(intent("page"), [1], "x"), LOCKED.reader()):
        assert headers(response)["Content-Security-Policy"].endswith(frame)
    assert headers(LOCKED.shown(Page("hi"), {}))["Content-Security-Policy"] == frame
    assert "frame" not in headers(PORT.said(intent("page"), [1], "x"))["Content-Security-Policy"]
    assert "Content-Security-Policy" not in headers(PORT.shown(Page("hi"), {}))


def test_page_of_the_program() -> None:
    response = PORT.shown(Page(b"\x89PNG", "image/png", 203), {})
    assert (response.status, response.kind, response.body) == (203, "image/png", b"\x89PNG")


def test_who_reads_the_page_of_a_program() -> None:
    def said(setting: str, origin: str = "") -> dict[str, str]:
        responder = Responder(Route("", "/p", "http"), origins_of(setting))
        asked = {"origin": origin} if origin else {}
        return headers(responder.shown(Page("hi"), asked))

    allowed = "Access-Control-Allow-Origin"
    assert allowed not in said("")
    assert allowed not in said("", "http://evil")
    assert said("")["Cross-Origin-Resource-Policy"] == "same-origin"
    assert said("http://dash:1", "http://dash:1")[allowed] == "http://dash:1"
    assert said("dash", "http://dash:7")[allowed] == "http://dash:7"
    assert said("*", "http://evil")[allowed] == "*"


def test_preflight() -> None:
    origin = {"origin": "http://elsewhere", "host": "x"}
    methods = "Access-Control-Allow-Methods"
    assert headers(PORT.preflight(origin))[methods] == "GET, HEAD, POST"
    assert headers(LOCKED.preflight(origin))[methods] == "GET, HEAD"
    assert headers(LOCKED.preflight({"origin": "http://dash:8080"}))[methods].endswith("POST")


# ---------------------------------------------------------------------------------- heads


def test_heads() -> None:
    common = (
        b"Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
        b"Referrer-Policy: same-origin\r\nAccess-Control-Allow-Origin: *\r\n"
    )
    assert Response(204).head() == b"HTTP/1.1 204 No Content\r\n" + common + b"\r\n"
    assert LATE.head(("Connection", "close")) == (
        b"HTTP/1.1 408 Request Timeout\r\n" + common + b"Content-Type: text/plain; charset=utf-8"
        b"\r\nContent-Length: 37\r\nConnection: close\r\n\r\n"
    )
    assert bare(intent("json")).head().endswith(b"Content-Type: application/json\r\n\r\n")


def test_header_that_cannot_be_sent() -> None:
    with pytest.raises(LocalProtocolError):
        Response(200, "a\r\nEvil: 1").head()


def test_refusals() -> None:
    assert refused(Refusal(404, "no")) == complaint(404, "no") == Response(404, TEXT, b"no\n")
    assert refused(Refusal(204)) == Response(204, TEXT, b"")
    assert refused(Refusal(200, "a", "text/css")).kind == "text/css"
    assert complaint(400, "\udcff").body == b"?\n"
