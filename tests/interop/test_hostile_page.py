"""A browser in front of ports: a hostile page of another origin, https, and web tokens."""

from __future__ import annotations

import hashlib
import threading
from base64 import b64encode
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from support import browser as chromium
from support.access import write
from support.browser import Browser
from support.peer import brings
from support.peer import chromium as program
from support.process import Process
from support.tls import prepare
from support.wait import HANG, wait_until

import yarpy
from yarpy.nameserver.local import LocalNames

if TYPE_CHECKING:
    from playwright.sync_api import Page


# Everything that a page can do without being allowed to: each returns what came of it. A browser
# does not let such a page read most answers, but the requests arrive.
TRIES = """async address => {
  const url = `http://${address}`;
  const tried = {};
  const quiet = {mode: "no-cors", method: "POST"};
  const put = async (name, path, options) => {
    try {
      const answer = await fetch(url + path, options);
      tried[name] = answer.type === "opaque" ? "opaque" : answer.status;
    } catch (error) {
      tried[name] = "refused";
    }
  };
  const call = "<methodCall><methodName>evil</methodName><params/></methodCall>";
  const xml = {"Content-Type": "text/xml"};
  const json = {"Content-Type": "application/json"};
  await put("get", "/?req=evil");
  await put("get quietly", "/?req=evil", {mode: "no-cors"});
  await put("path", "/evil/deed");
  await put("form", "/form", {...quiet, body: new URLSearchParams({data: "evil"})});
  const add = new URLSearchParams({data: "[add] /evil", admin: 1});
  await put("admin", "/form", {...quiet, body: add});
  await put("attach", "/form", {...quiet, body: new URLSearchParams({
    data: "[atch] in (type python) (file /tmp/evil.py)", admin: 1})});
  await put("text", "/form", {...quiet, body: "evil"});
  await put("json", "/form", {method: "POST", headers: json, body: '["evil"]'});
  await put("command", "/?cmd=/evil");
  await put("xmlrpc", "/RPC2", {...quiet, body: call});
  await put("xmlrpc with a type", "/RPC2", {method: "POST", headers: xml, body: call});
  await put("xmlrpc at the root", "/", {method: "POST", headers: xml, body: call});
  tried.beacon = navigator.sendBeacon(`${url}/form`, new URLSearchParams({data: "evil"}));
  const socket = wishes => new Promise(done => {
    const made = new WebSocket(`ws://${address}/?ws${wishes}`, "yarp.json");
    made.onopen = () => { made.send('["evil"]'); done("open") };
    made.onerror = () => done("refused");
  });
  tried.socket = await socket("");
  tried["socket for administration"] = await socket("&admin");
  const kinds = [["text/plain", "post"], ["multipart/form-data", "post"], ["", "get"]];
  for (const [kind, method] of kinds) {
    const form = document.createElement("form");
    Object.assign(form, {action: `${url}/form`, method, target: "frame"});
    if (kind) form.enctype = kind;
    form.innerHTML = "<input name=data value=evil>";
    document.body.append(form);
    form.submit();
    await new Promise(done => setTimeout(done, 200));
  }
  new Image().src = `${url}/?req=evil`;
  await new Promise(done => setTimeout(done, 300));
  return tried;
}"""
READS = """async address => {
  const found = {};
  found.page = (await (await fetch(`http://${address}/`)).text()).includes("This is /arm");
  found.event = await new Promise(done => {
    const events = new EventSource(`http://${address}/r?sse`);
    events.onmessage = event => done(JSON.parse(event.data));
    events.onerror = () => done("refused");
  });
  return found;
}"""


class Blank(BaseHTTPRequestHandler):
    """An empty page, whatever is asked for."""

    def do_GET(self) -> None:
        body = b"<!DOCTYPE html><link rel=icon href=data:,><iframe name=frame></iframe>"
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: object) -> None:
        """Nothing."""


@pytest.fixture
def site() -> Iterator[int]:
    """The port number of a web server with an empty page."""
    with ThreadingHTTPServer(("127.0.0.1", 0), Blank) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
        thread.start()
        yield server.server_port
        server.shutdown()
        thread.join(HANG)


@contextmanager
def writing(port: yarpy.Port) -> Iterator[None]:
    """A port that writes again and again meanwhile."""
    done = threading.Event()

    def run() -> None:
        while not done.wait(0.05):
            port.write([1.5, "x"])

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join(HANG)


def test_a_hostile_page_reads_and_does_nothing(
    browser: Browser, names: LocalNames, site: int
) -> None:
    browser.excuse(".")
    heard: list[object] = []

    def answer(message: yarpy.Message) -> None:
        heard.append(message.value)

    with yarpy.Port("/arm", names=names, callback=answer) as port, writing(port):
        port.on_admin(lambda message: heard.append(message.value))
        page = browser.open(f"http://evil.test:{site}/")
        tried = page.evaluate(TRIES, port.address)
        assert heard == []
        assert [link for link in port.outputs if link.target != "web"] == []
        assert tried.pop("beacon")  # which tells a page nothing
        assert all(what in ("opaque", "refused") or what >= 400 for what in tried.values()), tried
        assert tried["get"] == 403
        assert tried["socket"] == "refused"
        assert page.evaluate(READS, port.address) == {"page": False, "event": "refused"}
        # A page of another port of this computer reads, and does nothing either.
        page = browser.open(f"http://127.0.0.1:{site}/")
        assert page.evaluate(READS, port.address) == {"page": True, "event": [1.5, "x"]}
        assert page.evaluate(TRIES, port.address)["get"] == 403
        assert heard == []


def test_a_site_that_borrows_our_address(browser: Browser, names: LocalNames) -> None:
    """DNS rebinding: its name leads to this computer, so the browser takes both for one origin."""
    browser.excuse(".")
    heard: list[object] = []
    with yarpy.Port("/arm", names=names, callback=lambda m: heard.append(m.value)) as port:
        address = f"evil.test:{port.contact.port}"
        page = browser.open(f"http://{address}/")
        assert page.get_by_text("YARPY_WEB_ORIGINS").count()
        tried = page.evaluate(TRIES, address)
        assert tried.pop("beacon")
        assert set(tried.values()) <= {421, "opaque", "refused"}, tried
        assert page.evaluate("async () => (await fetch('/r?sse')).status") == 421
        assert heard == []


# -- tokens ---------------------------------------------------------------------------------------


TOKEN = "4Zr2kXqyJtWm0v8N"
RULES = f"""
[[allow]]
who = "token:looker"
may = "read"

[tokens]
looker = "{TOKEN}"
"""


def test_a_token_lets_a_browser_look(
    browser: Browser,
    names: LocalNames,
    site: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    browser.excuse("403|ERR_FAILED|CORS|MIME")
    write(tmp_path, monkeypatch, RULES)
    with yarpy.Port("/arm", names=names) as port, writing(port):
        page = browser.open(f"http://{port.address}/")
        page.get_by_text("Access refused: this computer may not").wait_for()
        page.goto(f"http://{port.address}/?token={TOKEN}")
        assert page.url == f"http://{port.address}/"
        page.get_by_text("Read only:").wait_for()
        page.locator("#flow canvas").wait_for()  # what flows, over a connection of its own
        page.locator("#state", has_text="/s").wait_for()
        assert page.locator("form").count() == 0
        assert TOKEN not in page.evaluate("document.cookie + document.documentElement.innerHTML")
        assert acts(page) == 403
        browser.picture(page, "port_read_only")
        # Of what the browser knows now, a page of another site cannot make use.
        page.goto(f"http://evil.test:{site}/")
        for options in ({}, {"credentials": "include"}):
            assert reached(page, port.address, options) in (403, "refused")
        assert reached(page, port.address, {"mode": "no-cors", "credentials": "include"}) == 0


def acts(page: Page) -> int:
    body = '{method: "POST", body: new URLSearchParams({data: "evil"})}'
    status: int = page.evaluate(f"async () => (await fetch('/form', {body})).status")
    return status


def reached(page: Page, address: str, options: dict[str, str]) -> int | str:
    script = """async ([url, options]) => {
      try { return (await fetch(url, options)).status } catch { return "refused" }
    }"""
    found: int | str = page.evaluate(script, [f"http://{address}/", options])
    return found


# -- https ----------------------------------------------------------------------------------------


@pytest.fixture
@brings("chromium")
def trusting(
    tmp_path_factory: pytest.TempPathFactory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Browser]:
    """A browser that knows the certificate of this computer, and no other that it does not know."""
    from playwright.sync_api import sync_playwright

    folder = prepare(tmp_path, monkeypatch)
    profile = tmp_path_factory.mktemp("chromium")
    known = f"--ignore-certificate-errors-spki-list={fingerprint(folder / 'cert.pem')}"
    line = [program(), *chromium.FLAGS, known, f"--user-data-dir={profile}", "about:blank"]
    with Process(line, env=chromium._environment(profile)) as process:
        found = process.wait_line(r"DevTools listening on (ws://\S+)", timeout=60.0)
        with sync_playwright() as playwright:
            connected = playwright.chromium.connect_over_cdp(found[1])
            made = Browser(connected)
            yield made
            made.close()
            connected.close()
        assert not made.unexcused()


def fingerprint(certificate: Path) -> str:
    """Of the public key, as Chromium wants it."""
    x509 = pytest.importorskip("cryptography.x509")
    serialization = pytest.importorskip("cryptography.hazmat.primitives.serialization")
    key = x509.load_pem_x509_certificate(certificate.read_bytes()).public_key()
    form = serialization.PublicFormat.SubjectPublicKeyInfo
    data = key.public_bytes(serialization.Encoding.DER, form)
    return b64encode(hashlib.sha256(data).digest()).decode()


def test_https(trusting: Browser) -> None:
    with yarpy.NameServer() as server, yarpy.Port("/arm") as port, writing(port):
        page = trusting.open(f"https://{server.address}/")
        link = page.get_by_role("link", name="/arm", exact=True)
        link.wait_for()
        assert link.get_attribute("href") == f"https://{port.address}/"
        link.click()
        page.wait_for_url(f"https://{port.address}/")
        page.locator("#flow canvas").wait_for()
        page.get_by_label("message").fill("hello")
        back = page.get_by_role("link", name=f"https://{server.address}/")
        assert back.get_attribute("href") == f"https://{server.address}/"
        found = page.evaluate(
            """address => new Promise(done => {
              const socket = new WebSocket(`wss://${address}/?ws&read`, "yarp.json");
              socket.onmessage = event => done(JSON.parse(event.data));
              socket.onerror = () => done("refused");
            })""",
            port.address,
        )
        assert found == [1.5, "x"]
        trusting.picture(page, "port_https")
        page.goto(f"https://{server.address}/*")
        page.get_by_role("link", name="/arm", exact=True).wait_for()
        assert page.locator('a[href^="http://"]').count() == 0


def test_a_certificate_of_somebody_else_is_not_taken(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: LocalNames
) -> None:
    from playwright.sync_api import Error

    prepare(tmp_path, monkeypatch)
    with yarpy.Port("/arm", names=names) as port:
        with pytest.raises(Error, match="ERR_CERT_AUTHORITY_INVALID"):
            browser.open(f"https://{port.address}/")
        wait_until(lambda: not port.inputs)
