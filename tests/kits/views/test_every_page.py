"""Every page and stream that yarpy serves, asked for by a page of another site: nothing is told.

Rules: the paths are those that the code itself lists, so that a new one is tried as soon as it is
there; a file that shows pages and is not in `SERVERS` or `PASSING` fails. The name of every port
here is a secret that all answers to an honest client contain, or lead to.
"""

from __future__ import annotations

import ast
import socket
import string
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.wait import HANG
from wsproto.utilities import generate_nonce

import yarpy
from yarpy import registry
from yarpy.carriers.web.http.asset import KINDS, PREFIX
from yarpy.carriers.web.http.intent import READS
from yarpy.carriers.web.http.page import Site
from yarpy.carriers.web.http.request import MAY
from yarpy.facts import MAGIC_SIZE
from yarpy.kits.devices.multi_sensor.server import MultiSensorServer
from yarpy.kits.launch.page.log_page import LogPage
from yarpy.kits.launch.page.owner import Owners
from yarpy.kits.launch.page.page import ApplicationPage
from yarpy.kits.record.page.record_page import RecordPage
from yarpy.kits.views.dash import Dash
from yarpy.kits.views.panel import Panel
from yarpy.kits.views.picture import Picture
from yarpy.kits.views.scope import Scope
from yarpy.kits.views.viewer import Viewer
from yarpy.port.hub import Hub
from yarpy.port.keep.log_line import LogLine

SOURCE = Path(yarpy.__file__).parent
SECRET = "s3cret"
PICTURE = yarpy.Image(np.zeros((8, 8, 3), "u1"))
MOZILLA = {"User-Agent": "Mozilla/5.0 (X11; Linux x86_64)", "Accept-Language": "en"}

Headers = dict[str, str]


class Thermometer:
    def thermometers(self) -> dict[str, float]:
        return {SECRET: 40.0}


@contextmanager
def opened(kind: Callable[..., Any], **options: Any) -> Iterator[Any]:
    with kind(f"/{SECRET}", names=yarpy.LocalNames(), **options) as port:
        yield port


@contextmanager
def dash() -> Iterator[Any]:
    with opened(yarpy.Port) as port:
        shown = Dash(port, yarpy.LocalNames())
        yield port
        shown.close()


@contextmanager
def panel() -> Iterator[Any]:
    with opened(yarpy.Port) as port:
        Panel(port, f"/{SECRET}", yarpy.LocalNames())
        yield port


@contextmanager
def log_page() -> Iterator[Any]:
    with opened(yarpy.Port) as port:
        LogPage(port).add([LogLine(f"/log/{SECRET}/p/1", "INFO", SECRET)])
        yield port


@contextmanager
def recorder() -> Iterator[Any]:
    """The page of a recorder that waits for a port; what it does is asked in its tests."""
    facts = {"state": "recording", "snapshots": False, "failure": ""}
    sizes = dict.fromkeys(("size", "held", "memory", "free"), 0)
    ports = {"counts": {}, "connected": set(), "waiting": [f"/{SECRET}"]}
    stand_in: Any = SimpleNamespace(name=f"/{SECRET}", files=[], **facts, **sizes, **ports)
    with yarpy.RpcServer(f"/{SECRET}", lambda asked: [SECRET], names=yarpy.LocalNames()) as port:
        RecordPage(port, stand_in)
        yield port


@contextmanager
def viewer() -> Iterator[Any]:
    with opened(yarpy.BufferedPort) as port:
        Viewer([Picture(port)])
        yield port


@contextmanager
def scope() -> Iterator[Any]:
    with opened(yarpy.Port) as port:
        Scope([f"/{SECRET}"]).serve(port)
        yield port


@contextmanager
def application() -> Iterator[Any]:
    """The page of a running application; whose programs are its owner's is asked in its tests."""
    link = {"from": f"/{SECRET}", "to": "/b", "state": "waiting"}
    told = {"application": SECRET, "programs": [], "connections": [link]}
    lines = {"lines": [[1, SECRET, SECRET]]}

    def answer(asked: dict[str, Any]) -> dict[str, Any]:
        return told if asked["do"] == "status" else lines

    with opened(yarpy.Port) as port:
        ApplicationPage(port, answer, Owners(dict), list)
        yield port


@contextmanager
def sensors() -> Iterator[Any]:
    with MultiSensorServer(f"/{SECRET}", Thermometer(), names=yarpy.LocalNames()) as server:
        yield server._rpc


@contextmanager
def name_server() -> Iterator[Any]:
    with yarpy.NameServer() as server:
        server.client.register(f"/{SECRET}", "tcp", "10.0.0.1", 9)
        yield server


@contextmanager
def camera() -> Iterator[Any]:
    """A port without pages of its own, which writes pictures."""
    done = threading.Event()

    def run() -> None:
        while not done.wait(0.02):
            with suppress(yarpy.PortClosed):
                port.write(PICTURE)

    with opened(yarpy.Port, callback=lambda message: message.reply([SECRET])) as port:
        thread = threading.Thread(target=run)
        thread.start()
        yield port
        done.set()
        thread.join(HANG)


SERVERS: dict[str, Callable[[], Any]] = {
    "kits/views/dash.py": dash,
    "kits/views/panel.py": panel,
    "kits/views/viewer.py": viewer,
    "kits/views/scope.py": scope,
    "kits/launch/page/page.py": application,
    "kits/launch/page/log_page.py": log_page,
    "kits/record/page/record_page.py": recorder,
    "kits/devices/multi_sensor/server.py": sensors,
    "nameserver/serving.py": name_server,
    "the port itself": camera,
}
# What hands pages of others on to a port.
PASSING = {"port/base.py", "port/rpc.py", "port/answer/callbacks.py", "aio/base.py", "aio/rpc.py"}


def test_no_server_is_missing_here() -> None:
    """Files that give a port pages to show, and carriers that browsers speak."""
    found = set()
    for path in SOURCE.rglob("*.py"):
        text = path.read_text("utf-8")
        for node in ast.walk(ast.parse(text)) if "on_page" in text else ():
            named = node.attr if isinstance(node, ast.Attribute) else ""
            if named == "on_page":
                found.add(path.relative_to(SOURCE).as_posix())
    assert found <= SERVERS.keys() | PASSING
    methods = (b"GET", b"POST", b"HEAD", b"PUT", b"OPTIONS")
    spoken = {
        name
        for name in registry.carriers.names()
        if getattr(registry.carriers.load(name), "magic", b"").startswith(methods)
    }
    assert spoken == {"http", "mjpeg", "websocket", "xmlrpc"}


# -- what may be asked for ------------------------------------------------------------------------


def hub_of(port: Any) -> Hub:
    """The hub of a port, or of a name server."""
    found: Hub = port.hub if isinstance(port, yarpy.NameServer) else port._hub
    return found


def commands() -> list[str]:
    """A path for each command that a port may be told, or may be told one day."""
    keys = {*READS, *string.ascii_letters, *string.punctuation} - {"&", "#", "%", "+"}
    return [f"/?cmd={key}" for key in sorted(keys)]


def paths(port: Any) -> list[str]:
    """Every path that this server knows: those of its program and those of all ports."""
    shown = hub_of(port).callbacks.program.on_page
    own = shown if isinstance(shown, Site) else getattr(shown, "site", {"/": None})
    every = [
        *own,
        *(f"/{PREFIX}{name}" for name in KINDS),
        *(f"/?cmd={key}" for key in READS),
        *("/", "/?", "/*", MAY, "/r", "/r?sse", "/r?format=json", "/r?pixels&sse", "/form"),
        *("/?req=list", "/?data=list", "/data=list", "/list", "/a/b", "/?admin=1&req=ver"),
        *("/?action=stream", "/?action=snapshot", "/web/main.css", "/web/", "/favicon.ico"),
    ]
    return [*dict.fromkeys(every)]


def foreign(host: str) -> dict[str, Headers]:
    """The requests that a page of another site can have a browser make."""
    number = host.partition(":")[2]
    cross = {"Sec-Fetch-Site": "cross-site"}
    evil = {"Origin": "http://evil.test"}
    return {
        "another origin": {"Host": host, **evil, **MOZILLA},
        "another origin, in TLS": {"Host": host, "Origin": "https://evil.test", **MOZILLA},
        "a public address": {"Host": host, "Origin": "http://8.8.8.8", **MOZILLA},
        "an origin without a name": {"Host": host, "Origin": "null", **MOZILLA},
        "another host": {"Host": f"evil.test:{number}", **MOZILLA},
        "another host and origin": {
            "Host": f"evil.test:{number}",
            "Origin": f"http://evil.test:{number}",
            **MOZILLA,
        },
        "cross-site": {"Host": host, **cross},
        "a picture of another page": {"Host": host, **cross, "Sec-Fetch-Mode": "no-cors"},
        "a script of another page": {"Host": host, **cross, **evil, "Sec-Fetch-Mode": "cors"},
    }


TYPED = {"Sec-Fetch-Site": "none", "Sec-Fetch-Mode": "navigate", **MOZILLA}
FOLLOWED = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", **MOZILLA}


def asked(port: Any, method: str, path: str, headers: Headers, body: bytes = b"") -> bytes:
    """The answer, to its end if it has one."""
    with dialled(port) as sock:
        return said(sock, method, path, headers, body)


def dialled(port: Any) -> socket.socket:
    """A new connection to a port."""
    host, _, number = port.address.rpartition(":")
    return socket.create_connection((host.strip("[]"), int(number)), HANG)


def said(sock: socket.socket, method: str, path: str, headers: Headers, body: bytes = b"") -> bytes:
    """The answer to a request on this connection."""
    head = "".join(f"{name}: {value}\r\n" for name, value in headers.items())
    last = f"Content-Length: {len(body)}\r\n" if body else ""
    sock.sendall(f"{method} {path} HTTP/1.1\r\n{head}{last}\r\n".encode() + body)
    answer = bytearray()
    while b"\r\n\r\n" not in answer and (piece := sock.recv(1 << 16)):
        answer += piece
    length = answer.lower().partition(b"content-length: ")[2].split(b"\r\n")[0]
    end = answer.find(b"\r\n\r\n") + 4 + (int(length) if length.isdigit() else 0)
    while method != "HEAD" and len(answer) < end and (piece := sock.recv(1 << 16)):
        answer += piece
    return bytes(answer)


def answers(port: Any, known: list[str], headers: Headers) -> Iterator[tuple[str, bytes]]:
    """Each path with the answer to GET. The first bytes of a connection say which carrier takes it:
    each beginning has a connection of its own, which goes on with the paths that begin alike."""
    alike: dict[str, list[str]] = {}
    for path in known:
        alike.setdefault(f"GET {path} "[:MAGIC_SIZE], []).append(path)
    for begun in alike.values():
        with ExitStack() as open_ones:
            sock = open_ones.enter_context(dialled(port))
            for path in begun:
                answer = said(sock, "GET", path, headers)
                yield path, answer
                if b"\r\nconnection: close\r\n" in answer.lower():
                    sock = open_ones.enter_context(dialled(port))


def status(answer: bytes) -> int:
    return int(answer.split(b" ")[1])


CALL = b"<methodCall><methodName>list</methodName><params/></methodCall>"


@pytest.mark.parametrize("where", SERVERS)
def test_nothing_is_told_to_a_page_of_another_site(where: str) -> None:
    with ExitStack() as stack:
        port = stack.enter_context(SERVERS[where]())
        known = paths(port)
        for who, headers in foreign(port.address).items():
            every = known if who != "another origin" else [*known, *commands()]
            for path, answer in answers(port, every, headers):
                assert status(answer) in (403, 421), (who, path, answer)
                assert SECRET.encode() not in answer, (who, path)
                assert b"YARPY_WEB_ORIGINS=" in answer, (who, path)
            for method, path in (("HEAD", "/"), ("OPTIONS", "/form"), ("POST", "/form")):
                answer = asked(port, method, path, headers, b"data=list" * (method == "POST"))
                assert status(answer) in (403, 421), (who, method)
            answer = asked(port, "POST", "/RPC2", {**headers, "Content-Type": "text/xml"}, CALL)
            assert status(answer) in (403, 421), who
            for wish in ("", "&read", "&read&pixels&envelope", "&admin"):
                answer = asked(port, "GET", f"/?ws{wish}", {**headers, **upgrade()})
                assert status(answer) in (403, 421), (who, wish)


@pytest.mark.parametrize("where", SERVERS)
def test_an_address_that_is_typed_or_followed_shows_the_page(where: str) -> None:
    with SERVERS[where]() as port:
        shown = hub_of(port).callbacks.program.on_page
        own = shown if isinstance(shown, Site) else getattr(shown, "site", {"/": None})
        address = {"Host": port.address, "Accept": "text/html"}
        for path in (*own, "/", "/?", "/*", "/r"):
            for headers in (TYPED, FOLLOWED, MOZILLA, {}):
                answer = asked(port, "GET", path, {**address, **headers})
                assert b"YARPY_WEB_ORIGINS" not in answer, (path, headers)
                assert path != "/" or status(answer) == 200
        if where == "the port itself":
            assert status(asked(port, "GET", "/?req=list", {**address, **TYPED})) == 200


def test_what_a_port_writes_is_read_by_pages_of_this_network() -> None:
    with camera() as port:
        for origin in ("http://192.168.1.5:8080", "http://robot", "http://dash.local:1"):
            headers = {"Host": port.address, "Origin": origin, **MOZILLA}
            for path in ("/r", "/r?sse", "/?action=stream", "/?action=snapshot", "/"):
                answer = asked(port, "GET", path, headers)
                assert status(answer) == 200, (origin, path)
                assert b"Access-Control-Allow-Origin: *" in answer
            answer = asked(port, "GET", "/?ws&read", {**headers, **upgrade()})
            assert status(answer) == 101
            assert status(asked(port, "GET", "/?req=x", headers)) == 403  # but not act


def upgrade() -> Headers:
    return {
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Key": generate_nonce().decode(),
        "Sec-WebSocket-Version": "13",
    }
