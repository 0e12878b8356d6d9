"""Ports in the hands of web clients: http.client, curl where it is installed, and rude ones."""

from __future__ import annotations

import contextlib
import json
import socket
import subprocess
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from http.client import HTTPConnection, HTTPResponse

import numpy as np
import pytest
from support.lasted import lasted
from support.peer import program
from support.wait import HANG, wait_until

import yarpy
from yarpy.carriers.base import Limits
from yarpy.carriers.web.http.carrier import Http
from yarpy.link.begin import handshake
from yarpy.nameserver.local import LocalNames

FAST = 5.0  # seconds that nothing here needs
UPGRADE = (
    b"Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
)


@pytest.fixture
def names() -> LocalNames:
    return LocalNames()


@pytest.fixture
def echo(names: LocalNames) -> Iterator[yarpy.RpcServer]:
    with yarpy.RpcServer("/echo", lambda m: ["ok", "echo", m.value], names=names) as server:
        yield server


def where(port: yarpy.RpcServer) -> tuple[str, int]:
    return "127.0.0.1", port.contact.port


def client(port: yarpy.RpcServer | yarpy.Port | yarpy.BufferedPort) -> HTTPConnection:
    return HTTPConnection("127.0.0.1", port.contact.port, timeout=HANG)


def get(connection: HTTPConnection, target: str, **headers: str) -> tuple[int, str]:
    connection.request("GET", target, headers={k.replace("_", "-"): v for k, v in headers.items()})
    response = connection.getresponse()
    return response.status, response.read().decode()


def test_many_requests_on_one_connection(echo: yarpy.RpcServer) -> None:
    connection = client(echo)
    for number in range(50):
        status, body = get(connection, f"/?req=get+$n&n={number}")
        assert (status, json.loads(body)) == (200, ["ok", "echo", ["get", number]])
    assert len(echo.inputs) == 1
    assert echo.inputs[0].stats.messages == 50
    connection.close()
    wait_until(lambda: not echo.inputs)


def test_bodies_and_pages(echo: yarpy.RpcServer) -> None:
    connection = client(echo)
    connection.request("POST", "/form", '["set", {"a": 1}]', {"Content-Type": "application/json"})
    assert json.load(connection.getresponse()) == ["ok", "echo", ["set", [["a", 1]]]]
    connection.request(
        "POST", "/form", "data=x", {"Content-Type": "application/x-www-form-urlencoded"}
    )
    page = connection.getresponse().read().decode()
    assert "ok echo (x)" in page
    assert "<h1>/echo</h1>" in page
    _, page = get(connection, "/")
    assert "There is an input connection from web to /echo using http" in page
    assert json.loads(get(connection, "/?admin=1&req=ver")[1]) == ["ver", 1, 2, 3]
    connection.close()


def test_script_in_a_name(names: LocalNames) -> None:
    with yarpy.Port("/<script>alert(1)</script>", names=names) as port:
        connection = client(port)
        assert get(connection, "/")[1].count("<script") == 1  # ours
        assert "&lt;script&gt;" in get(connection, "/")[1]
        connection.close()


def test_port_that_never_replies(names: LocalNames) -> None:
    with yarpy.BufferedPort("/in", names=names) as port:
        connection = client(port)
        assert get(connection, "/?req=hello+web") == (200, "[]\n")
        assert port.read(timeout=HANG).value == ["hello", "web"]
        assert get(connection, "/a/b")[0] == 204
        connection.close()


def test_reader_that_answers_later(names: LocalNames) -> None:
    with yarpy.Port("/in", names=names) as port:

        def read() -> None:
            for _ in range(2):
                message = port.read(timeout=HANG)
                time.sleep(0.02)
                message.reply(["got", *message.value])

        thread = threading.Thread(target=read, daemon=True)
        thread.start()
        connection = client(port)
        assert get(connection, "/?req=1")[1] == '["got", 1]\n'
        assert get(connection, "/?req=2")[1] == '["got", 2]\n'
        thread.join(HANG)
        connection.close()


@contextmanager
def opened(port: yarpy.Port, target: str, count: int = 1) -> Iterator[HTTPResponse]:
    """The response to a GET that makes its sender an output of the port."""
    with closing(client(port)) as connection:
        connection.request("GET", target)
        with connection.getresponse() as response:
            assert port.wait_for_outputs(count, HANG)
            yield response


def test_reading_a_port(names: LocalNames) -> None:
    with (
        yarpy.Port("/out", names=names) as port,
        opened(port, "/r") as lines,
        opened(port, "/r?sse", 2) as events,
    ):
        assert events.getheader("Content-Type") == "text/event-stream"
        assert events.readline() == b": reading\n"
        port.write(["hi", 3], yarpy.Stamp(7, 1.25))
        assert lines.readline() == b"hi 3\r\n"
        assert [events.readline() for _ in range(4)] == [
            b"\n",
            b"id: 7 1.25\n",
            b'data: ["hi", 3]\n',
            b"\n",
        ]
        assert [link.target for link in port.outputs] == ["web", "web"]
        port.close()
        assert lines.read() == b""
        assert events.read() == b""


def test_program_that_streams(names: LocalNames) -> None:
    """A reply with `stream`, then what the port writes, on the same connection."""

    def answer(message: yarpy.Message) -> None:
        message.reply([["web", "zero\n"], ["mime", "text/plain"], ["stream", 1]])

    with (
        yarpy.Port("/out", names=names, callback=answer) as port,
        opened(port, "/my/stream") as response,
    ):
        assert response.getheader("Content-Type") == "text/plain"
        assert response.readline() == b" " * 2048 + b"zero\n"
        port.write([["web", "one\n"]])
        assert response.readline() == b"one\n"
        port.write(["two", 2])
        assert response.readline() == b"two 2\r\n"
        port.close()
        assert response.read() == b""


def test_reader_that_goes_is_dropped(names: LocalNames) -> None:
    with yarpy.Port("/out", names=names) as port:
        with opened(port, "/r"):
            pass

        def gone() -> bool:
            port.write([1])
            return not port.outputs

        wait_until(gone)


def test_stalled_browser_costs_the_port_nothing(names: LocalNames) -> None:
    with yarpy.Port("/out", names=names) as port:
        with opened(port, "/r"):
            started = time.monotonic()
            for _ in range(200):
                port.write(["x" * 100_000])
            port.flush()
            assert lasted(started) < FAST
            assert port.outputs[0].stats.replaced > 50
        started = time.monotonic()
    assert lasted(started) < FAST


def test_browser_on_a_client_is_not_asked(names: LocalNames, echo: yarpy.RpcServer) -> None:
    with yarpy.RpcClient("/echo", name="/asker", names=names) as asker:
        connection = HTTPConnection("127.0.0.1", asker.contact.port, timeout=HANG)
        connection.request("GET", "/r")
        connection.getresponse()
        wait_until(lambda: len(asker.outputs) == 2)
        assert asker.call(1) == ["ok", "echo", [1]]
        echo_link = next(link for link in asker.outputs if link.target == "/echo")
        echo_link.close()
        assert asker.call(2) == ["ok", "echo", [2]]
        connection.close()


def test_idle_and_unfinished_connections_hold_nobody_up(echo: yarpy.RpcServer) -> None:
    idle = []
    for number in range(60):
        sock = socket.create_connection(("127.0.0.1", echo.contact.port), HANG)
        sock.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n" + (b"\r\n" if number % 2 else b"X: "))
        idle.append(sock)
    connection = client(echo)
    assert get(connection, "/?req=x")[0] == 200
    connection.close()
    for sock in idle:
        sock.close()


def test_greeting_that_never_ends_is_given_up(
    echo: yarpy.RpcServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(handshake, "TIMEOUT", 0.2)
    with socket.create_connection(("127.0.0.1", echo.contact.port), HANG) as sock:
        sock.sendall(b"GET /xx ")

        def hung_up() -> bool:
            try:
                sock.sendall(b"x")
            except OSError:
                return True
            return False

        wait_until(hung_up)
        assert not echo.inputs


BEGINNINGS = [
    b"POST /form HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n",
    b"GET /?req=x HTTP/1.1\r\nHost: localhost\r\n\r\nGET /?req=y HTTP/1.1\r\nX: ",
    b"POST /RPC2 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n",
]


@pytest.mark.parametrize("beginning", BEGINNINGS, ids=["body", "head", "xmlrpc"])
def test_ten_who_send_too_slowly_block_nobody(
    echo: yarpy.RpcServer, monkeypatch: pytest.MonkeyPatch, beginning: bytes
) -> None:
    for module in ("http.exchange", "xmlrpc"):
        monkeypatch.setattr(f"yarpy.carriers.web.{module}.TIME", 0.5)
    slow = []
    for _ in range(10):
        sock = socket.create_connection(("127.0.0.1", echo.contact.port), HANG)
        sock.sendall(beginning)
        slow.append(sock)
    connection = client(echo)
    for sock in slow * 3:
        with contextlib.suppress(OSError):
            sock.sendall(b"x")
        assert get(connection, "/?req=x")[0] == 200
    for sock in slow:
        assert b"HTTP/1.1 408 Request Timeout\r\n" in said_to(sock)
        sock.close()
    assert get(connection, "/?req=x")[0] == 200
    connection.close()
    wait_until(lambda: not echo.inputs)


def said_to(sock: socket.socket) -> bytes:
    """Everything up to the end."""
    data = b""
    with contextlib.suppress(ConnectionResetError):  # what we sent behind it was not read
        while part := sock.recv(1000):
            data += part
    return data


def test_time_for_a_request_begins_with_it(
    echo: yarpy.RpcServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not when the last one was answered, with or without the port."""
    monkeypatch.setattr("yarpy.carriers.web.http.exchange.TIME", 1.0)
    connection = client(echo)
    for target in ("/?req=x", "/favicon.ico", "/?req=x"):
        assert get(connection, target)[0] in (200, 204)
        time.sleep(1.1)
    connection.putrequest("POST", "/form")
    connection.putheader("Content-Length", "5")
    connection.endheaders()
    connection.send(b"req")
    time.sleep(0.1)
    connection.send(b"=x")
    assert connection.getresponse().read() == b'["ok", "echo", ["x"]]\n'
    time.sleep(1.1)
    assert get(connection, "/?req=x")[0] == 200
    connection.close()


def test_connection_that_says_nothing_more_ends(
    echo: yarpy.RpcServer, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(Http, "limits", Limits(idle_timeout=0.1))
    connection = client(echo)
    assert get(connection, "/?req=x")[0] == 200
    assert connection.sock is not None
    assert connection.sock.recv(1) == b""
    connection.close()
    assert not [record for record in caplog.records if record.levelname == "WARNING"]


def test_refusal_reaches_who_still_sends(echo: yarpy.RpcServer) -> None:
    connection = client(echo)
    connection.putrequest("POST", "/form")
    connection.putheader("Content-Length", str(1 << 25))
    connection.endheaders()
    connection.send(b"x" * 500_000)
    assert connection.getresponse().status == 413
    connection.close()
    with closing(client(echo)) as another:
        assert get(another, "/?req=x")[0] == 200


@pytest.mark.parametrize(
    ("request_", "status"),
    [
        (b"POST /form HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n", 413),
        (b"POST /RPC2 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n", 413),
        (b"GET /?ws HTTP/1.1\r\nHost: localhost\r\n\r\n", 426),
        (b"GET /?action=stream HTTP/1.1\r\nHost: localhost\r\n\r\n", 403),
    ],
)
def test_who_is_refused_occupies_nothing_for_long(
    echo: yarpy.RpcServer, request_: bytes, status: int
) -> None:
    """It said a minute, or ten seconds, would do."""
    with socket.create_connection(where(echo), 8) as sock:
        sock.sendall(request_)
        said = sock.makefile("rb").read()  # to the end of the connection
        assert said.startswith(b"HTTP/1.1 %d " % status)


def test_message_that_cannot_be_read_is_400(echo: yarpy.RpcServer) -> None:
    with yarpy.NameServer() as server:
        for host, port in (("127.0.0.1", server.port), where(echo)):
            connection = HTTPConnection(host, port, timeout=HANG)
            for query in ("/?req=", "/?data="):
                connection.request("GET", query + "(" * 4000)
                answer = connection.getresponse()
                assert answer.status == 400
                assert answer.read() == b"text with lists nested more than 100 deep\n"
            assert get(connection, "/?req=list")[0] == 200
            connection.close()


def test_port_that_sends_nothing_says_so(echo: yarpy.RpcServer) -> None:
    why = b"this port sends nothing by itself, it answers what it is asked\n"
    connection = client(echo)
    for query in ("/?action=snapshot", "/?action=stream", "/r", "/r?sse"):
        connection.request("GET", query)
        answer = connection.getresponse()
        assert (answer.status, answer.read()) == (403, why)
    assert "read" not in json.loads(get(connection, "/*/may")[1])
    connection.close()
    for first in (b"GET /?action=snapshot HTTP/1.1\r\n", b"GET /?ws&read HTTP/1.1\r\n" + UPGRADE):
        with socket.create_connection(where(echo), HANG) as sock:
            sock.sendall(first + b"Host: localhost\r\n\r\n")
            said = sock.makefile("rb").readline()
            assert said.startswith(b"HTTP/1.1 403 ")
    assert not echo.outputs


def test_ports_talk_http(names: LocalNames, echo: yarpy.RpcServer) -> None:
    with yarpy.RpcClient("/echo", carrier="http", names=names) as asker:
        assert asker.call("add", 1, [2.5, "a $b"]) == ["ok", "echo", ["add", 1, [2.5, "a $b"]]]


def test_name_server_in_a_browser() -> None:
    with yarpy.NameServer() as server, yarpy.RpcServer("/x", lambda m: m.value) as port:
        connection = HTTPConnection("127.0.0.1", server.port, timeout=HANG)

        def ask(query: str) -> object:
            return json.loads(get(connection, query)[1])

        where = {
            "type": "port",
            "name": "/x",
            "ip": "127.0.0.1",
            "port_number": port.contact.port,
            "carrier": "tcp",
        }
        assert ask("/?req=query+$port&port=/x") == where
        assert ask("/?req=query+/no") == ["port", ["error", -2, "port not known"]]
        listed = ask("/?req=list")
        assert isinstance(listed, list)
        assert listed[0] == "ports"
        assert where in listed
        ask("/?req=set+/x+pp+7")
        assert ask("/?req=get+/x+pp") == [7]  # nothing of the request was stored with it
        assert ask("/?req=check+/x+pp+7") == [
            "port", "/x", "property", "pp", "value", 7, "present", "true",
        ]  # fmt: skip
        assert ask("/?req=route+/x+/y") == ["port", "/x", "route", "/y", "=", "tcp://y"]
        assert ask("/?req=gc") == ["garbage", "collection", "done."]
        assert ask("/?req=bogus") == ["***", "end", "of", "message"]
        assert ask("/?req=subscribe+/a+/b") == ["ok"]
        assert ask("/?req=subscribe") == [
            "subscriptions",
            {"type": "subscription", "src": "/a", "dest": "/b"},
        ]
        link = f'<a href="http://127.0.0.1:{port.contact.port}/">/x</a>'
        assert '<ul id="ports"' in get(connection, "/")[1]  # filled by a script
        assert link in get(connection, "/data=list")[1]
        assert 'value="query $portname"' in get(connection, "/data=help")[1]
        here = HTTPConnection("127.0.0.1", port.contact.port, timeout=HANG)
        assert f'href="http://127.0.0.1:{server.port}/"' in get(here, "/")[1]
        here.close()
        connection.close()


# ---------------------------------------------------------------------------------- pages


def shown(path: str, fields: Mapping[str, str]) -> yarpy.Page | str | None:
    match path:
        case "/":
            return "<h1>mine</h1>"
        case "/n.json":
            return yarpy.Page(json.dumps(dict(fields)), "application/json")
        case "/gone":
            return yarpy.Page(b"gone", "text/plain", 404)
        case "/broken":
            raise ValueError("a defect")
    return None


def test_a_program_shows_pages(echo: yarpy.RpcServer, caplog: pytest.LogCaptureFixture) -> None:
    echo.on_page(shown)
    connection = client(echo)
    assert get(connection, "/") == (200, "<h1>mine</h1>")
    assert get(connection, "/n.json?a=1&b=x+y") == (200, '{"a": "1", "b": "x y"}')
    assert get(connection, "/gone") == (404, "gone")
    connection.request("HEAD", "/n.json")
    response = connection.getresponse()
    assert (response.getheader("Content-Type"), response.read()) == ("application/json", b"")
    assert response.getheader("Content-Security-Policy") == "frame-ancestors 'self'"
    # What it leaves, and every message, is the port's.
    assert "<h1>/echo</h1>" in get(connection, "/*")[1]
    assert "Here are the commands" in get(connection, "/?")[1]
    assert get(connection, "/?req=x") == (200, '["ok", "echo", ["x"]]\n')
    assert get(connection, "/set/pos") == (200, "ok echo (set pos)\r\n")
    status, body = get(connection, "/broken")
    assert status == 500
    assert "defect" not in body
    assert "defect" in caplog.text
    echo.on_page(None)
    assert "<h1>/echo</h1>" in get(connection, "/")[1]
    connection.close()


def test_pages_are_read_and_framed_by_few(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "http://dash:8080")
    with yarpy.Port("/p", names=names) as port:
        port.on_page(shown)
        connection = client(port)
        connection.request("GET", "/", headers={"Origin": "http://evil.test"})
        response = connection.getresponse()
        assert response.status == 403
        assert b'YARPY_WEB_ORIGINS="http://dash:8080 http://evil.test"' in response.read()
        connection.request("GET", "/", headers={"Origin": "http://dash:8080"})
        response = connection.getresponse()
        assert (response.status, response.read()) == (200, b"<h1>mine</h1>")
        assert response.getheader("Access-Control-Allow-Origin") == "http://dash:8080"
        assert response.getheader("Vary") == "Origin"
        connection.request("GET", "/")
        response = connection.getresponse()
        assert (response.status, response.read()) == (200, b"<h1>mine</h1>")
        assert response.getheader("Access-Control-Allow-Origin") is None
        assert response.getheader("Cross-Origin-Resource-Policy") == "same-origin"
        policy = response.getheader("Content-Security-Policy")
        assert policy == "frame-ancestors 'self' http://dash:8080"
        connection.close()


def test_an_address_that_is_typed_in_may_ask(echo: yarpy.RpcServer) -> None:
    """Over plain HTTP a browser says nothing that would tell it from a hidden page."""
    connection = client(echo)
    typed = {"User-Agent": "Mozilla/5.0", "Accept": "text/html", "Host": "192.168.1.2:10002"}
    for target, status in (("/?req=get+encs", 200), ("/?data=help", 200), ("/?req=set+pos", 403)):
        connection.request("GET", target, headers=typed)
        response = connection.getresponse()
        said = response.read()
        assert response.status == status, target
    assert b"YARPY_WEB_ORIGINS=null" in said
    connection.close()


def test_pictures_on_a_connection_that_was_used_for_a_page(names: LocalNames) -> None:
    """Browsers ask again on the connection they have."""
    with yarpy.BufferedPort("/cam", names=names) as port:
        connection = client(port)
        assert "<h1>/cam</h1>" in get(connection, "/")[1]
        connection.request("GET", "/?action=stream&quality=20")
        response = connection.getresponse()
        assert response.getheader("Content-Type", "").startswith("multipart/x-mixed-replace")
        assert port.wait_for_outputs(1, HANG)
        wait_until(lambda: not port.inputs)
        (link,) = port.outputs
        assert (link.target, link.carrier) == ("null", "mjpeg+quality.20")
        assert port.write(yarpy.Image(np.zeros((8, 8, 3), "u1"))) == 1
        assert response.readline() == b"--boundarydonotcross\r\n"
        assert response.readline() == b"Content-Type: image/jpeg\r\n"
        response.close()
        connection.close()
        wait_until(lambda: not port.outputs)


def test_one_picture(names: LocalNames) -> None:
    with yarpy.BufferedPort("/cam", names=names) as port:
        connection = client(port)
        connection.request("GET", "/?action=snapshot", headers={"User-Agent": "curl/8"})
        assert port.wait_for_outputs(1, HANG)
        port.write(yarpy.Image(np.zeros((8, 8, 3), "u1")))
        response = connection.getresponse()
        assert (response.status, response.getheader("Content-Type")) == (200, "image/jpeg")
        assert response.read().startswith(b"\xff\xd8")
        wait_until(lambda: port.write(yarpy.Image(np.zeros((8, 8, 3), "u1"))) == 0)
        wait_until(lambda: not port.outputs)
        assert get(client(port), "/?action=snapshot&quality=0")[0] == 400


# ---------------------------------------------------------------------------------- curl


def curl(*args: str) -> str:
    done = subprocess.run(
        [program("curl"), "-sS", "--noproxy", "*", *args],
        capture_output=True,
        text=True,
        timeout=20,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.peer("curl")
def test_curl(echo: yarpy.RpcServer) -> None:
    url = f"http://{echo.address}"
    assert curl(f"{url}/?req=get+encs") == '["ok", "echo", ["get", "encs"]]\n'
    assert curl(f"{url}/set/pos/0/45") == "ok echo (set pos 0 45)\n"
    assert "<pre>ok echo (1 2)" in curl("-d", "data=1 2", f"{url}/form")
    kind = "Content-Type: application/json"
    assert curl("-H", kind, "-d", '["a", 1]', f"{url}/form") == '["ok", "echo", ["a", 1]]\n'
    head = curl("-I", f"{url}/")
    assert head.startswith("HTTP/1.1 200 OK\n")
    assert curl("-o", "-", "-w", "%{http_code}", "-X", "DELETE", url).endswith("/form\n405")
    assert curl("--http1.0", f"{url}/?req=x") == '["ok", "echo", ["x"]]\n'
    options = curl("-i", "-X", "OPTIONS", "-H", f"Origin: {url}", f"{url}/form")
    assert options.startswith("HTTP/1.1 204 No Content\n")
    assert "Access-Control-Allow-Methods: GET, HEAD, POST\n" in options
    many = curl("-w", "new connections: %{num_connects}\n", *[f"{url}/?req=x"] * 4)
    assert [line[-1] for line in many.splitlines() if "new" in line] == ["1", "0", "0", "0"]
    large = f"X-Large: {'x' * 20_000}"
    assert curl("-o", "/dev/null", "-w", "%{http_code}", "-H", large, url) == "431"
    assert curl("-F", "file=@/etc/hostname", f"{url}/form").startswith("send application/x-www")


@pytest.mark.peer("curl")
def test_curl_with_a_large_body(echo: yarpy.RpcServer) -> None:
    """It asks first whether the body is welcome."""
    body = "(" + "1 " * 600_000 + ")"
    done = subprocess.run(
        [program("curl"), "-sS", "--noproxy", "*", "-H", "Content-Type: text/plain",
         "-H", "Expect: 100-continue", "--data-binary", "@-", f"http://{echo.address}/form"],
        input=body, capture_output=True, text=True, timeout=HANG,
    )  # fmt: skip
    assert done.stdout.startswith("ok echo ((1 1 1 ")


@pytest.mark.peer("curl")
def test_curl_reads(names: LocalNames) -> None:
    with (
        yarpy.Port("/out", names=names) as port,
        subprocess.Popen(
            [program("curl"), "-sSN", "--noproxy", "*", f"http://{port.address}/r"],
            stdout=subprocess.PIPE,
        ) as process,
    ):
        assert port.wait_for_outputs(1, HANG)
        port.write(["hi", 3])
        port.close()
        assert process.communicate(timeout=HANG)[0] == b"hi 3\r\n"
