"""Whose web pages may act: every case of a browser's headers, and of the setting."""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

from yarpy.carriers.web.http import origin
from yarpy.carriers.web.http.origin import (
    hostname,
    may_not_act,
    not_ours,
    origins_of,
    own_names,
)

SAME = {"host": "10.0.0.1:10002", "origin": "http://10.0.0.1:10002"}
ORIGINS = [
    # setting, headers, whether such a page may act
    ("*", {"origin": "http://evil"}, True),
    ("none", {}, True),  # curl
    ("none", {"user-agent": "curl/8"}, True),
    ("none", SAME, True),
    ("none", {"host": "h:1", "referer": "http://h:1/?data=x"}, True),
    ("none", {"host": "h:1", "user-agent": "Mozilla/5.0", "sec-fetch-site": "same-origin"}, True),
    ("none", {"host": "h:1", "user-agent": "Mozilla/5.0", "sec-fetch-site": "none"}, True),
    ("none", {"host": "h:1", "origin": "http://evil"}, False),
    ("none", {"host": "h:1", "origin": "null"}, False),
    ("none", {"host": "h:1", "referer": "http://evil/x"}, False),
    ("none", {"host": "h:1", "sec-fetch-site": "cross-site"}, False),
    ("none", {"host": "h:1", "user-agent": "Mozilla/5.0"}, False),
    ("none", {"host": "evil.com:1", "origin": "http://evil.com:1"}, False),  # a borrowed name
    ("none", {"host": "robot.local:1", "origin": "http://robot.local:1"}, True),
    ("http://dash:8080, https://x.org/", {"origin": "https://x.org"}, True),
    ("http://dash:8080", {"origin": "http://dash:8081"}, False),
    ("", {"origin": "http://dash"}, False),
    ("", {"origin": "http://h:2", "host": "h:1"}, False),  # another port, another page
    ("dash.example.org", {"origin": "https://Dash.example.org:8443"}, True),
    ("dash.example.org", {"origin": "http://example.org"}, False),
    ("10.0.0.1", {"host": "10.0.0.1:2", "origin": "http://10.0.0.1:10000"}, True),
    ("h.lab.org", {"host": "h.lab.org:1", "origin": "http://h.lab.org:1"}, True),
    ("", {"host": "evil.com:1", "sec-fetch-site": "same-origin"}, False),
    ("null", {"origin": "null"}, True),  # a page that is a file
    ("null", {"host": "10.0.0.1:1", "user-agent": "Mozilla/5.0"}, True),  # typed in
    ("", {"host": "10.0.0.1:1", "user-agent": "Mozilla/5.0"}, False),
    ("10.0.0.1", {"host": "10.0.0.1:1", "user-agent": "Mozilla/5.0"}, False),
    ("", {"host": "10.0.0.1:1", "sec-fetch-site": "none"}, True),
]


@pytest.mark.parametrize(("setting", "headers", "admitted"), ORIGINS)
def test_whose_pages_may_act(setting: str, headers: dict[str, str], admitted: bool) -> None:
    assert origins_of(setting).admits(headers) == admitted


ASKING = [
    # headers of what only asks, whether it may
    ({"host": "10.0.0.1:1", "user-agent": "Mozilla/5.0"}, True),  # an address typed in, no TLS
    ({"host": "robot:1", "user-agent": "Mozilla/5.0"}, True),
    ({"host": "evil.test:1", "user-agent": "Mozilla/5.0"}, False),
    ({"host": "10.0.0.1:1", "origin": "http://evil.test"}, False),
    ({"host": "10.0.0.1:1", "sec-fetch-site": "cross-site"}, False),
    ({"host": "10.0.0.1:1", "origin": "http://10.0.0.1:8080"}, True),  # pages of this network
    ({"host": "10.0.0.1:1", "origin": "http://192.168.1.5"}, True),
    ({"host": "robot:1", "referer": "http://dash:8080/page"}, True),
    ({"host": "evil.test:1", "origin": "http://192.168.1.5"}, False),
    ({"host": "10.0.0.1:1", "origin": "http://8.8.8.8"}, False),
    ({"host": "10.0.0.1:1", "origin": "null"}, False),
]


@pytest.mark.parametrize(("headers", "admitted"), ASKING)
def test_whose_pages_may_ask(headers: dict[str, str], admitted: bool) -> None:
    assert origins_of("").admits(headers, asks=True) == admitted


SHOWN = [
    # setting, headers, whether the page of a program is shown
    ("", {"host": "10.0.0.1:1"}, True),
    ("", {"host": "10.0.0.1:1", "user-agent": "Mozilla/5.0"}, True),
    ("", {"host": "10.0.0.1:1", "referer": "http://mail.test/"}, True),  # a link
    ("", {"host": "h:1", "sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate"}, True),
    ("", {"host": "h:1", "sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors"}, False),
    ("", {"host": "h:1", "sec-fetch-site": "same-site", "sec-fetch-mode": "cors"}, False),
    ("", {"host": "h:1", "sec-fetch-site": "cross-site"}, False),
    ("", {"host": "h:1", "origin": "http://h:1", "sec-fetch-mode": "cors"}, True),
    ("", {"host": "h:1", "origin": "http://evil.test"}, False),
    ("", {"host": "h:1", "origin": "null"}, False),
    ("null", {"host": "h:1", "origin": "null"}, True),
    ("http://dash:8080", {"host": "h:1", "origin": "http://dash:8080"}, True),
    ("*", {"host": "h:1", "origin": "http://evil.test"}, True),
]


@pytest.mark.parametrize(("setting", "headers", "shown"), SHOWN)
def test_who_sees_the_page_of_a_program(setting: str, headers: dict[str, str], shown: bool) -> None:
    assert origins_of(setting).shows(headers) == shown


READING = [
    # setting, headers, whether what the port itself writes is shown
    ("", {}, True),  # curl
    ("", {"host": "robot.lab.org:1", "user-agent": "curl/8"}, True),
    ("", {"host": "10.0.0.1:1", "user-agent": "Mozilla/5.0", "accept-language": "en"}, True),
    ("", {"host": "10.0.0.1:1", "origin": "http://10.0.0.1:8080"}, True),
    ("", {"host": "130.251.0.1:1", "origin": "http://130.251.0.1:8080"}, True),
    ("", {"host": "130.251.0.1:1", "origin": "http://130.251.0.2:8080"}, False),
    ("", {"host": "10.0.0.1:1", "origin": "http://192.168.1.5"}, True),
    ("", {"host": "10.0.0.1:1", "origin": "http://[fe80::1]:80"}, True),
    ("", {"host": "10.0.0.1:1", "origin": "http://[2600::1]:80"}, False),
    ("", {"host": "10.0.0.1:1", "origin": "http://dash:8080"}, True),
    ("", {"host": "10.0.0.1:1", "origin": "http://dash.local"}, True),
    ("", {"host": "10.0.0.1:1", "origin": "http://evil.test"}, False),
    ("", {"host": "10.0.0.1:1", "origin": "http://10.evil.test"}, False),
    ("", {"host": "10.0.0.1:1", "origin": "null"}, False),
    ("", {"host": "10.0.0.1:1", "origin": ""}, False),
    ("null", {"host": "10.0.0.1:1", "origin": "null"}, True),
    ("https://x.org", {"host": "10.0.0.1:1", "origin": "https://x.org"}, True),
    ("x.org", {"host": "10.0.0.1:1", "origin": "https://x.org"}, True),
    ("*", {"host": "10.0.0.1:1", "origin": "http://evil.test"}, True),
    ("", {"host": "h:1", "sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate"}, True),
    ("", {"host": "h:1", "sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors"}, False),
    ("null", {"host": "h:1", "sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors"}, True),
    ("", {"host": "h:1", "sec-fetch-site": "cross-site", "referer": "http://10.0.0.2/"}, True),
    ("", {"host": "h:1", "sec-fetch-site": "same-site", "sec-fetch-mode": "no-cors"}, True),
]


@pytest.mark.parametrize(("setting", "headers", "shown"), READING)
def test_who_reads_what_a_port_writes(setting: str, headers: dict[str, str], shown: bool) -> None:
    assert origins_of(setting).reads(headers) == shown
    refusal = origins_of(setting).refusal(headers, "10.0.0.1", secure=False)
    assert (refusal is None) == shown
    assert shown or (refusal is not None and "YARPY_WEB_ORIGINS=" in refusal[1])


BROWSER = {"user-agent": "Mozilla/5.0", "accept-language": "en"}
RENAMED = {"user-agent": "curl/8", "accept-language": "en"}  # by its page, in Firefox
ELSEWHERE = [
    # Host, the client, whether it is taken for ours where it came over the network
    ("evil.test:1", BROWSER, False),
    ("evil.test:1", RENAMED, False),
    ("evil.test:1", {"user-agent": "curl/8"}, True),
    ("evil.test:1", {}, True),
    ("10.0.0.1:1", BROWSER, True),
    ("[fe80::1]:1", BROWSER, True),
    ("other", BROWSER, True),
    ("other.local:1", BROWSER, True),
    ("robot.lab.test:1", BROWSER, True),
    ("robot.site.test:1", BROWSER, True),  # in a domain of this network
    ("known.test:1", BROWSER, True),
]


@pytest.mark.parametrize(("host", "client", "known"), ELSEWHERE)
def test_names_by_which_browsers_come(
    host: str, client: dict[str, str], known: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page of a site whose name leads to us passes for our own, and hides its origin."""
    monkeypatch.setattr(platform, "node", lambda: "Robot.lab.test")
    monkeypatch.setattr(origin, "_domains", lambda: ["site.test"])
    own_names.cache_clear()
    origins, headers = origins_of("known.test"), {"host": host, **client}
    assert origins.turns_away(headers, "10.0.0.1") == (not known)
    assert not origins.turns_away(headers, "10.0.0.1", secure=True)
    if not known:
        assert not origins.admits(headers)
        assert not origins.admits(headers, asks=True)
    own_names.cache_clear()


def test_domains_of_this_network(tmp_path: Path) -> None:
    file = tmp_path / "resolv.conf"
    file.write_text("# x\nnameserver 10.0.0.1\nsearch Lab.test. site.test\ndomain one.test\n")
    assert origin._domains(str(file)) == ["lab.test", "site.test", "one.test"]
    assert origin._domains(str(tmp_path / "none")) == []


OPENINGS = [
    ("", {"origin": "http://evil.test:80"}, "YARPY_WEB_ORIGINS=http://evil.test:80"),
    ("", {}, "YARPY_WEB_ORIGINS=null"),
    ("", {"referer": "https://a.b/c?d"}, "YARPY_WEB_ORIGINS=https://a.b"),
    ("lab.org", {"origin": "null"}, 'YARPY_WEB_ORIGINS="lab.org null"'),
    ("", {"origin": 'http://"; rm'}, "YARPY_WEB_ORIGINS=ORIGIN"),
]


@pytest.mark.parametrize(("setting", "headers", "line"), OPENINGS)
def test_the_line_that_opens_it(setting: str, headers: dict[str, str], line: str) -> None:
    origins = origins_of(setting)
    assert origins.opening(headers) == line
    assert line in may_not_act(origins, headers)
    if "ORIGIN" not in line.partition("=")[2]:
        text = line.partition("=")[2].strip('"')
        assert origins_of(text).admits({**headers, "user-agent": "Mozilla/5.0"})


HOSTS = [
    # Host, whether who comes over the loopback may call us that
    ("127.0.0.1:10002", True),
    ("localhost:10002", True),
    ("LOCALHOST", True),
    ("dev.localhost:1", True),
    ("[::1]:10002", True),
    ("robot", True),
    ("robot.local:1", True),
    ("Robot:1", True),
    ("other", False),  # a name that anybody's router may invent
    ("other.local:1", False),
    ("10.0.0.1", True),  # an address is not borrowed
    ("", True),  # HTTP/1.0, so no browser
    ("known.test:1", True),
    ("evil.test:1", False),
    ("127.0.0.1.evil.test", False),
    ("evil.test.", False),
]


@pytest.mark.parametrize(("host", "known"), HOSTS)
def test_how_we_may_be_called(host: str, known: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(platform, "node", lambda: "Robot.lab.test")
    own_names.cache_clear()
    origins = origins_of("known.test")
    assert origins.turns_away({"host": host}, "127.0.0.1") == (not known)
    assert origins.turns_away({"host": host}, "::1") == (not known)
    assert not origins.turns_away({"host": host}, "10.0.0.1")
    assert not origins_of("*").turns_away({"host": host}, "127.0.0.1")
    own_names.cache_clear()


def test_who_is_turned_away_reads_its_name_without_tricks() -> None:
    assert "not known as evil.testscript:" in not_ours("evil.test<script>\r\n:1")


def test_setting_is_of_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("YARPY_WEB_ORIGINS", raising=False)
    assert origins_of().listed == frozenset()
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "*")
    assert origins_of().listed is None
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "none")
    assert origins_of().listed == frozenset()


def test_who_may_frame() -> None:
    assert origins_of("*").framing == ""
    assert origins_of("none").framing == "frame-ancestors 'self'"
    assert origins_of("http://b http://a").framing == "frame-ancestors 'self' http://a http://b"
    assert origins_of("h").framing == "frame-ancestors 'self' http://h:* https://h:*"


def test_names_of_hosts() -> None:
    assert hostname("a.b:80") == hostname("a.b") == "a.b"
    assert hostname("[fe80::1]:80") == hostname("[fe80::1]") == "[fe80::1]"
