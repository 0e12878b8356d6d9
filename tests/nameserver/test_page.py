"""What a name server shows to browsers, and what it does not know."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from yarpy.carriers.web.http.asset import KINDS
from yarpy.contact import Contact
from yarpy.nameserver.folder import Folder
from yarpy.nameserver.page import MOST, NamePage

PORTS = [Contact("tcp", "/a<b>", "10.0.0.1", 10002), Contact("mcast", "fallback", "224.2.1.1", 1)]


def shown(page: NamePage, path: str, **fields: str) -> tuple[int, str] | None:
    found = page(path, fields)
    if found is None:
        return None
    body = found.encoded()
    return found.status, (body if isinstance(body, bytes) else b"".join(body)).decode()


@pytest.fixture
def page() -> NamePage:
    return NamePage("/root", lambda: PORTS, {"list", "query"})


def test_files_of_the_page(page: NamePage) -> None:
    html = page("/", {})
    assert html is not None and html.kind.startswith("text/html")
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', str(html.body))
    assert policy is not None and "unsafe" not in policy[1]
    script = page("/names.js", {})
    assert script is not None and script.kind.startswith("text/javascript")
    assert "innerHTML" not in str(script.body)
    assert {*re.findall(r'"/\*/([\w.]+)"', f"{html.body}{script.body}")} <= {*KINDS}


def test_ports_as_json(page: NamePage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page._survey, "want", lambda: None)  # nobody was asked yet
    status, body = shown(page, "/ports") or (0, "")
    page.close()
    told = json.loads(body)
    assert (status, told["name"], told["more"]) == (200, "/root", 0)
    assert told["ports"][0] == {
        "name": "/a<b>",
        "carrier": "tcp",
        "host": "10.0.0.1",
        "port": 10002,
        "alive": None,
    }
    many = NamePage("/root", lambda: PORTS[:1] * (MOST + 7), ())
    told = many.told()
    assert (len(told["ports"]), told["more"]) == (MOST, 7)


def test_what_is_neither_page_nor_command_is_not_found(page: NamePage) -> None:
    for path in ("/nosuch", "/x/y", "/names.html", "/web/x", "/%3Cb%3E"):
        status, body = shown(page, path) or (0, "")
        assert (status, "/help lists them" in body) == (404, True)
    for path in ("/list", "/query/x", "/favicon.ico", "/web/main.css"):
        assert shown(page, path) is None
    assert shown(page, "/ver", admin="1") is None


def test_files_of_a_directory(tmp_path: Path) -> None:
    (tmp_path / "x.html").write_text("mine")
    page = NamePage("/root", lambda: PORTS, (), Folder(tmp_path))
    assert shown(page, "/web/x.html") == (200, "mine")
    assert (shown(page, "/web/y.html") or (0, ""))[0] == 404
