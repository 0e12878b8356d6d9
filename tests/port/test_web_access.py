"""What browsers and other programs that speak HTTP may do with a port, by address and by token."""

from __future__ import annotations

import json
import logging
import xmlrpc.client
from collections.abc import Iterator
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path

import pytest
from support.access import write
from support.wait import HANG
from wsproto.utilities import generate_nonce

import yarpy
from yarpy.testing.fixture import names  # noqa: F401

FAR = "127.0.0.2"
SECRET, LOOKER = "4Zr2kXqyJtWm0v8N", "k9Qw-2mZtY7_bLx4"
RULES = f"""
[[allow]]
who = "127.0.0.1"
may = "all"

[[allow]]
who = "token:panel"
may = ["read", "write"]

[[allow]]
who = "token:looker"
may = "read"

[tokens]
panel = "{SECRET}"
looker = "{LOOKER}"
"""
HTML = {"Accept": "text/html"}


@pytest.fixture
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[yarpy.RpcServer]:
    write(tmp_path, monkeypatch, RULES)
    with yarpy.RpcServer("/arm", lambda m: ["moved", *m.value], names=yarpy.LocalNames()) as server:
        yield server


def asked(
    port: yarpy.RpcServer | yarpy.Port | yarpy.BufferedPort,
    target: str,
    headers: dict[str, str] | None = None,
    method: str = "GET",
    body: str | None = None,
    far: str = FAR,
) -> tuple[HTTPResponse, str]:
    """The answer to a browser of another computer."""
    where = port.contact.host, port.contact.port
    connection = HTTPConnection(*where, timeout=HANG, source_address=(far, 0))
    connection.request(method, target, body, headers or {})
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    return answer, text


def bearer(token: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {token}"}


@pytest.mark.parametrize(
    "target",
    ["/", "/?", "/r", "/?req=up", "/up/down", "/?cmd=/b", "/?action=stream", "/?action=snapshot",
     "/?admin=1&req=[list]+[in]", "/?admin=1&req=[add]+/b", "/*"],
)  # fmt: skip
def test_without_a_token_nothing_is_told(arm: yarpy.RpcServer, target: str) -> None:
    answer, text = asked(arm, target)
    assert answer.status == 403
    assert text.startswith("Access refused: this computer may not ")


def test_the_files_of_pages_are_no_secret(arm: yarpy.RpcServer) -> None:
    assert asked(arm, "/*/style.css")[0].status == 200


def test_tokens_have_their_rights(arm: yarpy.RpcServer) -> None:
    assert asked(arm, "/?req=up", bearer(SECRET))[1] == '["moved", "up"]\n'
    assert asked(arm, f"/?req=up&token={SECRET}")[1] == '["moved", "up"]\n'
    refused, text = asked(arm, "/?req=up", bearer(LOOKER))
    assert refused.status == 403
    assert "this computer (token:looker) may not write to /arm, only read" in text
    assert asked(arm, "/?cmd=/b", bearer(SECRET))[0].status == 403
    assert asked(arm, "/?admin=1&req=[add]+/b", bearer(SECRET))[0].status == 403
    assert asked(arm, "/?admin=1&req=[ver]", bearer(LOOKER))[0].status == 200
    # An RpcServer sends nothing by itself: nobody can read there.
    assert json.loads(asked(arm, "/*/may", bearer(LOOKER))[1]) == []
    assert json.loads(asked(arm, "/*/may", far="127.0.0.1")[1])[:2] == ["write", "administer"]
    with yarpy.BufferedPort("/camera", names=yarpy.LocalNames()) as camera:
        assert json.loads(asked(camera, "/*/may", bearer(LOOKER))[1]) == ["read"]
        assert json.loads(asked(camera, "/*/may")[1]) == []
        assert json.loads(asked(camera, "/*/may", far="127.0.0.1")[1])[:2] == ["read", "write"]


def test_an_unknown_token_is_told(arm: yarpy.RpcServer) -> None:
    for answer, text in (asked(arm, "/?token=x", HTML), asked(arm, "/", bearer("x"))):
        assert (answer.status, text) == (403, "Access refused: this web token is not known here\n")


def test_a_browser_keeps_the_token_as_a_cookie(arm: yarpy.RpcServer) -> None:
    answer, _ = asked(arm, f"/?token={LOOKER}&x=1", HTML)
    assert (answer.status, answer.headers["Location"]) == (303, "/?x=1")
    cookie = answer.headers["Set-Cookie"]
    assert "HttpOnly" in cookie
    again, text = asked(arm, "/", {**HTML, "Cookie": cookie.partition(";")[0]})
    assert again.status == 200
    assert again.headers["Referrer-Policy"] == "same-origin"
    assert "Read only" in text
    assert "<form" not in text
    assert LOOKER not in text
    writer = {**HTML, **bearer(SECRET)}
    assert '<form id="ask"' in asked(arm, "/", writer)[1]


@pytest.mark.parametrize("target", ["//evil.test/", "/\\evil.test"])
def test_nobody_is_sent_elsewhere(arm: yarpy.RpcServer, target: str) -> None:
    answer, _ = asked(arm, f"{target}?token={LOOKER}", HTML)
    assert (answer.status, answer.headers["Location"]) == (303, "/")


def test_each_request_of_a_connection_shows_its_own_token(arm: yarpy.RpcServer) -> None:
    """A proxy may have requests of several people on one connection."""
    connection = HTTPConnection(
        arm.contact.host, arm.contact.port, timeout=HANG, source_address=(FAR, 0)
    )
    for headers, status in ((bearer(SECRET), 200), ({}, 403), (bearer(LOOKER), 403), ({}, 403)):
        connection.request("GET", "/?req=up", headers=headers)
        answer = connection.getresponse()
        answer.read()
        assert answer.status == status
    connection.close()


def test_nobody_else_sees_a_token(arm: yarpy.RpcServer, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)
    seen: list[object] = []

    def show(path: str, fields: object) -> None:
        seen.append((path, fields))

    arm.on_page(show)
    asked(arm, f"/map?x=1&token={SECRET}")
    asked(arm, f"/?req=say+$token&token={SECRET}")
    asked(arm, f"/?cmd=/b&token={LOOKER}")
    assert seen[0] == ("/map", {"x": "1"})
    text = caplog.text + str(seen)
    assert SECRET not in text
    assert LOOKER not in text


def test_pages_of_a_program_are_read(arm: yarpy.RpcServer) -> None:
    arm.on_page(lambda path, fields: "<h1>secret</h1>" if path == "/" else None)
    assert asked(arm, "/", bearer(LOOKER))[1] == "<h1>secret</h1>"
    answer, text = asked(arm, "/")
    assert answer.status == 403
    assert "secret" not in text


def test_another_origin_needs_its_own_leave_too(arm: yarpy.RpcServer) -> None:
    headers = {**bearer(SECRET), "Origin": "http://evil.test"}
    answer, text = asked(arm, "/?req=up", headers)
    assert answer.status == 403
    assert "YARPY_WEB_ORIGINS" in text


def test_xmlrpc(arm: yarpy.RpcServer) -> None:
    body = xmlrpc.client.dumps(("up",), "set")
    kind = {"Content-Type": "text/xml"}
    answer, text = asked(arm, "/RPC2", {**kind, **bearer(LOOKER)}, "POST", body)
    assert answer.status == 403
    assert "may not write to /arm" in text
    assert asked(arm, "/RPC2", kind, "POST", body)[0].status == 403
    answer, text = asked(arm, "/RPC2", {**kind, **bearer(SECRET)}, "POST", body)
    assert answer.status == 200
    assert "moved" in text
    asking = xmlrpc.client.dumps(("/me",), "getPid")
    assert asked(arm, "/RPC2", {**kind, **bearer(LOOKER)}, "POST", asking)[0].status == 200


@pytest.mark.parametrize(
    ("wishes", "token", "status"),
    [
        ("", "", 403),
        ("", LOOKER, 403),
        ("", SECRET, 101),
        ("&read", "", 403),
        ("&read", LOOKER, 101),
        ("&admin", LOOKER, 101),
        ("&admin", "", 403),
    ],
)
def test_websockets(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, wishes: str, token: str, status: int
) -> None:
    write(tmp_path, monkeypatch, RULES)
    shown = f"&token={token}" if token else ""
    headers = {
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Key": generate_nonce().decode(),
        "Sec-WebSocket-Version": "13",
    }
    with yarpy.BufferedPort("/arm", names=yarpy.LocalNames()) as arm:
        where = arm.contact.host, arm.contact.port
        connection = HTTPConnection(*where, timeout=HANG, source_address=(FAR, 0))
        connection.request("GET", f"/?ws{wishes}{shown}", headers=headers)
        assert connection.getresponse().status == status
        connection.close()


def test_a_hundred_refusals_are_one_line(
    arm: yarpy.RpcServer, caplog: pytest.LogCaptureFixture
) -> None:
    for _ in range(20):
        asked(arm, "/?req=up")
        asked(arm, "/RPC2", {"Content-Type": "text/xml"}, "POST", "x")
    lines = [record.getMessage() for record in caplog.records if record.levelno > logging.INFO]
    assert len(lines) == 2  # one for writing, one for asking
