"""Whose web pages may act: every case of a browser's headers, and of the setting."""

from __future__ import annotations

import pytest

from yarpy.carriers.http.origin import Origins, hostname, origins_of

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
]


@pytest.mark.parametrize(("setting", "headers", "admitted"), ORIGINS)
def test_whose_pages_may_act(setting: str, headers: dict[str, str], admitted: bool) -> None:
    assert origins_of(setting).admits(headers) == admitted


def test_everybody_by_default() -> None:
    assert Origins(None).admits({"origin": "http://evil"})


def test_setting_is_of_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("YARPY_WEB_ORIGINS", raising=False)
    assert origins_of().listed is None
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "none")
    assert origins_of().listed == frozenset()


def test_who_may_frame() -> None:
    assert origins_of("*").framing == ""
    assert origins_of("none").framing == "frame-ancestors 'self'"
    assert origins_of("http://b http://a").framing == "frame-ancestors 'self' http://a http://b"


def test_names_of_hosts() -> None:
    assert hostname("a.b:80") == hostname("a.b") == "a.b"
    assert hostname("[fe80::1]:80") == hostname("[fe80::1]") == "[fe80::1]"
