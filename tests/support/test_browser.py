"""The browser of the tests: what it shows, and that it does not keep errors to itself."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from support.browser import OUTPUT, Browser
from support.wait import HANG


class Site(BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        known = self.path == "/"
        body = b"<title>t</title><h1>hello</h1>" if known else b""
        self.send_response(200 if known else 404)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *args: object) -> None:
        pass


@pytest.fixture
def site() -> Iterator[str]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), Site)
    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    yield f"127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()
    thread.join(HANG)


def test_page_and_picture(browser: Browser, site: str) -> None:
    browser.excuse("favicon.ico")
    page = browser.open(f"http://{site}/", dark=True, phone=True)
    assert page.locator("h1").inner_text() == "hello"
    assert page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches")
    assert page.evaluate("innerWidth") == 980  # a page that does not care about phones
    path = browser.picture(page, "support_browser")
    assert path.parent == OUTPUT
    assert path.read_bytes().startswith(b"\x89PNG")
    other = browser.open(f"http://x.test:{site.rpartition(':')[2]}/")
    assert other.locator("h1").inner_text() == "hello"


def test_complaints_are_kept(browser: Browser, site: str) -> None:
    page = browser.open(f"http://{site}/")
    page.evaluate("console.error('this is bad')")
    page.evaluate("setTimeout(() => { throw new Error('and this') }, 0)")
    page.evaluate("fetch('/nothing').then(r => r.text())")
    page.wait_for_timeout(100)
    found = browser.unexcused()
    for text in ("this is bad", "and this", "404"):
        assert any(text in line for line in found), found
    browser.excuse("this is bad|and this|404")
    assert not browser.unexcused()


def test_asyncio_works_after_a_browser() -> None:
    assert asyncio.run(asyncio.sleep(0, 1)) == 1
