"""Where a page is, and when a browser opens by itself."""

from __future__ import annotations

import webbrowser

import pytest

import yarpy
from yarpy.cli import showing


@pytest.mark.parametrize(
    ("platform", "environment", "expected"),
    [
        ("linux", {}, False),
        ("linux", {"DISPLAY": ""}, False),
        ("linux", {"DISPLAY": ":0"}, True),
        ("linux", {"WAYLAND_DISPLAY": "wayland-0"}, True),
        ("freebsd14", {}, False),
        ("darwin", {}, True),
        ("win32", {}, True),
    ],
)
def test_display(platform, environment, expected):
    assert showing.has_display(platform, environment) is expected


@pytest.mark.parametrize(("display", "browser"), [(":9", True), (":9", False), ("", True)])
def test_the_page_is_told_and_opened(monkeypatch, capsys, display, browser):
    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(showing.sys, "platform", "linux")
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with yarpy.Port("/view", names=yarpy.LocalNames()) as port:
        showing.show_page(port, browser)
        url = f"http://{port.address}/"
    assert capsys.readouterr().out == f"/view is shown at {url}\n"
    assert opened == ([url] if display and browser else [])


def test_browser_that_does_not_open(monkeypatch):
    def fail(url):
        raise webbrowser.Error("no runnable browser")

    monkeypatch.setattr(webbrowser, "open", fail)
    monkeypatch.setenv("DISPLAY", ":9")
    showing.open_page("http://127.0.0.1:1/")
