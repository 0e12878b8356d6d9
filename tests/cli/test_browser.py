"""Where a page is, and when a browser opens by itself."""

from __future__ import annotations

import webbrowser

import pytest

import yarpy
from yarpy.cli import browser


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
    assert browser.has_display(platform, environment) is expected


@pytest.mark.parametrize(("display", "wanted"), [(":9", True), (":9", False), ("", True)])
def test_the_page_is_told_and_opened(monkeypatch, capsys, display, wanted):
    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(browser.sys, "platform", "linux")
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with yarpy.Port("/view", names=yarpy.LocalNames()) as port:
        browser.show_page(port, wanted)
        url = f"http://{port.address}/"
    assert capsys.readouterr().out == f"/view is shown at {url}\n"
    assert opened == ([url] if display and wanted else [])


def test_browser_that_does_not_open(monkeypatch):
    def fail(url):
        raise webbrowser.Error("no runnable browser")

    monkeypatch.setattr(webbrowser, "open", fail)
    monkeypatch.setenv("DISPLAY", ":9")
    browser.open_page("http://127.0.0.1:1/")
