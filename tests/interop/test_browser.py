"""Ports in a real browser: their page, pictures, messages in JavaScript, and other people's pages.

The screenshots in tests/output are for people to look at.
"""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.browser import Browser
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.sig import jpeg
from yarpy.nameserver.local import LocalNames

if TYPE_CHECKING:
    from playwright.sync_api import Page

EXAMPLE = Path(__file__).parents[2] / "examples" / "websocket.html"
EVIL = "<script>window.hacked = 1</script><img src=x onerror='window.hacked = 2'>"


def head(message: yarpy.Message) -> object:
    """A head with three axes, as in docs/web.md."""
    match message.value:
        case ["set", "pos", int(), _]:
            return [yarpy.Vocab("ok")]
        case ["get", "encs"]:
            return [yarpy.Vocab("is"), "encs", [0.0, 45.0, 0.0]]
    return ["you said", *message.value]


@pytest.fixture
def port(names: LocalNames) -> Iterator[yarpy.RpcServer]:
    with yarpy.RpcServer("/head/rpc:i", head, names=names) as server:
        yield server


@contextmanager
def repeating(act: Callable[[int], object]) -> Iterator[None]:
    """Do something again and again, with a growing number, meanwhile."""
    done = threading.Event()

    def run() -> None:
        number = 0
        while not done.wait(0.03):
            act(number)
            number += 1

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join(HANG)


def fits(page: Page) -> bool:
    """Whether nothing sticks out to the right."""
    return bool(page.evaluate("document.scrollingElement.scrollWidth <= innerWidth"))


# ------------------------------------------------------------------------------- the port's page


@pytest.mark.parametrize("phone", [False, True], ids=["desk", "phone"])
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_page_of_a_port(browser: Browser, port: yarpy.RpcServer, dark: bool, phone: bool) -> None:
    page = browser.open(f"http://{port.address}/", dark=dark, phone=phone)
    look = f"port_{'dark' if dark else 'light'}_{'phone' if phone else 'desk'}"
    assert page.title() == "/head/rpc:i - yarp port"
    shows(page, "no connections with other ports")
    shows(page, "it receives messages and sends none by itself")
    assert fits(page)
    field_and_button = page.locator("form").first.bounding_box()
    assert field_and_button and field_and_button["height"] < 60, "they stand below each other"
    browser.picture(page, look)
    field = page.get_by_label("message")
    field.fill("get encs")
    page.get_by_role("button", name="send data").click()
    shows(page, "[is] encs (0.0 45.0 0.0)")
    assert field.input_value() == "get encs"  # to be said again, a little differently
    field.fill("set pos 1 45")
    field.press("Enter")
    shows(page, "[ok]")
    browser.picture(page, f"{look}_said")
    background = page.evaluate("getComputedStyle(document.documentElement).colorScheme")
    assert background == "light dark"


def text(page: Page) -> str:
    return page.locator("body").inner_text()


def shows(page: Page, words: str) -> None:
    """Wait until a page shows these words."""
    wait_until(lambda: words in text(page), HANG, f"{words!r} on {page.url}")


def test_links_of_the_page(browser: Browser, port: yarpy.RpcServer) -> None:
    page = browser.open(f"http://{port.address}/")
    page.get_by_role("link", name="commands").click()
    shows(page, "Reverse connection")
    page.get_by_role("link", name="help").click()
    shows(page, "you said")
    page.get_by_role("link", name="port", exact=True).click()
    shows(page, "no connections with other ports")


def test_page_that_reads(browser: Browser, names: LocalNames) -> None:
    with yarpy.Port("/out", names=names) as port:
        page = browser.open(f"http://{port.address}/", phone=True)
        page.get_by_role("link", name="messages").click()
        assert port.wait_for_outputs(timeout=HANG)
        with repeating(lambda number: port.write([number, "two words", EVIL])):
            shows(page, '9 "two words"')
            rows = page.locator("#messages code").all_inner_texts()
            found = [int(row.partition(" ")[0]) for row in rows]
            assert found == sorted(found, reverse=True), "the newest is not the first"
            page.get_by_role("button", name="Pause").click()
            wait_until(lambda: not port.outputs, HANG, "who pauses costs nothing")
            count = page.locator("#messages li").count()
            page.wait_for_timeout(300)
            assert page.locator("#messages li").count() == count
        assert EVIL in text(page).replace('\\"', '"')
        assert page.evaluate("window.hacked") is None
        assert fits(page)
        browser.picture(page, "port_read_phone")


def test_page_of_a_port_that_sends_numbers(browser: Browser, names: LocalNames) -> None:
    with (
        yarpy.Port("/head/state", names=names) as port,
        yarpy.BufferedPort("/in", names=names) as other,
    ):
        port.connect("/in")
        page = browser.open(f"http://{port.address}/", dark=True)
        shows(page, "it has sent nothing since this page was opened")

        def write(number: int) -> None:
            port.write([0.5 * number, ["speed", 7], EVIL, [[1, 2], time.time()]])

        with repeating(write):
            page.locator("#flow .plot").wait_for()
            names_ = page.locator(".legend .name")
            wait_until(lambda: names_.all_inner_texts() == ["0", "2 speed", "4", "5"])
            shows(page, "to /in")
            page.locator(".tree code", has_text="onerror").wait_for()
            browser.picture(page, "port_numbers_dark", whole=True)
        page.locator("#state", has_text="nothing new").wait_for()
        page.locator("#flow.still").wait_for()
        assert page.evaluate("window.hacked") is None
        assert other.inputs
        browser.excuse("ERR_|Failed to load")
        port.close()
        page.locator("#state", has_text="the port does not answer").wait_for()
        page.close()


def test_page_of_a_port_that_sends_pictures(browser: Browser, names: LocalNames) -> None:
    with yarpy.Port("/cam", names=names) as port:
        for path in ("", "r"):
            page = browser.open(f"http://{port.address}/{path}", phone=path == "r")
            with repeating(lambda number: port.write(colour("red"), yarpy.Stamp(number, 0.5))):
                wait_until(lambda: width(page) == 64)  # noqa: B023
                page.locator("#state", has_text=re.compile("image 64 . 48 rgb")).wait_for()
                assert fits(page)
                browser.picture(page, f"port_camera{path}")
            page.close()


def width(page: Page) -> int:
    script = "document.querySelector('#flow canvas')?.width ?? 0"
    found: int = page.evaluate(script)
    return found


def test_nothing_that_is_shown_is_markup(browser: Browser, names: LocalNames) -> None:
    name = "/<script>window.hacked=1</script>"
    with yarpy.RpcServer(name, lambda m: m.value, names=names) as port:
        page = browser.open(f"http://{port.address}/")
        assert page.locator("h1").inner_text() == name
        page.get_by_label("message").fill(f'"{EVIL}" "{EVIL}"')
        page.get_by_role("button", name="send data").click()
        shows(page, "onerror")
        assert page.get_by_label("message").input_value().count(EVIL) == 2
        page.goto(f"http://{port.address}/{EVIL}")
        assert page.locator("script").count() == 1  # ours
        assert page.evaluate("window.hacked") is None


def test_page_of_the_name_server(browser: Browser) -> None:
    evil = "/<script>window.hacked=1</script>"
    with yarpy.NameServer() as server, yarpy.RpcServer("/head/rpc:i", head) as port:
        server.client.register("/a/very/long/name" * 5, "tcp", "127.0.0.1", 9)
        server.client.register(evil, "tcp", 'x"y.invalid', 9)
        with yarpy.Port("/eye") as eye, yarpy.Port("/brain"):
            eye.connect("/brain")
            for phone in (False, True):
                page = browser.open(f"http://{server.address}/", phone=phone, dark=phone)
                shows(page, "→ /brain (tcp")
                shows(page, f"(process {os.getpid()})")
                shows(page, "gone: nobody listens there")
                shows(page, "where programs ask for a name server by multicast")
                assert fits(page)
                browser.picture(page, f"names_{'phone' if phone else 'desk'}")
                page.get_by_label("filter").fill("HEAD rpc")
                wait_until(lambda: page.locator("#ports li").count() == 1)  # noqa: B023
                page.get_by_label("filter").fill("")
                page.get_by_role("link", name="/head/rpc:i").click()
                page.wait_for_url(f"http://{port.address}/")
                assert page.locator("h1").inner_text() == "/head/rpc:i"
                page.get_by_role("link", name=server.address).click()
                page.wait_for_url(f"http://{server.address}/")
        # What has gone is no longer there, without anybody asking for the page again.
        wait_until(lambda: "/eye" not in text(page))
        assert page.evaluate("window.hacked") is None
        page.get_by_role("link", name="help").click()
        page.locator("form", has_text="query").get_by_label("portname").fill("/head/rpc:i")
        page.locator("form", has_text="query").get_by_role("button").click()
        page.locator("li", has_text="/head/rpc:i").wait_for()
        assert fits(page)
        page.close()


def test_page_that_a_program_made(browser: Browser, names: LocalNames) -> None:
    """A reply with `web` is shown; its script runs, but not as one of the port's own pages."""
    browser.excuse("sandboxed|opaque origin|Storage")
    html = (
        "<h1>mine</h1><script>document.title = 'ran';"
        "try { localStorage.x = 1; document.title = 'storage' } catch (e) {}</script>"
    )
    with yarpy.RpcServer("/p", lambda m: [["web", html]], names=names) as port:
        page = browser.open(f"http://{port.address}/my/page")
        assert page.locator("h1").inner_text() == "mine"
        assert page.title() == "ran"


# ------------------------------------------------------------------------------------- pictures


def colour(name: str) -> yarpy.Image:
    """A picture of one colour."""
    value = {"red": (255, 0, 0), "green": (0, 255, 0)}[name]
    return yarpy.Image(np.full((48, 64, 3), value, "u1"))


def test_stream_in_an_image(
    browser: Browser, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a page without an address, such as a file: browsers call its origin `null`."""
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "null")
    with yarpy.Port("/cam", names=names) as port:
        page = browser.open()
        page.set_content(
            f"<body style='margin:0'><img id=i src='http://{port.address}/?action=stream&quality=90'>",
            wait_until="commit",
        )
        assert port.wait_for_outputs(timeout=HANG)
        shown = "red"

        def write(number: int) -> None:
            port.write(colour(shown), yarpy.Stamp(number, 0.5))

        with repeating(write):
            wait_until(
                lambda: page.evaluate("document.getElementById('i').naturalWidth") == 64, HANG
            )
            for shown in ("red", "green", "red"):
                wait_until(lambda: seen(page) == shown, HANG, shown)  # noqa: B023
        page.close()
        wait_until(lambda: port.write(colour("red")) == 0 and not port.outputs)


def seen(page: Page) -> str:
    """The colour near the left upper corner of the page."""
    corner = {"x": 8, "y": 8, "width": 32, "height": 32}
    data = page.screenshot(type="jpeg", quality=95, clip=corner)
    red, green, _ = yarpy.Image.from_wire(jpeg.decode(data)).array.mean((0, 1))
    return "red" if red > 200 and green < 60 else "green" if green > 200 and red < 60 else "other"


# ----------------------------------------------------------------------------------- JavaScript


def test_websocket_example(
    browser: Browser, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The page of docs/web.md asks a server and reads what a port writes."""
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "null")  # what files are from
    heard: list[object] = []

    def answer(message: yarpy.Message) -> None:
        heard.append(message.value)
        message.reply(head(message))

    with yarpy.Port("/head", names=names, callback=answer) as port:
        page = browser.open(f"{EXAMPLE.as_uri()}?{port.address}", phone=True, dark=True)
        log = page.locator("#log")
        assert port.wait_for_outputs(timeout=HANG)
        page.get_by_role("button", name="send").click()
        shows(page, '= ["is"')
        assert '= ["is", "encs", [0.0, 45.0, 0.0]]' in log.inner_text()
        page.get_by_label("message").fill('["say", {"a": [1, 2.5]}, "two words", true]')
        page.get_by_role("button", name="send").click()
        wait_until(lambda: len(heard) == 2)
        assert heard[1] == ["say", [["a", [1, 2.5]]], "two words", True]
        port.write([1.5, EVIL])
        shows(page, "< [1.5")
        page.get_by_label("message").fill("no json")
        page.get_by_role("button", name="send").click()
        shows(page, '= ["fail"')
        assert fits(page)
        browser.picture(page, "websocket_example")
        page.get_by_role("button", name="connect").click()  # once more: the old ones go
        wait_until(lambda: log.inner_text().count("open") == 4)
        wait_until(lambda: len(port.outputs) == 1 and len(port.inputs) == 1)
        port.close()
        shows(page, "closed")


class Blank(BaseHTTPRequestHandler):
    """Somebody's site: one empty page."""

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(b"<title>site</title>")

    def log_message(self, *args: object) -> None:
        pass


@pytest.fixture
def site() -> Iterator[int]:
    """The port number of a web server with an empty page."""
    with ThreadingHTTPServer(("127.0.0.1", 0), Blank) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
        thread.start()
        yield server.server_port
        server.shutdown()
        thread.join(HANG)


ASK = """async ([address, ...message]) => {
  const headers = {"Content-Type": "application/json"};
  const body = JSON.stringify(message);
  const reply = await fetch(address + "/form", {method: "POST", headers, body});
  return reply.ok ? reply.json() : reply.status;
}"""
READ = """port => { window.found = [];
  new EventSource(port + "/r?sse").onmessage =
    event => found.push([event.lastEventId, JSON.parse(event.data)]);
}"""


def test_events_and_fetch(
    browser: Browser, names: LocalNames, site: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The JavaScript of docs/web.md, on a page from elsewhere."""
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "site.test")
    with (
        yarpy.Port("/state", names=names) as state,
        yarpy.RpcServer("/head", head, names=names) as rpc,
    ):
        page = browser.open(f"http://site.test:{site}/")
        page.evaluate(READ, f"http://{state.address}")
        assert state.wait_for_outputs(timeout=HANG)
        state.write([1.5, "x"], yarpy.Stamp(7, 2.5))
        page.wait_for_function("found.length == 1")
        assert page.evaluate("found") == [["7 2.5", [1.5, "x"]]]
        answer = page.evaluate(ASK, [f"http://{rpc.address}", "get", "encs"])
        assert answer == ["is", "encs", [0.0, 45.0, 0.0]]


# -------------------------------------------------------------------------------- other people

FORM = """address => {
  document.body.innerHTML = `<form method=post action="${address}/form" target=f>
    <input name=data value=evil></form><iframe name=f></iframe>`;
  document.forms[0].submit();
}"""
SOCKET = """([address, wishes]) => new Promise(done => {
  const socket = new WebSocket(`ws://${address}/?ws${wishes}`, "yarp.json");
  socket.onopen = () => { socket.send('["evil"]'); done("open") };
  socket.onerror = () => done("refused");
})"""


@pytest.fixture
def only(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, site: int) -> str:
    monkeypatch.setenv("YARPY_WEB_ORIGINS", request.param.format(site=site))
    return str(request.param)


@pytest.mark.parametrize("only", ["", "http://good.test:{site}"], indirect=True)
def test_only_some_pages_may_act(browser: Browser, names: LocalNames, site: int, only: str) -> None:
    browser.excuse("403|refused|WebSocket|Framing|frame-ancestors|blocked by CORS|ERR_FAILED")
    heard: list[object] = []

    def answer(message: yarpy.Message) -> None:
        heard.append(message.value)
        message.reply(head(message))

    from playwright.sync_api import Error as PlaywrightError

    with yarpy.Port("/p", names=names, callback=answer) as port:
        url = f"http://{port.address}"
        page = browser.open(f"http://bad.test:{site}/")
        with pytest.raises(PlaywrightError, match="Failed to fetch"):
            page.evaluate(ASK, [url, "evil"])
        assert page.evaluate(SOCKET, [port.address, ""]) == "refused"
        page.evaluate(FORM, url)
        page.frame_locator("iframe").locator("body").wait_for(state="attached")
        page.evaluate(READ, url)
        assert page.evaluate(SOCKET, [port.address, "&read"]) == "refused"
        assert not port.outputs
        near = browser.open(f"http://127.0.0.1:{site}/")  # of this network: it may read
        near.evaluate(READ, url)
        assert port.wait_for_outputs(timeout=HANG)
        port.write([1])
        near.wait_for_function("found.length == 1")
        assert near.evaluate(SOCKET, [port.address, "&read"]) == "open"
        assert heard == []
        # A page of the port's own still may, and one that is named.
        own = browser.open(f"{url}/")
        own.get_by_label("message").fill("mine 1")
        own.get_by_role("button", name="send data").click()
        own.locator("pre", has_text="you said").wait_for()
        assert heard == [["mine", 1]]
        good = browser.open(f"http://good.test:{site}/")
        if not only:
            with pytest.raises(PlaywrightError, match="Failed to fetch"):
                good.evaluate(ASK, [url, "good"])
        else:
            assert good.evaluate(ASK, [url, "good"]) == ["you said", "good"]
            assert good.evaluate(SOCKET, [port.address, ""]) == "open"
            wait_until(lambda: ["evil"] in heard)


def test_rebound_name_is_not_the_ports_own(browser: Browser, names: LocalNames) -> None:
    """A site that lets its name point to this computer is not the port's own page."""
    browser.excuse("421")
    with yarpy.RpcServer("/p", head, names=names) as port:
        page = browser.open(f"http://rebound.test:{port.contact.port}/")
        page.get_by_text("YARPY_WEB_ORIGINS").wait_for()
