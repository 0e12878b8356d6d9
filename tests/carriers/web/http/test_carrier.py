"""http: requests that were recorded with C++ 3.9.1, the rules of HTTP/1.1, bad peers, readers.

Where our answers differ from those of C++ it is said at the test: ours have a status line, headers
and a length in every case, the connection stays open, and no argument comes twice.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager

import h11
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.capture import CAPTURES, load_capture
from support.steps import chop
from support.transport import ScriptTransport

import yarpy
from yarpy import registry
from yarpy.carriers.base import Carrier
from yarpy.carriers.web.http.carrier import TIME, Http
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LinkClosed, YarpError
from yarpy.link.begin.greeting import driver_of
from yarpy.link.begin.handshake import recognise
from yarpy.link.receive.inbound import Inbound
from yarpy.route import Route
from yarpy.testing import CarrierConformance
from yarpy.wire.effects import Claim, May, Show, Within
from yarpy.wire.message import Lines, Message, Packet
from yarpy.wire.stream import ByteStream, run


class TestHttp(CarrierConformance):
    carrier = Http
    names_sender = False


# ---------------------------------------------------------------------------------- a port


class Owner:
    """A port that answers as the echo server of the captures did."""

    name = "/cap/srv"

    def __init__(self, answer: object = None) -> None:
        self.answer = answer
        self.heard: list[Message] = []
        self.reversed: list[Inbound] = []
        self.ended: list[tuple[str, bool]] = []

    def receive(self, link: Inbound, message: Message) -> None:
        self.heard.append(message)
        if not message.wants_reply or self.answer is False:
            return
        value = message.value
        message.reply(["ok", "echo", value] if self.answer is None else self.answer)

    def administer(self, link: Inbound, message: Message) -> Bottle:
        self.heard.append(message)
        return Bottle([Vocab("ver"), 1, 2, 3])

    def command(self, link: Inbound, message: Message) -> list[str]:
        return [f"you said {message.key}{message.text}", "<b>"]

    def reverse(self, link: Inbound) -> None:
        self.reversed.append(link)

    def input_ended(self, link: Inbound, reason: str, quit_: bool) -> None:
        self.ended.append((reason, quit_))


def serve(
    *pieces: bytes, answer: object = None, name: str = "/cap/srv", host: str = ""
) -> tuple[Owner, bytes]:
    """What a port says to a peer that says `pieces` and hangs up. `host`: where it was reached."""
    transport = ScriptTransport(pieces)
    driver = driver_of(transport)
    driver.eager = False
    carrier = Http(Route("", name, "http", 0, host))
    owner = Owner(answer)
    try:
        first = bytes(driver.run(driver.stream.read_exact(8)))
        driver.run(carrier.welcome(driver.stream, first))
    except LinkClosed:
        return owner, transport.said
    Inbound(owner, driver, carrier).serve()
    return owner, transport.said


def responses(said: bytes, *methods: str) -> list[tuple[int, dict[str, str], bytes]]:
    """The responses in what a port said, read by h11 as a client of these requests."""
    found = []
    for method in methods:
        client = h11.Connection(h11.CLIENT)
        client.send(h11.Request(method=method, target="/", headers=[("Host", "x")]))
        client.send(h11.EndOfMessage())
        client.receive_data(said)
        head = client.next_event()
        while isinstance(head, h11.InformationalResponse):
            head = client.next_event()
        assert isinstance(head, h11.Response), head
        body = b""
        while isinstance(event := client.next_event(), h11.Data):
            body += event.data
        assert isinstance(event, h11.EndOfMessage), event
        said = client.trailing_data[0]
        headers = {name.decode(): value.decode() for name, value in head.headers}
        found.append((head.status_code, headers, body))
    assert not said, f"more was said: {said!r}"
    return found


def ask(request: bytes, answer: object = None) -> tuple[int, dict[str, str], bytes]:
    method = request.partition(b" ")[0].decode()
    return responses(serve(request, answer=answer)[1], method)[0]


def get(
    target: str, *headers: str, answer: object = None, method: str = "GET"
) -> tuple[int, dict[str, str], bytes]:
    lines = [f"{method} {target} HTTP/1.1", "Host: x:1", *headers, "", ""]
    return ask("\r\n".join(lines).encode(), answer)


def post(
    body: bytes, kind: str = "", *headers: str, target: str = "/form", answer: object = None
) -> tuple[int, dict[str, str], bytes]:
    lines = [f"POST {target} HTTP/1.1", "Host: x", f"Content-Length: {len(body)}", *headers]
    if kind:
        lines.append(f"Content-Type: {kind}")
    return ask("\r\n".join([*lines, "", ""]).encode() + body, answer)


# ---------------------------------------------------------------------------------- captures


def recorded(name: str) -> tuple[bytes, bytes]:
    capture = load_capture(name)
    return capture.said("a"), capture.said("b")


@pytest.mark.parametrize(
    "name",
    ["http_port_admin_req", "http_port_req_list", "http_mc_get_encs", "http_ns_req_query_unknown"],
)
@pytest.mark.parametrize("piece", [0, 1, 7])
def test_json_answers_as_recorded(name: str, piece: int) -> None:
    """The same JSON value; with CR LF and a length, and without the arguments of the request."""
    request, answer = recorded(name)
    theirs = json.loads(answer.partition(b"\n\n")[2])
    assert b"Access-Control-Allow-Origin: *\n" in answer
    given_: object = theirs if "echo" not in theirs else None
    owner, said = serve(*chop(request, piece), answer=given_)
    status, headers, body = responses(said, "GET")[0]
    assert status == 200
    assert headers["content-type"] == "application/json"
    assert headers["access-control-allow-origin"] == "*"
    ours = json.loads(body)
    if given_ is None:
        theirs[2] = [item for item in theirs[2] if not isinstance(item, list) or item[0] in "ab"]
    assert ours == theirs
    assert len(owner.heard) == 1
    assert owner.heard[0].source == "web"


HTML = [
    # capture, what the port's owner answers; the lines of the answer appear on the page
    ("http_port_data", None),
    ("http_port_data_var", None),
    ("http_port_data_help", None),
    ("http_post_form", None),
    ("http_mc_html_get_encs", None),
    ("http_in_data", False),
    ("http_ns_root_10", None),
    ("http_lf_only", None),
    ("http_port_cmd", None),
    ("http_port_help", None),
]


@pytest.mark.parametrize(("name", "answer"), HTML)
@pytest.mark.parametrize("piece", [0, 1])
def test_pages_are_asked_for_as_recorded(name: str, answer: object, piece: int) -> None:
    """The page is another one, but has the port's name, the same links, form and value."""
    request, theirs = recorded(name)
    _, said = serve(*chop(request, piece), answer=answer)
    status, headers, body = responses(said, request.partition(b" ")[0].decode())[0]
    assert status == 200
    assert headers["content-type"].startswith("text/html")
    assert b"<h1>/cap/srv</h1>" in body
    for link in (b'"/*"', b'"/data=help"', b'"/r"'):
        assert b"<a href=" + link in body
    shown = re.search(rb'name=data value="([^"]*)"', theirs)
    assert shown is not None
    assert b'name="data" value="' + shown[1] + b'"' in body
    said_there = theirs.rpartition(b"<pre>\n\r\n")[2].strip()
    if said_there.startswith(b"[ok] echo"):
        assert said_there.removeprefix(b"[ok] ").replace(b'"', b"&quot;") in body


@pytest.mark.parametrize("name", ["query", "outer_dict", "outer_list"])
def test_outer_form_as_recorded(name: str) -> None:
    request, answer = recorded(f"http_ns_req_{name}")
    port = '(name "/cap/srv") (ip "127.0.0.1") (port_number 21602) (carrier tcp)'
    _, said = serve(request, answer=Bottle.from_text(f"port {port}"))
    body = responses(said, "GET")[0][2]
    assert body.strip() == answer.partition(b"\n\n")[2].strip()


def test_paths_are_messages_as_recorded() -> None:
    """C++ answers without status line, and repeats the arguments."""
    paths = ("http_port_path", "foo bar 3"), ("http_port_path_query", "foo bar")
    for name, words in (*paths, ("api_style_http_1", "cap srv")):
        request, theirs = recorded(name)
        owner, said = serve(request)
        status, headers, body = responses(said, "GET")[0]
        assert (status, headers["content-type"]) == (200, "text/plain; charset=utf-8")
        assert body == f"ok echo ({words})\r\n".encode()
        assert theirs.startswith(f"[ok] echo ({words} (REQUEST_URI".encode())
        assert owner.heard[0].value == words.replace("3", "").split() + [3] * ("3" in words)


DIFFERENT = [
    # what C++ answers with "protocol not found", with silence, or with a mistake of its own
    ("http_head", 200),
    ("http_bad_method", 405),
    ("http_favicon", 204),
    ("http_post_form_json", 200),
    ("http_port_admin", 200),
    ("http_get_short", 400),
]


@pytest.mark.parametrize(("name", "status"), DIFFERENT)
def test_answers_where_cpp_has_none(name: str, status: int) -> None:
    request, _ = recorded(name)
    found = responses(serve(request)[1], request.partition(b" ")[0].decode())
    assert [item[0] for item in found] == [status]


NOT_HERE = ("http_read_stream", "http_get_no_headers_end", "http_post_other")
STATUS = dict(DIFFERENT)


@pytest.mark.parametrize(
    "name",
    sorted(p.stem for p in CAPTURES.glob("http_*.json") if p.stem not in NOT_HERE),
)
@pytest.mark.parametrize("piece", [0, 1])
def test_every_recorded_request_is_answered_properly(name: str, piece: int) -> None:
    """Valid HTTP, of the kind that C++ would have meant; and JSON that is JSON."""
    request, theirs = recorded(name)
    _, said = serve(*chop(request, piece))
    ((status, headers, body),) = responses(said, request.partition(b" ")[0].decode())
    assert status == STATUS.get(name, 200)
    if b"Content-Type: application/json" in theirs:
        json.loads(body)
    if status == 200 and b"Content-Type: " in theirs and name not in ("http_post_form_json",):
        kind = theirs.partition(b"Content-Type: ")[2].split()[0].decode()
        assert headers["content-type"].startswith(kind) or name == "http_ns_web_missing"


def test_unfinished_head_is_waited_for() -> None:
    request, _ = recorded("http_get_no_headers_end")
    assert serve(request)[1] == b""


def test_stream_as_recorded() -> None:
    """The same chunks for the messages; the page comes to browsers only."""
    request, theirs = recorded("http_read_stream")
    owner, said = serve(request)
    (link,) = owner.reversed
    assert b"transfer-encoding: chunked" in said.lower()
    for value in ([1, "ping", 3.14], ["hello", "two words"]):
        chunk = streamed(link.carrier, value)
        assert chunk in theirs
        assert chunk.partition(b"\r\n")[0] == b"%x" % (len(chunk.split(b"\r\n")[1]) + 2)


def streamed(carrier: Carrier, value: object, envelope: bytes = b"") -> bytes:
    stream = ByteStream()
    packet = Packet(value, envelope)
    assert carrier.prepare(packet)
    carrier.encode(stream, packet)
    return b"".join(map(bytes, stream.take_output()))


# ---------------------------------------------------------------------------------- answers


def test_port_that_says_nothing_still_answers() -> None:
    """C++ says for ever that it did not understand (the capture ends after 11 MB)."""
    request, theirs = recorded("http_in_req")
    assert theirs.count(b"not understood") > 20
    assert responses(serve(request, answer=False)[1], "GET")[0][::2] == (200, b"[]\n")
    assert get("/a/b", answer=False)[0] == 204
    assert get("/?req=x&format=none", answer=False)[0] == 204
    assert b"(no reply)" in get("/?data=x", answer=False)[2]


def test_answers_in_every_form() -> None:
    assert get("/?req=a+1&format=text")[2] == b"ok echo (a 1)\r\n"
    assert get("/?req=a+1&format=html")[1]["content-type"].startswith("text/plain")
    assert get("/", "Accept: application/json")[2] == b'["you said *page", "<b>"]\n'
    assert b"<pre>you said *page\n&lt;b&gt;\n</pre>" in get("/")[2]
    assert get("/?cmd=*&format=text")[2] == b"you said *page\r\n<b>\r\n"
    assert get("/?req=x", answer=Lines(["one", "two"]))[2] == b'["one", "two"]\n'
    assert get("/a/b", answer=Lines(["one", "two"]))[2] == b"one\r\ntwo\r\n"
    assert get("/?req=x", answer=7)[2] == b"7\n"
    assert post(b'["a", 1]', "application/json")[2] == b'["ok", "echo", ["a", 1]]\n'
    assert post(b"a 1", "text/plain")[2] == b"ok echo (a 1)\r\n"


def test_page_that_a_program_made() -> None:
    """As in C++, but its scripts do not run as those of the port's own pages."""
    answer = [["web", "<b>hi</b>"], ["mime", "text/html"]]
    status, headers, body = get("/a/page", answer=answer)
    assert (status, headers["content-type"], body) == (200, "text/html", b"<b>hi</b>")
    assert headers["content-security-policy"].startswith("sandbox")
    assert get("/a/page", "Accept: text/html", answer=answer)[2] == b"<b>hi</b>"
    assert get("/?data=page", answer=answer)[2] == b"<b>hi</b>"
    assert json.loads(get("/?req=x", answer=answer)[2]) == {"web": "<b>hi</b>", "mime": "text/html"}
    evil = [["web", "x"], ["mime", "text/html\r\nEvil: 1"]]
    assert "evil" not in get("/a/page", answer=evil)[1]


@pytest.mark.parametrize("piece", [0, 1])
def test_reply_that_begins_a_stream(piece: int) -> None:
    """The connection is turned round, each later message of the port is a chunk."""
    answer = [["stream", 1], ["web", "<p>one</p>"]]
    request = b"GET /my/stream HTTP/1.1\r\nHost: x\r\n\r\n"
    owner, said = serve(*chop(request, piece), answer=answer)
    (link,) = owner.reversed
    head, _, body = said.partition(b"\r\n\r\n")
    assert b"transfer-encoding: chunked" in head.lower()
    assert b"content-type: text/html" in head.lower()
    assert b"sandbox" in head
    size, _, rest = body.partition(b"\r\n")
    assert rest[: int(size, 16)] == b" " * 2048 + b"<p>one</p>"
    assert streamed(link.carrier, [["web", b"<p>two</p>"]]) == b"a\r\n<p>two</p>\r\n"
    assert streamed(link.carrier, ["hi", 3]) == b"6\r\nhi 3\r\n\r\n"
    # For JSON it is a reply like any other.
    owner, said = serve(request.replace(b"/my/stream", b"/?req=stream"), answer=answer)
    assert not owner.reversed
    assert json.loads(responses(said, "GET")[0][2]) == {"stream": 1, "web": "<p>one</p>"}


def test_nothing_of_a_message_is_markup() -> None:
    script = "<script>alert(1)</script>"
    _, said = serve(
        b"GET /?data=%22%3Cscript%3Ealert(1)%3C/script%3E%22 HTTP/1.0\r\n\r\n", name="/" + script
    )
    assert said.count(b"<script") == 1  # ours
    assert said.count(b"&lt;script&gt;") == 4
    _, headers, _ = get("/a/%3Cscript%3E")
    assert headers["content-type"].startswith("text/plain")
    assert headers["x-content-type-options"] == "nosniff"


def test_answer_that_cannot_be_sent(caplog: pytest.LogCaptureFixture) -> None:
    status, _, body = get("/?req=x", answer=[object()])
    assert (status, body) == (500, b"the port's answer cannot be sent\n")


def test_envelope_of_a_post() -> None:
    owner, _ = serve(
        b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\n"
        b"Yarp-Envelope: 7 1.25\r\nContent-Length: 1\r\n\r\n5"
    )
    assert owner.heard[0].envelope == "7 1.25"


# ---------------------------------------------------------------------------------- HTTP/1.1

ONE = b"GET /?req=one HTTP/1.1\r\nHost: x\r\n\r\n"


@pytest.mark.parametrize("piece", [0, 1, 40])
def test_connection_stays_open(piece: int) -> None:
    wire = ONE + b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Length: 7\r\n\r\nreq=two" + ONE
    owner, said = serve(*chop(wire, piece))
    found = responses(said, "GET", "POST", "GET")
    assert [body for _, _, body in found] == [
        b'["ok", "echo", ["%s"]]\n' % w for w in (b"one", b"two", b"one")
    ]
    assert owner.ended == [("the peer closed the connection", False)]


def test_requests_in_a_burst_are_answered_one_by_one() -> None:
    """Also those that nobody replies to: the answers keep their order."""
    owner, said = serve(ONE * 100, answer=False)
    assert len(responses(said, *["GET"] * 100)) == 100
    assert len(owner.heard) == 100


def test_request_has_limited_time_from_its_first_byte_to_its_last() -> None:
    carrier, stream = Http(Route("", "/x", "http")), ByteStream()
    wire = b"GET /favicon.ico HTTP/1.1\r\nHost: x\r\n\r\n"
    stream.feed(wire)
    steps = carrier.decode(stream)
    asked = list(iter(lambda: next(steps), None))
    assert asked == [
        *(Within(TIME), Within(None), Claim("")),
        *(May("read", asking=True), Show("/favicon.ico", {})),
    ]
    assert stream.pending  # answered without the port; waits for another
    stream.feed(b"G")
    assert next(steps) == Within(TIME)


def test_end_when_the_peer_wants_it() -> None:
    for head in (b"GET /?req=one HTTP/1.0\r\n\r\n", ONE[:-2] + b"Connection: close\r\n\r\n"):
        owner, said = serve(head + ONE)
        assert len(owner.heard) == 1
        assert owner.ended == [("", True)]
        assert responses(said, "GET")[0][1]["connection"] == "close"


def test_head_has_the_length_and_changes_nothing() -> None:
    status, headers, body = get("/", method="HEAD")
    assert (status, body) == (200, b"")
    assert int(headers["content-length"]) == len(get("/")[2])
    owner, said = serve(
        b"HEAD /?req=x HTTP/1.1\r\nHost: x\r\n\r\n" + b"HEAD /r HTTP/1.1\r\nHost: x\r\n\r\n"
    )
    assert [item[0] for item in responses(said, "HEAD", "HEAD")] == [200, 200]
    assert not owner.heard
    assert not owner.reversed


def test_preflight() -> None:
    status, headers, _ = get("/form", "Origin: http://x:1", method="OPTIONS")
    assert status == 204
    assert headers["access-control-allow-origin"] == "*"
    assert "POST" in headers["access-control-allow-methods"]
    assert "Content-Type" in headers["access-control-allow-headers"]
    assert get("*", method="OPTIONS")[0] == 204


def test_methods_that_ports_do_not_have() -> None:
    for method in ("PUT", "DELETE", "PATCH"):
        status, headers, body = get("/", method=method)
        assert status == 405
        assert b"GET, HEAD, POST and OPTIONS" in body
        assert headers["allow"] == "GET, HEAD, POST, OPTIONS"


def test_mistakes_in_a_request_leave_the_connection_open() -> None:
    wire = b"POST /x HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\nxx" + ONE
    assert [item[0] for item in responses(serve(wire)[1], "POST", "GET")] == [404, 200]
    body = b"{"
    assert post(body, "application/json")[0] == 400
    assert post(b"--x", "multipart/form-data; boundary=x")[0] == 415


@given(
    st.lists(st.tuples(st.integers(0, 200), st.binary(max_size=4), st.integers(0, 3)), max_size=4),
    st.integers(0, 3),
)
def test_damaged_requests_are_answered_or_end_the_connection(
    changes: list[tuple[int, bytes, int]], piece: int
) -> None:
    wire = bytearray(
        ONE + b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Length: 7\r\n\r\nreq=two" + ONE
    )
    for at, data, cut in changes:
        wire[at : at + cut] = data
    if not Http.recognises(bytes(wire[:8])):
        return
    carrier, stream = Http(Route("", "/x", "http")), ByteStream()
    feeds = iter(chop(bytes(wire), piece))

    def talk() -> Iterator[None]:
        yield from carrier.welcome(stream, bytes((yield from stream.read_exact(8))))
        while (message := (yield from carrier.decode(stream))).key != "q":
            if message.key == "r":
                return
            carrier.encode_reply(stream, message.value)

    try:
        run(talk(), stream, feeds)  # type: ignore[arg-type]
    except YarpError:
        pass


# ---------------------------------------------------------------------------------- readers


def reader(request: bytes) -> tuple[Carrier, bytes]:
    owner, said = serve(request)
    return owner.reversed[0].carrier, said


def test_events_for_javascript() -> None:
    for head in (
        b"GET /r?sse HTTP/1.1\r\nHost: x\r\n\r\n",
        b"GET /r HTTP/1.1\r\nHost: x\r\nAccept: text/event-stream\r\n\r\n",
    ):
        carrier, said = reader(head)
        assert b"Content-Type: text/event-stream\r\n" in said
        assert b"Access-Control-Allow-Origin: *\r\n" in said
        body = b'id: 7 1.25\ndata: ["hi", "two\\nlines"]\n\n'
        assert streamed(carrier, ["hi", "two\nlines"], b"7 1.25") == b"%x\r\n%s\r\n" % (
            len(body),
            body,
        )
        assert b'\ndata: {"a": 1}\n\n' in b"\n" + streamed(carrier, {"a": 1}).partition(b"\r\n")[2]


def test_page_of_messages_asks_for_them_itself() -> None:
    for target in ("/r", "/?cmd=r"):
        _, said = serve(f"GET {target} HTTP/1.1\r\nHost: x\r\nAccept: text/html\r\n\r\n".encode())
        status, headers, body = responses(said, "GET")[0]
        assert (status, headers["content-type"]) == (200, "text/html; charset=utf-8")
        assert b'<ol id="messages">' in body
        assert "script-src 'self';" in headers["content-security-policy"]


def test_how_often_a_reader_wants_messages() -> None:
    carrier, _ = reader(b"GET /r?sse&rate=20 HTTP/1.1\r\nHost: x\r\n\r\n")
    assert carrier.delivery.interval == 0.05
    for rate in ("0", "-1", "x", "1e9"):
        _, said = serve(f"GET /r?sse&rate={rate} HTTP/1.1\r\nHost: x\r\n\r\n".encode())
        [(status, _, body)] = responses(said, "GET")
        assert (status, body.startswith(b"rate must be a number from")) == (400, True)


def test_lines_of_json() -> None:
    carrier, said = reader(b"GET /r?format=json HTTP/1.0\r\n\r\n")
    assert b"chunked" not in said
    assert streamed(carrier, [1, 2]) == b"[1, 2]\n"


def test_pictures_are_told_of_and_sent_whole_to_who_asks() -> None:
    picture = yarpy.Image(np.zeros((48, 64, 3), "u1"))
    for options, longest in (("sse", 200), ("format=json", 200), ("sse&pixels", 20_000)):
        carrier, _ = reader(f"GET /r?{options} HTTP/1.1\r\nHost: x\r\n\r\n".encode())
        said = streamed(carrier, picture)
        assert b'"type": "image", "width": 64, "height": 48, "pixel": "rgb"' in said
        assert len(said) < longest
        assert (b"base64" in said) == (longest > 200)


def test_readers_miss_messages_rather_than_hold_the_writer_up() -> None:
    carrier, _ = reader(b"GET /r HTTP/1.1\r\nHost: x\r\n\r\n")
    assert carrier.delivery.lossy
    assert not carrier.acks
    assert carrier.delivery.backlog


def test_stream_ends_in_good_order() -> None:
    carrier, _ = reader(b"GET /r HTTP/1.1\r\nHost: x\r\n\r\n")
    stream = ByteStream()
    carrier.encode_quit(stream)
    assert b"".join(map(bytes, stream.take_output())) == b"0\r\n\r\n"


# ---------------------------------------------------------------------------------- who is it


@pytest.mark.parametrize(
    ("first", "ours"),
    [
        (b"GET / HT", True),
        (b"GET /?re", True),
        (b"POST /fo", True),
        (b"POST / H", True),
        (b"HEAD / H", True),
        (b"OPTIONS ", True),
        (b"POST /RP", False),
        (b"GETTING ", False),
    ],
)
def test_first_bytes(first: bytes, ours: bool) -> None:
    assert (Http.recognises(first) > 0) == ours
    if ours:
        # xmlrpc looks at a POST to `/` first, and hands over what is no XML.
        others = [carrier for carrier in registry.carriers if carrier.name != "xmlrpc"]
        assert recognise(first, [*others, Http]) is Http


class Camera(Carrier):
    """Somebody with a longer magic."""

    name = "camera"
    magic = b"GET /?ac"


def test_longer_magic_wins() -> None:
    assert recognise(b"GET /?ac", [Http, Camera]) is Camera


@contextmanager
def setting(monkeypatch: pytest.MonkeyPatch, text: str) -> Iterator[None]:
    with monkeypatch.context() as patch:
        patch.setenv("YARPY_WEB_ORIGINS", text)
        yield


@pytest.mark.parametrize("text", ["", "none", "http://good"])
def test_other_pages_may_not_act(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    with setting(monkeypatch, text):
        evil = "Origin: http://evil"
        for target in ("/?req=x", "/?data=x", "/set/pos", "/?cmd=/there", "/?admin=1&req=ver"):
            assert get(target, evil)[0] == 403, target
        for target in ("/", "/?", "/?cmd=*"):
            status, headers, _ = get(target, evil)  # a computer of this network, by its name
            assert (status, headers["access-control-allow-origin"]) == (200, "*")
            assert get(target, "Origin: http://evil.test")[0] == 403
        assert "frame-ancestors 'self'" in get("/")[1]["content-security-policy"]
        assert get("/?req=x")[0] == 200
        assert get("/?req=x", "Origin: http://x:1")[0] == 200
        preflight = get("/form", evil, method="OPTIONS")[1]
        assert preflight["access-control-allow-methods"] == "GET, HEAD"


def test_name_of_another_is_turned_away_on_the_loopback() -> None:
    """A site may let its name point to this computer (DNS rebinding)."""
    for host, reached, status in (
        ("evil.test:1", "127.0.0.1", 421),
        ("evil.test:1", "10.0.0.1", 200),
        ("127.0.0.1:1", "127.0.0.1", 200),
        ("localhost", "127.0.0.1", 200),
    ):
        request = f"GET /?req=x HTTP/1.1\r\nHost: {host}\r\n\r\n".encode()  # no browser
        owner, said = serve(request, host=reached)
        assert said.startswith(b"HTTP/1.1 %d " % status), (host, reached)
        assert bool(owner.heard) == (status == 200)
        assert (b"not known as evil.test" in said) == (status == 421)
