"""What requests mean: the URLs of C++ 3.9.1, without what it adds to them; bodies; mistakes."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.steps import measured

from yarpy.carriers.web.http.argument import substitute
from yarpy.carriers.web.http.intent import Intent, Refusal, Request
from yarpy.carriers.web.http.request import page_asked, read_intent
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.limit import HTTP_FIELDS

HTML = "text/html,application/xhtml+xml,*/*;q=0.8"


def intent(target: str, accept: str = "*/*", method: str = "GET") -> Intent:
    found = read_intent(Request(method, target, {"accept": accept}))
    assert isinstance(found, Intent), found
    return found


def posted(body: str, kind: str = "", target: str = "/form") -> Intent | Refusal:
    headers = {"content-type": kind} if kind else {}
    return read_intent(Request("POST", target, headers, body.encode()))


MESSAGES = [
    # target, key, what the port's owner gets, form of the answer
    ("/w?data=hello+1+2.5", "d", "hello 1 2.5", "page"),
    ("/?data=1+ping+3.14", "d", "1 ping 3.14", "page"),
    ("/data=help", "d", "help", "page"),
    ("/?req=hello", "d", "hello", "json"),
    ("/?req=hello+$x+$y&x=1&y=2+3", "d", "hello 1 2 3", "json"),
    ("/?req=query+$port&port=/x", "d", "query /x", "json"),
    ("/?req=query+$port&port=%2Fx%2By", "d", "query /x+y", "json"),
    ("/?req=a$none+b", "d", "a b", "json"),
    ("/?data=set+$a+$b&a=5&b=x%20y", "d", "set 5 x y", "page"),
    ("/?req=(a+1)+(b+2.5)+[set]", "d", "(a 1) (b 2.5) [set]", "json"),
    ("/?req=%5Bset%5D+%5Bpos%5D+0+3.5", "d", "[set] [pos] 0 3.5", "json"),
    ("/?req=x&format=html", "d", "x", "text"),
    ("/?req=x&format=text", "d", "x", "text"),
    ("/?req=x&format=none", "D", "x", "none"),
    ("/?data=x&format=json", "d", "x", "json"),
    ("/?admin=1&req=ver", "a", "ver", "json"),
    ("/?admin=1&data=%5Blist%5D+%5Bin%5D", "a", "[list] [in]", "page"),
    ("/foo/bar/3", "d", "foo bar 3", "text"),
    ("/foo/bar?x=1&y=two", "d", "foo bar", "text"),
    ("/set/$j/5?j=2", "d", "set 2 5", "text"),
    ("/?cmd=d%0ahello+there", "d", "hello there", "page"),
    ("/?cmd=a%0aver", "a", "ver", "page"),
    ("/?req=%FC+%zz", "d", '"\\udcfc" "%zz"', "json"),
    ("http://10.0.0.1:80/?req=x", "d", "x", "json"),
    ("/?req=a=b", "d", "a=b", "json"),
]


@pytest.mark.parametrize(("target", "key", "text", "form"), MESSAGES)
def test_messages(target: str, key: str, text: str, form: str) -> None:
    found = intent(target)
    assert (found.key, found.form, found.acts) == (key, form, True)
    expected = Bottle.from_text(text.replace("\\udcfc", "\udcfc"))
    assert found.message().value == expected


COMMANDS = [
    ("/", "*", "page"),
    ("/*", "*", "page"),
    ("/form", "*", "page"),
    ("/?", "?", "page"),
    ("/?x=1", "?", "page"),
    ("/?cmd=*", "*", "page"),
    ("/?cmd=%3F", "?", "page"),
    ("/r", "r", "text"),
    ("/r?sse", "r", "events"),
    ("/r?format=json", "r", "json"),
    ("/r?format=html", "r", "page"),
]


@pytest.mark.parametrize(("target", "key", "form"), COMMANDS)
def test_port_commands(target: str, key: str, form: str) -> None:
    found = intent(target)
    assert (found.key, found.form, found.acts) == (key, form, False)
    assert found.text == ("page" if key == "*" else "")


def test_commands_that_connect() -> None:
    found = intent("/?cmd=/dest")
    assert (found.key, found.text, found.acts) == ("/", "dest", True)


ACCEPTING = [
    ("/", "application/json", "json"),
    ("/", HTML, "page"),
    ("/?data=x", "application/json", "json"),
    ("/?data=x", HTML + ",application/json", "page"),
    ("/foo/bar", HTML, "page"),
    ("/foo/bar", "application/json", "json"),
    ("/?req=x", HTML, "json"),
    ("/r", HTML, "page"),
    ("/r", "text/event-stream", "events"),
]


@pytest.mark.parametrize(("target", "accept", "form"), ACCEPTING)
def test_answers_suit_who_asks(target: str, accept: str, form: str) -> None:
    assert intent(target, accept).form == form


def test_outer_form() -> None:
    assert intent("/?req=x&outer=dict").outer == "dict"
    assert intent("/?req=x&outer=list").outer == "list"
    assert intent("/?req=x&outer=tree").outer == "auto"


BODIES = [
    # content type, body, what the port's owner gets, form of the answer
    ("", "data=1+ping+%22a+b%22", '1 ping "a b"', "page"),
    ("application/x-www-form-urlencoded; charset=utf-8", "data=hello+%24x&x=7", "hello 7", "page"),
    ("application/x-www-form-urlencoded", "req=what?+really", "what? really", "json"),
    ("text/plain", "set $x (1 2)\n", 'set "$x" (1 2)', "text"),
    ("application/json", '["set", 1, "2 3"]', 'set 1 "2 3"', "json"),
    ("application/json", '{"a": 1}', "(a 1)", "json"),
    ("application/json", '"two words"', '"two words"', "json"),
    ("application/json", '{"data": [1, 2]}', "1 2", "json"),
    ("application/json", '{"req": "set $j 5", "j": 2}', "set 2 5", "json"),
    ("application/json", '{"data": "x", "format": "text"}', "x", "text"),
]


@pytest.mark.parametrize(("kind", "body", "text", "form"), BODIES)
def test_bodies(kind: str, body: str, text: str, form: str) -> None:
    found = posted(body, kind)
    assert isinstance(found, Intent), found
    assert (found.key, found.form) == ("d", form)
    assert found.message().value == Bottle.from_text(text)


def test_json_body_keeps_kinds() -> None:
    found = posted('["1", 1, true, null]', "application/json")
    assert isinstance(found, Intent)
    assert found.message().value == ["1", 1, True, Vocab("null")]


def test_body_for_the_port_itself() -> None:
    found = posted('{"req": "ver", "admin": true}', "application/json")
    assert isinstance(found, Intent)
    assert found.key == "a"
    assert posted("") == intent("/", method="POST")


REFUSED = [
    (Request("POST", "/other", {}, b"data=1"), 404),
    (Request("POST", "/form", {"content-type": "multipart/form-data; boundary=x"}, b"--"), 415),
    (Request("POST", "/form", {"content-type": "application/json"}, b"{"), 400),
    (Request("POST", "/form", {"content-type": "application/json"}, b"[" * 100_000), 400),
    (Request("POST", "/form", {}, b"a=1&" * (HTTP_FIELDS + 1)), 400),
    (Request("POST", "/form", {}, b'["get", "encs"]'), 400),
    (Request("GET", "/favicon.ico", {}), 204),
    (Request("GET", "/web/main.css", {}), 200),
    (Request("GET", "/robots.txt", {}), 404),
    (Request("GET", "/.well-known/x", {}), 404),
    (Request("GET", "/q", {}), 404),
    (Request("GET", "/?cmd=q", {}), 404),
]


@pytest.mark.parametrize(("request_", "status"), REFUSED)
def test_refused(request_: Request, status: int) -> None:
    found = read_intent(request_)
    assert isinstance(found, Refusal)
    assert found.status == status


@given(
    st.sampled_from(["GET", "POST", "HEAD"]),
    st.text(st.characters(max_codepoint=255), max_size=40),
    st.sampled_from(["", "application/json", "text/plain", "image/png"]),
    st.binary(max_size=40),
)
def test_any_request_means_something(method: str, target: str, kind: str, body: bytes) -> None:
    headers = {"content-type": kind} if kind else {}
    found = read_intent(Request(method, "/" + target, headers, body))
    if isinstance(found, Intent):
        _ = found.message()
    else:
        assert 200 <= found.status < 500


@pytest.mark.parametrize(
    ("target", "asked"),
    [
        ("/", ("/", {})),
        ("/a/b.js", ("/a/b.js", {})),
        ("http://h:1/a%20b?x=1&y=a+b&z", ("/a b", {"x": "1", "y": "a b"})),
        ("/?x=1#y", ("/", {"x": "1"})),
        ("/*", None),
        ("/*/port.js", None),
        ("/r", None),
        ("/r?sse", None),
        ("/?", None),
        ("/data=help", None),
        ("/x?req=1", None),
        ("/x?data=1", None),
        ("/x?cmd=*", None),
        ("/x?" + "a=1&" * (HTTP_FIELDS + 1), None),
    ],
)
def test_what_programs_may_answer(target: str, asked: object) -> None:
    assert page_asked(Request("GET", target, {})) == asked
    assert page_asked(Request("HEAD", target, {})) == asked
    assert page_asked(Request("POST", target, {})) is None


def test_arguments_do_not_multiply() -> None:
    """Many short names that stand for one long argument: refused before the text is built."""
    many, long = "$a" * 20_000, "x" * 50_000
    body = json.dumps({"req": many, "a": long}).encode()
    for request in (
        Request("POST", "/form", {}, f"data={many}&a={long}".encode()),
        Request("POST", "/", {"content-type": "application/json"}, body),
        Request("GET", f"/?req={many[:4000]}&a={long[:8000]}", {}),
    ):
        with measured() as peak:
            refusal = read_intent(request)
        assert isinstance(refusal, Refusal) and refusal.status == 400
        assert peak.bytes < 1 << 24
    assert substitute("$a" * 1000, {"a": "x" * 1000}) == "x" * 1_000_000


def test_the_address_of_a_proxy_counts_only_at_the_beginning() -> None:
    intent = read_intent(Request("GET", "http://robot:10001/?req=see+http://elsewhere/", {}))
    assert isinstance(intent, Intent) and intent.payload == b"see http://elsewhere/"
