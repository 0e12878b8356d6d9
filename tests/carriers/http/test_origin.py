"""Whose web pages may act: every case of a browser's headers, and of the setting."""

from __future__ import annotations

import pytest

from yarpy.carriers.http.origin import hostname, not_ours, origins_of

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
]


@pytest.mark.parametrize(("setting", "headers", "admitted"), ORIGINS)
def test_whose_pages_may_act(setting: str, headers: dict[str, str], admitted: bool) -> None:
    assert origins_of(setting).admits(headers) == admitted


HOSTS = [
    # Host, whether who comes over the loopback may call us that
    ("127.0.0.1:10002", True),
    ("localhost:10002", True),
    ("LOCALHOST", True),
    ("dev.localhost:1", True),
    ("[::1]:10002", True),
    ("robot", True),
    ("robot.local:1", True),
    ("", True),  # HTTP/1.0, so no browser
    ("known.test:1", True),
    ("evil.test:1", False),
    ("127.0.0.1.evil.test", False),
    ("evil.test.", False),
]


@pytest.mark.parametrize(("host", "known"), HOSTS)
def test_how_we_may_be_called(host: str, known: bool) -> None:
    origins = origins_of("known.test")
    assert origins.turns_away({"host": host}, "127.0.0.1") == (not known)
    assert origins.turns_away({"host": host}, "::1") == (not known)
    assert not origins.turns_away({"host": host}, "10.0.0.1")
    assert not origins_of("*").turns_away({"host": host}, "127.0.0.1")


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
