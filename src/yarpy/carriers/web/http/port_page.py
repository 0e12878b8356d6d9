"""The page that a port shows to browsers, as text.

Rules: plain HTML that also works without its script, which adds live data; nothing is loaded from
elsewhere. Anything from a port or a message is escaped here. Lines of a name server become links,
lines of its help (those that begin with `+`) become forms, as in C++.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import Final

from yarpy.log import readable

_REGISTRATION = re.compile(
    r"registration name (?P<name>\S+) ip (?P<host>\S+) port (?P<port>\d+) type (?P<kind>\S+)"
)
_NAME_SERVER = re.compile(
    r"(?P<says>Name server at )(?P<url>http://(?P<host>[^\s/:]+):(?P<port>\d+)/)"
)
_ARGUMENT = re.compile(r"\[?\$([A-Za-z0-9_]+)\]?")
_HOST = re.compile(r"[A-Za-z0-9.\-]+|\[[0-9A-Fa-f:.]+\]")


@dataclass(frozen=True, slots=True)
class Browsed:
    """A port as a browser sees it. host: its name for this computer, which replaces the loopback in
    links. secure: over https, which links then use too. may_write: it may send messages."""

    host: str = ""
    secure: bool = False
    may_write: bool = True

    def url(self, host: str, port: str) -> str:
        """The address of another port."""
        return f"http{'s' if self.secure else ''}://{_reachable(host, self.host)}:{port}/"


def page(name: str, lines: Sequence[str], shown: str = "", browsed: Browsed = Browsed()) -> bytes:
    """The page of the port `name` with the `lines` of its answer.

    shown: the content of the form's field.
    """
    question = _question(shown) if browsed.may_write else READ_ONLY
    parts = [_head(name, "port"), question, *_body(lines, browsed), _END]
    return _bytes("".join(parts))


def reader(name: str) -> bytes:
    """The page of what the port writes, message by message."""
    text = "text</a>, this page needs JavaScript"
    plain = f'<noscript><p><a href="/r?format=text">As {text}.</p></noscript>\n'
    return _bytes(f'{_head(name, "messages")}{plain}<ol id="messages"></ol>\n{_END}')


def _bytes(text: str) -> bytes:
    for errors in ("strict", "surrogateescape"):
        try:
            return text.encode("utf-8", errors).decode("utf-8", "replace").encode()
        except UnicodeEncodeError:
            continue
    return text.encode("utf-8", "replace")


_END: Final = "</main></body></html>\n"


def _head(name: str, view: str) -> str:
    title = escape(readable(name))
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{title} - yarp port</title>"
        '<link rel="stylesheet" href="/*/style.css"><link rel="stylesheet" href="/*/port.css">'
        '<script type="module" src="/*/port.js"></script></head>\n'
        f'<body data-view="{view}"><header><h1>{title}</h1>'
        '<p id="state" class="soft" role="status">yarp port</p>'
        '<nav><a href="/*">port</a><a href="/r">messages</a>'
        '<a href="/data=help">help</a><a href="/?">commands</a></nav></header>\n'
        '<main id="port"><section id="flow" hidden></section>\n'
    )


READ_ONLY: Final = (
    '<p id="readonly" class="soft">Read only: whoever has opened this page may look and send '
    "nothing. The file access.toml where this port runs says who may.</p>\n"
)


def _question(shown: str) -> str:
    return (
        '<form id="ask" method="post" action="/form">'
        f'<input name="data" value="{escape(shown)}" placeholder="a message, such as: help" '
        'aria-label="message" autocapitalize="off" autocomplete="off" spellcheck="false">'
        '<input type="submit" value="send data"></form>\n'
    )


def _body(lines: Sequence[str], browsed: Browsed) -> Iterator[str]:
    """Plain lines in blocks, ports in lists, commands as forms."""
    kind = ""
    for line in lines:
        for part in line.split("\n"):
            part = readable(part.rstrip("\r\0"), keep="\t")
            now, text = _rendered(part, browsed)
            if now != kind:
                yield _ENDS[kind] + _BEGINS[now]
                kind = now
            yield text + "\n"
    yield _ENDS[kind]


_BEGINS: Final = {"": "", "pre": "<pre>", "ul": "<ul>\n", "form": "", "p": ""}
_ENDS: Final = {"": "", "pre": "</pre>\n", "ul": "</ul>\n", "form": "", "p": ""}


def _rendered(line: str, browsed: Browsed) -> tuple[str, str]:
    found = _REGISTRATION.fullmatch(line)
    if found is not None:
        return "ul", _port(found, browsed)
    found = _NAME_SERVER.fullmatch(line)
    if found is not None:
        url = escape(browsed.url(found["host"], found["port"]))
        return "p", f'<p>{escape(found["says"])}<a href="{url}">{url}</a></p>'
    if line.startswith("+ ") and browsed.may_write:
        return "form", _command(line[2:])
    return "pre", escape(line)


def _port(found: re.Match[str], browsed: Browsed) -> str:
    name, kind = escape(found["name"]), escape(found["kind"])
    if found["kind"] != "tcp" or not _HOST.fullmatch(found["host"]):
        where = escape(f"{found['host']}:{found['port']}")
        return f"<li><span>{name}</span><small>{kind} {where}</small></li>"
    url = browsed.url(found["host"], found["port"])
    place = url.split("/")[2]
    return f'<li><a href="{escape(url)}">{name}</a><small>{escape(place)}</small></li>'


def _reachable(host: str, browsed: str) -> str:
    """An address that the browser can open: its loopback may not be this computer's."""
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
