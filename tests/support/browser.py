"""A real browser in a test: Chromium of the system, driven by playwright.

    def test_page(browser, names):
        with yarpy.Port("/p", names=names) as port:
            page = browser.open(f"http://{port.address}/", dark=True, phone=True)
            page.get_by_role("link", name="help").click()
            browser.picture(page, "help")              # tests/output/help.png

Rules: one Chromium for the session, a fresh context for each page, nothing of the network but this
computer; names that end in `.test` are this computer too, for tests of other origins. What a page
complains about on its console fails its test, unless `browser.excuse` said that it may. No browser
is ever downloaded; a test with this fixture needs the peer `chromium`.

Playwright is started anew for each test: it keeps an event loop in its thread, and one that stayed
would be in the way of the tests of asyncio.
"""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from support.peer import brings, chromium
from support.process import Process
from support.wait import HANG

if TYPE_CHECKING:
    from playwright.sync_api import Browser as Chromium
    from playwright.sync_api import BrowserContext, ConsoleMessage, Page

OUTPUT = Path(__file__).parents[1] / "output"  # not in git
FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-port=0",
    "--host-resolver-rules="
    "MAP *.test 127.0.0.1 , MAP * ~NOTFOUND , EXCLUDE 127.0.0.1 , EXCLUDE localhost",
)  # fmt: skip
DESK = {"width": 1000, "height": 700}
PHONE = {"width": 390, "height": 780}


class Browser:
    """What the fixture `browser` gives a test."""

    def __init__(self, chromium: Chromium) -> None:
        self._chromium = chromium
        self._contexts: list[BrowserContext] = []
        self._excused: list[str] = []
        self.complaints: list[str] = []
        """Errors on the consoles of all pages so far."""

    def open(self, url: str = "", *, dark: bool = False, phone: bool = False) -> Page:
        """A page in a context of its own; it shows `url` once this returns.

        For what never stops loading leave `url` out and call `page.goto(url, wait_until="commit")`.
        """
        context = self._chromium.new_context(
            viewport=PHONE if phone else DESK,
            color_scheme="dark" if dark else "light",
            has_touch=phone,
            is_mobile=phone,
            device_scale_factor=2 if phone else 1,
        )
        self._contexts.append(context)
        context.set_default_timeout(HANG * 1000)
        page = context.new_page()
        page.on("console", self._listen)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        if url:
            page.goto(url)
        return page

    def excuse(self, pattern: str) -> None:
        """Let the pages of this test complain about what matches `pattern`."""
        self._excused.append(pattern)

    def picture(self, page: Page, name: str, *, whole: bool = False) -> Path:
        """A screenshot for people to look at; `whole`: also what one has to scroll to."""
        OUTPUT.mkdir(exist_ok=True)
        path = OUTPUT / f"{name}.png"
        page.screenshot(path=path, full_page=whole, animations="disabled")
        return path

    def close(self) -> None:
        """Close the pages of this test."""
        for context in self._contexts:
            context.close()

    def unexcused(self) -> list[str]:
        """The complaints that nobody expected.

        A page asks on and on, also while a test closes the port before the page.
        """
        return [
            text
            for text in self.complaints
            if not any(re.search(e, text) for e in self._excused) and not _of_one_that_left(text)
        ]

    def _listen(self, message: ConsoleMessage) -> None:
        if message.type == "error":
            where = (message.location or {}).get("url", "")
            self.complaints.append(f"{message.text} ({where})")


@pytest.fixture(scope="session")
@brings("chromium")
def chromium_url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Where the session's Chromium is told what to do."""
    profile = tmp_path_factory.mktemp("chromium")
    args = [chromium(), *FLAGS, f"--user-data-dir={profile}", "about:blank"]
    with Process(args, env=_environment(profile)) as process:
        found = process.wait_line(r"DevTools listening on (ws://\S+)", timeout=60.0)
        yield found[1]


@pytest.fixture
def browser(chromium_url: str) -> Iterator[Browser]:
    """A browser without pages; its errors fail the test."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.connect_over_cdp(chromium_url)
        found = Browser(chromium)
        yield found
        found.close()
        chromium.close()
    assert not found.unexcused(), "the pages complained on their consoles"


def _of_one_that_left(complaint: str) -> bool:
    """Return whether a connection failed to a server that is gone by now. Whatever name it has in
    the browser, it was on this computer."""
    found = re.search(r"net::ERR_.* \(\w+://([\w.]+):(\d+)", complaint)
    if found is None:
        return False
    host = found[1] if found[1].replace(".", "").isdigit() else "127.0.0.1"
    with socket.socket() as probe:
        return probe.connect_ex((host, int(found[2]))) != 0


def _environment(home: Path) -> dict[str, str]:
    """Nothing of the user's own settings."""
    found = {k: v for k, v in os.environ.items() if not k.lower().endswith("_proxy")}
    return {**found, "HOME": str(home), "XDG_CONFIG_HOME": str(home), "XDG_CACHE_HOME": str(home)}
