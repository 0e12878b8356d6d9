"""The pictures of README and docs, made by a program: what the pages of the demo look like today.

`make pictures` writes them to docs/pictures; without it they go to tests/output.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from support.browser import Browser
from support.command_line import CommandLine
from support.process import Process
from support.wait import HANG, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Page

ROOT = Path(__file__).parents[2]
SIZE = {"width": 1200, "height": 760}
WIDE = 1440  # of the pages of recordings
LARGEST = 480_000  # bytes of one, so that a clone stays small
FOLDER = Path(os.environ.get("YARPY_PICTURES", ROOT / "tests" / "output" / "docs"))
URL = r"http://\S+"


@pytest.fixture(scope="module")
def line(tmp_path_factory: pytest.TempPathFactory) -> Iterator[CommandLine]:
    """The command line beside a demo; its page is `line.variables["page"]`."""
    found = CommandLine(tmp_path_factory.mktemp("demo"))
    with found.start("demo", "--no-browser") as demo:
        demo.wait_line("Ctrl-C ends it all", timeout=HANG)
        server = demo.wait_line(r"export YARPY_SERVER=(\S+)", timeout=HANG)[1]
        page = demo.wait_line(rf"({URL})\s+<- open this", timeout=HANG)[1]
        yield CommandLine(found.home, {"YARPY_SERVER": server, "DEMO_PAGE": page})


def open_page(browser: Browser, url: str, phone: bool = False, width: int = SIZE["width"]) -> Page:
    page = browser.open(phone=phone)
    if phone:
        page.goto(url, wait_until="commit")
        return page
    page.set_viewport_size({"width": width, "height": SIZE["height"]})
    page.goto(url, wait_until="commit")  # pages with streams never stop loading
    return page


def keep(page: Page, name: str, height: int = SIZE["height"], width: int = SIZE["width"]) -> None:
    """Write a picture of a page."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    path = FOLDER / f"{name}.png"
    clip = {"x": 0, "y": 0, "width": width, "height": height}
    page.screenshot(path=path, animations="disabled", clip=clip, scale="css")  # type: ignore[arg-type]
    assert 5_000 < path.stat().st_size < LARGEST


def address(process: Process) -> str:
    return process.wait_line(rf"({URL})", timeout=HANG)[1]


def test_the_robot(browser: Browser, line: CommandLine) -> None:
    browser.excuse("ERR_|Failed to load")
    page = open_page(browser, line.environment["DEMO_PAGE"])
    said = page.locator("body")
    wait_until(lambda: said.inner_text().count("320 \u00d7 240") == 2, HANG, "both eyes see")
    page.get_by_role("button", name="Try each joint").click()
    page.wait_for_timeout(7000)  # a stretch of curves
    keep(page, "demo")


def test_the_network(browser: Browser, line: CommandLine) -> None:
    browser.excuse("ERR_|Failed to load")
    with (
        line.start("view", "--no-browser", "--connect", "/icubSim/cam/left") as view,
        line.start("dash", "--no-browser") as dash,
    ):
        address(view)
        page = open_page(browser, address(dash))
        wait_until(lambda: "/icubSim/cam/left" in page.content(), HANG)
        page.wait_for_timeout(3000)  # rates are those of the last seconds
        keep(page, "dash")


def test_numbers(browser: Browser, line: CommandLine) -> None:
    browser.excuse("ERR_|Failed to load")
    with line.start("scope", "/icubSim/head/state:o", "--no-browser", "--window", "3") as scope:
        page = open_page(browser, address(scope))
        page.wait_for_selector("canvas")
        command = ["rpc", "/icubSim/head/rpc:i"]
        assert line.run(*command, input="set pos 0 20\nset pos 1 -30\n").returncode == 0
        page.wait_for_timeout(2500)
        keep(page, "scope")


def test_a_port(browser: Browser, line: CommandLine) -> None:
    found = line.run("name", "query", "/icubSim/head/rpc:i").stdout
    host, number = re.search(r"ip (\S+) port (\d+)", found).groups()  # type: ignore[union-attr]
    page = open_page(browser, f"http://{host}:{number}/")
    page.get_by_label("message").fill("get encs")
    page.get_by_role("button", name="send data").click()
    wait_until(lambda: "[is]" in page.locator("body").inner_text(), HANG)
    keep(page, "port", 280)


def test_a_recording(browser: Browser, line: CommandLine) -> None:
    ports = ("/icubSim/head/state:o", "/icubSim/cam/left", "/icubSim/cam/right")
    with line.start("record", *ports, "-o", "walk") as recorder:
        wait_until((line.home / "walk.mcap").exists, HANG)
        command = ["rpc", "/icubSim/head/rpc:i"]
        assert line.run(*command, input="set pos 0 -25\nset pos 2 40\n").returncode == 0
        line.run("rpc", "/record/rpc:i", input='mark "it looks up"\n')
        page = open_page(browser, address(recorder), width=WIDE)
        page.get_by_label("Note of this moment").fill("it looks away")
        page.wait_for_timeout(2500)  # rates are those of the last seconds
        keep(page, "record", 420, WIDE)
        page.wait_for_timeout(9000)  # there is something to look back at
        page.get_by_role("button", name="Stop").click()
        page.get_by_role("button", name="Stop now?").click()
        assert recorder.wait(2 * HANG) == 0
    with line.start("view", "walk.mcap", "--no-browser") as view:
        url = address(view)
        page = open_page(browser, url, width=WIDE)
        page.wait_for_selector("#cards figure")
        page.keyboard.press("Shift+ArrowRight")
        page.wait_for_selector("#cards figure .picture:visible")
        page.wait_for_timeout(1500)
        keep(page, "view", 640, WIDE)
        page = open_page(browser, url, phone=True)
        page.wait_for_selector("#cards figure")
        page.keyboard.press("Shift+ArrowRight")
        page.wait_for_selector("#cards figure .picture:visible")
        page.wait_for_timeout(1500)
        keep(page, "view_phone", 700, 390)


def test_each_is_on_a_page() -> None:
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    named = set(re.findall(r"pictures/(\w+)\.png", "".join(page.read_text() for page in pages)))
    made = set(re.findall(r'keep\(page, "(\w+)"', Path(__file__).read_text(encoding="utf-8")))
    kept = {path.stem for path in (ROOT / "docs" / "pictures").iterdir()}
    assert named == made == kept
