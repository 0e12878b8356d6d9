"""The page that a port shows to browsers, as text.

Rules: plain HTML with one small style sheet, no script, nothing loaded from elsewhere. Whatever
came from a port or a message is escaped here. Lines of a name server become links, lines of its
help (those that begin with `+`) become forms, as in C++ (core-4 7.4).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from html import escape
from typing import Final

_REGISTRATION = re.compile(
    r"registration name (?P<name>\S+) ip (?P<host>\S+) port (?P<port>\d+) type (?P<kind>\S+)"
)
_NAME_SERVER = re.compile(
    r"(?P<says>Name server at )(?P<url>http://(?P<host>[^\s/:]+):(?P<port>\d+)/)"
)
_ARGUMENT = re.compile(r"\[?\$([A-Za-z0-9_]+)\]?")
_HOST = re.compile(r"[A-Za-z0-9.\-]+|\[[0-9A-Fa-f:.]+\]")

STYLE: Final = """
:root{color-scheme:light dark;--line:#8884;--link:#06c;--soft:#8882}
@media(prefers-color-scheme:dark){:root{--link:#7bf}}
*{box-sizing:border-box}
body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:0 auto;padding:1rem}
h1{font-size:1.4rem;margin:.2rem 0;overflow-wrap:anywhere}
nav{display:flex;flex-wrap:wrap;gap:.3rem 1.2rem;padding:.4rem 0}
nav{border-bottom:1px solid var(--line)}
a{color:var(--link)}
form{display:flex;flex-wrap:wrap;gap:.5rem;margin:1rem 0;align-items:center}
input{font:inherit;padding:.4rem .6rem;border:1px solid var(--line);border-radius:.4rem;min-width:0}
input[name=data]{flex:1 1 12rem}
pre{background:var(--soft);padding:.8rem;border-radius:.4rem}
pre{white-space:pre-wrap;overflow-wrap:anywhere}
ul{list-style:none;padding:0}
li{display:flex;flex-wrap:wrap;align-items:baseline;gap:0 1rem}
li{padding:.35rem 0;border-bottom:1px solid var(--line)}
li>:first-child{flex:1;overflow-wrap:anywhere}
small{opacity:.7}
""".strip().replace("\n", "")  # fmt: skip


def page(name: str, lines: Sequence[str], shown: str = "", host: str = "") -> bytes:
    """The page of the port `name` with the `lines` that it answered.

    shown: what the form's field holds. host: how the browser calls this computer; links to the
    loopback go there.
    """
    parts = [_head(name), _question(shown), *_body(lines, host), "</body></html>\n"]
    return _bytes("".join(parts))


def stream_head(name: str) -> bytes:
    """The page on which messages follow one another; what comes next is `stream_line`s."""
    # Browsers begin to show a page once some of it has come.
    return _bytes(f"{_head(name)}<p>Reading data from port...</p>\n<!--{' ' * 1024}-->\n<pre>\n")


def stream_line(text: str) -> bytes:
    """One message on that page."""
    return _bytes(escape(text) + "\r\n")


def _bytes(text: str) -> bytes:
    for errors in ("strict", "surrogateescape"):
        try:
            return text.encode("utf-8", errors).decode("utf-8", "replace").encode()
        except UnicodeEncodeError:
            continue
    return text.encode("utf-8", "replace")


def _head(name: str) -> str:
    title = escape(name)
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{title} - yarp port</title><style>{STYLE}</style></head>\n<body>"
        f"<small>yarp port</small><h1>{title}</h1>\n"
        '<nav><a href="/">connections</a><a href="/data=help">help</a>'
        '<a href="/?">commands</a><a href="/r">read</a></nav>\n'
    )


def _question(shown: str) -> str:
    return (
        '<form method="post" action="/form">'
        f'<input name="data" value="{escape(shown)}" placeholder="a message, such as: help" '
        'aria-label="message" autocapitalize="off" autocomplete="off" spellcheck="false">'
        '<input type="submit" value="send data"></form>\n'
    )


def _body(lines: Sequence[str], host: str) -> Iterator[str]:
    """Plain lines in blocks, ports in lists, commands as forms."""
    kind = ""
    for line in lines:
        for part in line.split("\n"):
            part = part.rstrip("\r\0")
            now, text = _rendered(part, host)
            if now != kind:
                yield _ENDS[kind] + _BEGINS[now]
                kind = now
            yield text + "\n"
    yield _ENDS[kind]


_BEGINS: Final = {"": "", "pre": "<pre>", "ul": "<ul>\n", "form": "", "p": ""}
_ENDS: Final = {"": "", "pre": "</pre>\n", "ul": "</ul>\n", "form": "", "p": ""}


def _rendered(line: str, host: str) -> tuple[str, str]:
    found = _REGISTRATION.fullmatch(line)
    if found is not None:
        return "ul", _port(found, host)
    found = _NAME_SERVER.fullmatch(line)
    if found is not None:
        url = escape(f"http://{_reachable(found['host'], host)}:{found['port']}/")
        return "p", f'<p>{escape(found["says"])}<a href="{url}">{url}</a></p>'
    if line.startswith("+ "):
        return "form", _command(line[2:])
    return "pre", escape(line)


def _port(found: re.Match[str], host: str) -> str:
    name, kind = escape(found["name"]), escape(found["kind"])
    if found["kind"] != "tcp" or not _HOST.fullmatch(found["host"]):
        where = escape(f"{found['host']}:{found['port']}")
        return f"<li><span>{name}</span><small>{kind} {where}</small></li>"
    place = f"{_reachable(found['host'], host)}:{found['port']}"
    return f'<li><a href="http://{escape(place)}/">{name}</a><small>{escape(place)}</small></li>'


def _reachable(host: str, browsed: str) -> str:
    """An address that the browser can go to: the loopback of this computer may not be its own."""
    if browsed and _HOST.fullmatch(browsed) and (host.startswith("127.") or host == "localhost"):
        return browsed
    return host


def _command(text: str) -> str:
    """A form that fills in the arguments of a command."""
    command = _ARGUMENT.sub(r"$\1", text.strip())
    fields = "".join(
        f'<input name="{name}" placeholder="{name}" size="12" aria-label="{name}">'
        for name in dict.fromkeys(_ARGUMENT.findall(text))
    )
    return (
        '<form method="post" action="/form">'
        f'<input type="hidden" name="data" value="{escape(command)}">'
        f'<code>{escape(text.strip())}</code>{fields}<input type="submit" value="go"></form>'
    )
