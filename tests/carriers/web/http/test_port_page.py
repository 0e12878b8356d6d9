"""The page of a port: nothing unescaped, links to ports, forms for a name server's commands."""

from __future__ import annotations

from html.parser import HTMLParser

from hypothesis import given
from hypothesis import strategies as st

from yarpy.carriers.web.http.port_page import Browsed, page, reader


class Seen(HTMLParser):
    """What a browser would make of a page."""

    def __init__(self, data: bytes) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.open: list[str] = []
        self.feed(data.decode())
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in ("input", "meta", "link"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]


EVIL = '<script>alert("1")</script>&amp;\'"'


def test_everything_is_escaped() -> None:
    seen = Seen(page(f"/{EVIL}", [EVIL, f"+ {EVIL} ${EVIL}"], EVIL, Browsed(EVIL)))
    assert [one["src"] for one in seen.all("script")] == ["/*/port.js"]
    assert not seen.open
    assert seen.text.count("<script>") == 5  # title, heading, line, command and its argument
    assert EVIL in [item.get("value") for item in seen.all("input")]
    seen = Seen(reader(EVIL))
    assert len(seen.all("script")) == 1
    assert seen.text.count("<script>") == 2


def test_page_has_what_people_need() -> None:
    data = page("/cam", ["This is /cam at tcp://h:1/", "", "two"], "last one")
    seen = Seen(data)
    assert data.startswith(b"<!DOCTYPE html>")
    assert {item["href"] for item in seen.all("a")} == {"/*", "/data=help", "/?", "/r"}
    assert {"name": "viewport", "content": "width=device-width,initial-scale=1"} in seen.all("meta")
    assert [one["href"] for one in seen.all("link")] == ["/*/style.css", "/*/port.css"]
    form = seen.all("form")
    assert form == [{"id": "ask", "method": "post", "action": "/form"}]
    assert seen.all("input")[0]["value"] == "last one"
    assert b"<pre>This is /cam at tcp://h:1/\n\ntwo\n</pre>" in data
    assert len(data) < 3000


def test_registrations_are_links() -> None:
    lines = [
        "registration name /a ip 10.0.0.1 port 10002 type tcp",
        "registration name /b ip 127.0.0.1 port 10003 type tcp",
        "registration name /m ip 224.1.1.3 port 10004 type mcast",
        'registration name /evil ip x"onclick=1 port 10004 type tcp',
        "*** end of message",
    ]
    seen = Seen(page("/root", lines, browsed=Browsed("robot")))
    links = [item["href"] for item in seen.all("a")][4:]
    assert links == ["http://10.0.0.1:10002/", "http://robot:10003/"]
    assert len(seen.all("li")) == 4
    assert all(set(item) == {"href"} for item in seen.all("a"))


def test_name_server_is_a_link() -> None:
    seen = Seen(page("/x", ["Name server at http://10.0.0.1:10000/"]))
    assert seen.all("a")[-1]["href"] == "http://10.0.0.1:10000/"
    seen = Seen(page("/x", ["Name server at http://127.0.0.1:10000/"], browsed=Browsed("10.1.1.1")))
    assert seen.all("a")[-1]["href"] == "http://10.1.1.1:10000/"
    seen = Seen(page("/x", ["Name server at http://localhost:10000/"], browsed=Browsed('x" y="')))
    assert seen.all("a")[-1]["href"] == "http://localhost:10000/"


def test_links_of_a_page_in_tls_are_in_tls() -> None:
    lines = [
        "registration name /a ip 10.0.0.1 port 10002 type tcp",
        "Name server at http://127.0.0.1:10000/",
    ]
    seen = Seen(page("/root", lines, browsed=Browsed("robot", secure=True)))
    links = [item["href"] for item in seen.all("a")][4:]
    assert links == ["https://10.0.0.1:10002/", "https://robot:10000/"]
    assert "http://" not in seen.text


def test_who_may_only_look_finds_no_forms() -> None:
    lines = ["+ set $port $key $value", "This is /a"]
    seen = Seen(page("/root", lines, browsed=Browsed(may_write=False)))
    assert not seen.all("form")
    assert not seen.all("input")
    assert "Read only" in seen.text


def test_commands_are_forms() -> None:
    seen = Seen(page("/root", ["+ set $port $key $value", "+ list [$prefix]", "  (a note)"]))
    hidden = [item["value"] for item in seen.all("input") if item.get("type") == "hidden"]
    assert hidden == ["set $port $key $value", "list $prefix"]
    names = [item["name"] for item in seen.all("input") if "placeholder" in item]
    assert names == ["data", "port", "key", "value", "prefix"]


def test_bytes_that_are_no_text_are_shown_as_such() -> None:
    assert "\ufffd".encode() in page("/x", ["\udcff"])


ANY = st.text(st.characters(codec=None), max_size=20)


@given(ANY, st.lists(ANY, max_size=4), ANY, ANY)
def test_any_text_leaves_the_page_whole(name: str, lines: list[str], shown: str, host: str) -> None:
    plain = Seen(page("/x", [""]))
    seen = Seen(page(name, lines, shown, Browsed(host)))
    assert not seen.open
    assert {tag for tag, _ in seen.tags} <= {tag for tag, _ in plain.tags} | {
        "p",
        "ul",
        "li",
        "span",
        "code",
        "small",
    }


def test_control_characters_are_seen() -> None:
    shown = page("/a", ["name \x1b[2J and \u202ereversed"]).decode()
    assert "name \\x1b[2J and \\u202ereversed" in shown
