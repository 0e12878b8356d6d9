"""A directory as web pages: what is shown, and what never is."""

from __future__ import annotations

import hashlib
import os
import sys
import tracemalloc
from http.client import HTTPConnection, IncompleteRead
from pathlib import Path

import pytest
from support.system import NO_LINKS
from support.wait import HANG

import yarpy
from yarpy.carriers.web.http.page import Pieces
from yarpy.nameserver import folder
from yarpy.nameserver.folder import PIECE, Folder


@pytest.fixture
def site(tmp_path: Path) -> Path:
    """Files that are to be shown, and secrets beside and between them."""
    root = tmp_path / "site"
    (root / "sub").mkdir(parents=True)
    (root / "index.html").write_text("<h1>home</h1>")
    (root / "sub" / "index.html").write_text("sub")
    (root / "sub" / "two words.txt").write_text("words")
    (root / "picture.png").write_bytes(b"\x89PNG")
    (root / "code.js").write_text("1")
    (root / "data.json").write_text("[]")
    (root / ".htpasswd").write_text("secret")
    (root / ".git").mkdir()
    (root / ".git" / "config").write_text("secret")
    (root / "empty").mkdir()
    (tmp_path / "secret.txt").write_text("secret")
    if not NO_LINKS:
        (root / "out").symlink_to(tmp_path)
        (root / "leak.txt").symlink_to(tmp_path / "secret.txt")
        (root / "again.html").symlink_to(root / "index.html")
    if sys.platform != "win32":
        os.mkfifo(root / "pipe")
    return root


SHOWN = [
    ("/web/", "text/html; charset=utf-8", b"<h1>home</h1>"),
    ("/web/index.html", "text/html; charset=utf-8", b"<h1>home</h1>"),
    pytest.param(
        "/web/again.html",
        "text/html; charset=utf-8",
        b"<h1>home</h1>",
        marks=pytest.mark.skipif(bool(NO_LINKS), reason=NO_LINKS),
    ),
    ("/web/sub/", "text/html; charset=utf-8", b"sub"),
    ("/web/sub/two words.txt", "text/plain; charset=utf-8", b"words"),
    ("/web/picture.png", "image/png", b"\x89PNG"),
    ("/web/data.json", "application/json; charset=utf-8", b"[]"),
]


@pytest.mark.parametrize(("path", "kind", "body"), SHOWN)
def test_files_are_shown(site: Path, path: str, kind: str, body: bytes) -> None:
    page = Folder(site)(path, {})
    assert page == yarpy.Page(body, kind)


@pytest.mark.parametrize("path", ["/web", "/web/sub"])
def test_directory_without_its_slash_leads_to_it(site: Path, path: str) -> None:
    page = Folder(site)(path, {})
    assert page is not None
    assert f'href="{path.rpartition("/")[2]}/"' in str(page.body)


NEVER = [
    "/web/none",
    "/web/../secret.txt",
    "/web/sub/../../secret.txt",
    "/web//etc/passwd",
    "/web/" + "/etc/passwd",
    "/web/.htpasswd",
    "/web/.git/config",
    "/web/./index.html",
    "/web/leak.txt",
    "/web/out/secret.txt",
    "/web/pipe",
    "/web/empty",
    "/web/empty/",
    "/web/index.html/x",
    "/web/a\0b",
    "/web/..\\secret.txt",
    "/web/" + "x" * 5000,
    "/web/\udcff",
]


@pytest.mark.parametrize("path", NEVER)
def test_nothing_else_is(site: Path, path: str) -> None:
    page = Folder(site)(path, {})
    assert page is not None
    assert page.status == 404
    assert "secret" not in str(page.body)


def test_large_file_is_sent_in_pieces(site: Path, tmp_path: Path) -> None:
    """It was read whole into memory, and limited for that reason."""
    content = os.urandom(1 << 20) * 40
    (site / "large.bin").write_bytes(content)
    page = Folder(site)("/web/large.bin", {})
    assert page is not None
    assert isinstance(page.body, Pieces)
    assert max(map(len, page.body.read())) == PIECE
    with yarpy.NameServer(web=site) as server:
        client = HTTPConnection("127.0.0.1", server.port, timeout=HANG)
        tracemalloc.start()
        try:
            client.request("GET", "/web/large.bin")
            answer = client.getresponse()
            assert answer.headers["Content-Length"] == str(len(content))
            got = hashlib.sha256()
            while piece := answer.read(1 << 16):
                got.update(piece)
            assert tracemalloc.get_traced_memory()[1] < len(content) / 4
        finally:
            tracemalloc.stop()
        assert got.digest() == hashlib.sha256(content).digest()
        client.request("HEAD", "/web/large.bin")
        answer = client.getresponse()
        assert (answer.read(), answer.headers["Content-Length"]) == (b"", str(len(content)))
        client.request("GET", "/web/picture.png")
        assert client.getresponse().read() == b"\x89PNG"
        client.close()


def test_file_that_becomes_shorter_while_it_is_sent(
    site: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The connection ends: the client must not take the next answer for the rest."""
    (site / "large.bin").write_bytes(bytes(1 << 20))
    monkeypatch.setattr(folder, "_read", lambda path: iter([b"x" * 1000]))
    with yarpy.NameServer(web=site) as server:
        client = HTTPConnection("127.0.0.1", server.port, timeout=HANG)
        client.request("GET", "/web/large.bin")
        with pytest.raises(IncompleteRead):
            client.getresponse().read()
        client.close()


def test_the_rest_is_left_to_the_port(site: Path) -> None:
    for path in ("/", "/web/main.css", "/webcam", "/other"):
        assert Folder(site)(path, {}) is None


def test_no_directory(site: Path) -> None:
    with pytest.raises(yarpy.AddressError, match="not a directory"):
        Folder(site / "index.html")


def test_name_server_shows_files(site: Path) -> None:
    with yarpy.NameServer(web=site) as server:
        connection = HTTPConnection("127.0.0.1", server.port, timeout=HANG)

        def get(path: str) -> tuple[int, str | None, bytes]:
            connection.request("GET", path)
            response = connection.getresponse()
            return response.status, response.getheader("Content-Type"), response.read()

        assert get("/web/") == (200, "text/html; charset=utf-8", b"<h1>home</h1>")
        assert get("/web/sub/two%20words.txt?x=1")[2] == b"words"
        for path in ("/web/%2e%2e/secret.txt", "/web/..%2fsecret.txt", "/web/%2fetc/passwd"):
            status, _, body = get(path)
            assert status == 404
            assert b"secret" not in body
        assert b"color-scheme" in get("/web/main.css")[2]
        assert b"<h1>/root</h1>" in get("/*")[2]
        connection.request("HEAD", "/web/index.html")
        response = connection.getresponse()
        assert (response.getheader("Content-Length"), response.read()) == ("13", b"")
        connection.close()


def test_name_server_without_files() -> None:
    with yarpy.NameServer() as server:
        connection = HTTPConnection("127.0.0.1", server.port, timeout=HANG)
        connection.request("GET", "/web/main.css")
        assert b"color-scheme" in connection.getresponse().read()
        connection.close()
