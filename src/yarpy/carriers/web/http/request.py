"""Read an HTTP request to a port: as a message, a port command, or a mistake.

    /?req=set+$joint+5&joint=2     a message, answered in JSON
    /?data=help   /data=help       a message, answered with the page
    /set/pos/0                     a message of the words of the path, answered as text
    /  /?  /r  /?cmd=...           the port itself: its connections, its help, reading, any command
    /*  /*/port.js                 always the port's own page, and the files that pages share

Rules: pure functions of method, target, headers and body. `$name` in `req` and `data` is replaced
by the argument of that name. Nothing else is added to a message, where C++ appends all arguments
again.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final

from yarpy import registry
from yarpy.carriers.base import PAGE
from yarpy.carriers.web.http.argument import decoded, number_of, read_fields, substitute
from yarpy.carriers.web.http.asset import KINDS, PREFIX, asset
from yarpy.carriers.web.http.intent import Content, Form, Intent, Refusal, Request
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.json import Outer, from_json
from yarpy.errors import DecodeError
from yarpy.wire import framing
from yarpy.wire.message import ADMIN, CALL, DATA

FORM: Final = "application/x-www-form-urlencoded"
_OWN: Final = (FORM, "text/plain", "application/json")
MAY: Final = "/*/may"  # what whoever asks may do, for pages that show it

_ABSOLUTE = re.compile(r"[A-Za-z][A-Za-z0-9+.\-]*+://[^/?#]*+")
# What browsers and crawlers request automatically; not a message to a robot.
_HABITS: Final = ("apple-touch-icon", ".well-known/", "robots.txt", "sitemap")
_SPELLINGS: Final[dict[str, Form]] = {
    "json": "json",
    "text": "text",
    "none": "none",
    "sse": "events",
    "events": "events",
}


def read_intent(request: Request) -> Intent | Refusal:
    """Return what a GET, HEAD or POST request asks for, or why it is refused."""
    try:
        return _read(request)
    except DecodeError as error:
        return Refusal(400, str(error))


def _read(request: Request) -> Intent | Refusal:
    path, mark, query = _parts(request.target)
    if not query and "=" in path:
        path, query = "", path  # `/data=list`
    fields = read_fields(query)
    if request.method == "POST":
        found = read_content(request)
        if found is not None:
            return found
        if path not in ("", "form"):
            return Refusal(404, "send POST requests to /form")
        return _posted(request, fields)
    if path.startswith(PREFIX):
        name = path.removeprefix(PREFIX)
        kind = KINDS.get(name)
        return Refusal(200, asset(name), kind) if kind else Refusal(404, "there is no such file")
    if path == "web/main.css":  # the pages of C++ ports get it from their name server
        return Refusal(200, asset("main.css"), "text/css")
    if path.startswith("favicon"):
        return Refusal(204)
    if path.startswith(_HABITS):
        return Refusal(404, "a port has no such path")
    if path == "r":
        return _reading(request, fields, query)
    if not fields.keys() & {"cmd", "req", "data"}:
        if path in ("", "form", "data"):
            key = "?" if mark and path == "" else "*"
            return Intent(key, _form(request, fields, "page"), text=PAGE if key == "*" else "")
        if len(path) == 1:
            return Intent("*", _form(request, fields, "page"), text=PAGE) if path == "*" else _one()
        words = decoded(path).replace("/", " ").strip()
        fields = {**fields, "data": words}
        default: Form = "page" if likes(request, "text/html") else "text"
        return _asked(request, fields, words, default)
    return _by_fields(request, fields)


def page_asked(request: Request) -> tuple[str, dict[str, str]] | None:
    """The path and arguments of a request that a program may answer with a page of its own."""
    path, mark, query = _parts(request.target)
    whole = path + mark + query
    if request.method not in ("GET", "HEAD") or whole == "?" or path == "r" or "=" in path:
        return None
    if path == "*" or path.startswith(PREFIX):
        return None
    try:
        fields = read_fields(query)
    except DecodeError:
        return None
    return None if fields.keys() & {"cmd", "req", "data"} else ("/" + decoded(path), fields)


# ---------------------------------------------------------------------------------- inside


def _parts(target: str) -> tuple[str, str, str]:
    """The path without its first slash, the question mark if there is one, and the query."""
    if (found := _ABSOLUTE.match(target)) is not None:
        target = target[found.end() :]
    return target.partition("#")[0].removeprefix("/").partition("?")


def _posted(request: Request, fields: dict[str, str]) -> Intent | Refusal:
    kind = request.headers.get("content-type", FORM).partition(";")[0].strip().lower()
    body = request.body
    if kind == FORM:
        fields |= read_fields(body.decode("utf-8", "surrogateescape").strip("\r\n"))
        if fields.keys() & {"cmd", "req", "data"}:
            return _by_fields(request, fields)
        if body.strip() and b"=" not in body:  # curl claims this type for any body
            return Refusal(
                400,
                f"the body is not {FORM}: for JSON or text give their Content-Type",
            )
        return Intent("*", _form(request, fields, "page"), text=PAGE)
    if kind == "text/plain":
        text = body.decode("utf-8", "surrogateescape")
        return _asked(request, fields, text, "text", substituting=False)
    if kind == "application/json":
        return _json(request, fields, from_json(body))
    return Refusal(415, f"send {FORM}, application/json or text/plain, not {kind[:80]}")


def read_content(request: Request) -> Intent | None:
    """Return what a body asks for that a plug-in reads; None: there is none for its kind."""
    kind = request.headers.get("content-type", FORM).partition(";")[0].strip().lower()
    if kind in _OWN or kind not in registry.contents.names():
        return None
    content: Content = registry.contents.load(kind)(request.body)
    return Intent(content.message.key, "none", content=content)


def _json(request: Request, fields: dict[str, str], value: Any) -> Intent | Refusal:
    """A JSON body: an array or object is the message; an object with `req` or `data` is read like a
    form.
    """
    import json

    form = _form(request, fields, "json")
    if not isinstance(value, Bottle):
        return _intent(fields, form, Bottle([value]))
    body = json.loads(request.body)
    if not isinstance(body, dict) or not body.keys() & {"cmd", "req", "data"}:
        return _intent(fields, form, value)
    asked: Any = None
    for key, item in body.items():
        if isinstance(item, str):
            fields[key] = item
        elif key in ("req", "data"):
            asked = from_json(json.dumps(item))
        elif isinstance(item, bool):
            if item:
                fields[key] = "1"
        elif isinstance(item, (int, float)):
            fields[key] = repr(item)
    form = _form(request, fields, "json")
    if asked is None:
        fields.setdefault("format", "json")
        return _by_fields(request, fields)
    return _intent(fields, form, asked if isinstance(asked, Bottle) else Bottle([asked]))


def _by_fields(request: Request, fields: dict[str, str]) -> Intent | Refusal:
    if "cmd" in fields:
        return _command(request, fields)
    if "req" in fields:
        return _asked(request, fields, fields["req"], "json", honest=True)
    return _asked(request, fields, fields["data"], "page")


def _asked(
    request: Request,
    fields: dict[str, str],
    text: str,
    default: Form,
    *,
    substituting: bool = True,
    honest: bool = False,
) -> Intent:
    """A message given as text. `honest`: only `format` can change the answer's form."""
    if substituting:
        text = substitute(text, fields)
    if honest:
        named = fields.get("format", default)
        form = "text" if named == "html" else _SPELLINGS.get(named, default)
    else:
        form = _form(request, fields, default)
    return Intent(
        _key(fields, form),
        form,
        text.encode("utf-8", "surrogateescape"),
        outer=_outer(fields),
        shown=text,
    )


def _intent(fields: Mapping[str, str], form: Form, value: Bottle) -> Intent:
    """A message given as a value; strings stay strings, whatever they contain."""
    payload = b"".join(codec.encode(value))
    shown = value.to_text() if form == "page" else ""
    return Intent(_key(fields, form), form, payload, "binary", outer=_outer(fields), shown=shown)


def _command(request: Request, fields: Mapping[str, str]) -> Intent | Refusal:
    """`cmd`: what a person would type on a text connection."""
    line, _, rest = fields["cmd"].lstrip("\r\n").partition("\n")
    command = framing.parse_command(line.rstrip("\r"))
    form = _form(request, fields, "page")
    if command.key in (CALL, DATA, ADMIN):
        payload = rest.encode("utf-8", "surrogateescape")
        return Intent(command.key, form, payload, outer=_outer(fields), shown=rest)
    if command.key == "r":
        return _reading(request, fields, "")
    if command.key == "q":
        return _one()
    text = PAGE if command.key == "*" else command.text
    return Intent(command.key, form, text=text, outer=_outer(fields))


def _one() -> Refusal:
    return Refusal(404, "a message in the path needs words of more than one letter; try / or /?")


def _key(fields: Mapping[str, str], form: Form) -> str:
    if "admin" in fields:
        return ADMIN
    return DATA if form == "none" else CALL


def _outer(fields: Mapping[str, str]) -> Outer:
    named = fields.get("outer")
    return "list" if named == "list" else "dict" if named == "dict" else "auto"


def _form(request: Request, fields: Mapping[str, str], default: Form) -> Form:
    """Return the form of the answer: as `format` says, else as the client accepts."""
    named = _SPELLINGS.get(fields.get("format", ""))
    if named is not None and named != "events":
        return named
    if fields.get("format") == "html":
        return "page"
    if default == "page" and likes(request, "application/json"):
        return "json" if not likes(request, "text/html") else default
    if default == "text" and likes(request, "application/json"):
        return "json"
    return default


def _reading(request: Request, fields: Mapping[str, str], query: str) -> Intent | Refusal:
    """`/r`: everything that the port writes, or at most `rate` messages per second."""
    asked = query.split("&")
    try:
        rate = number_of("rate", fields, 0.001, 1000)
    except ValueError as error:
        return Refusal(400, str(error))
    form = _reading_form(request, fields, asked)
    return Intent("r", form, pixels="pixels" in asked, rate=rate)


def _reading_form(request: Request, fields: Mapping[str, str], asked: list[str]) -> Form:
    named = fields.get("format")
    if "sse" in asked or named in ("sse", "events"):
        return "events"
    if named == "html":
        return "page"
    if named in ("json", "text"):
        return _SPELLINGS[named]
    if likes(request, "text/event-stream"):
        return "events"
    return "page" if likes(request, "text/html") else "text"


def likes(request: Request, kind: str) -> bool:
    """Return whether the client accepts answers of that MIME type."""
    return kind in request.headers.get("accept", "").lower()
