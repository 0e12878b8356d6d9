"""The page, in a browser: what is seen, dragged, played, saved."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.browser import Browser
from support.recordings import START, payload_of
from support.wait import wait_until

import yarpy
from yarpy import record
from yarpy.kits.record.capture.subscriptions import PortSelection
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.view.beside import BesideSource
from yarpy.kits.record.view.ring import LiveSource
from yarpy.kits.record.view.server import View
from yarpy.kits.record.view.source import FileSource

if TYPE_CHECKING:
    from playwright.sync_api import Page

SECOND = 1_000_000_000


@pytest.fixture
def walk(tmp_path: Path) -> Iterator[View]:
    """20 s of joints with a silence, and of a camera that becomes lighter; two marks."""
    with McapWriter(tmp_path / "walk.mcap") as writer:
        for n in range(200):
            time = START + n * SECOND // 10
            if not 80 <= n < 120:
                numbers = yarpy.Vector([n, -n])
                writer.add("/head/state:o", f"{n} {n}.5", time, payload_of(numbers))
            if n % 5 == 0:
                image = yarpy.Image(np.full((48, 64, 3), n, "u1"))
                writer.add("/cam", "", time, payload_of(image))
        writer.note({"what": "mark", "text": "it fell"}, START + 5 * SECOND)
    with FileSource([tmp_path / "walk.mcap"]) as source, View(source, port=0) as found:
        wait_until(lambda: source.seen == 1)
        yield found


@pytest.fixture
def sensors(tmp_path: Path) -> Iterator[View]:
    """Two clouds of points and two sounds, a second apart."""
    with McapWriter(tmp_path / "sensors.mcap") as writer:
        for n in range(2):
            time = START + n * SECOND
            points = np.random.default_rng(n).normal(size=(300, 3)) * (1, 1, 0.3)
            writer.add("/depth", f"{n} 1", time, payload_of(yarpy.PointCloud(points)))
            tone = 9000 * np.sin(np.arange(4000) * (0.05 + 0.2 * n))
            writer.add("/ear", "", time, payload_of(yarpy.Sound(tone[None].astype("i2"), 8000)))
    with FileSource([tmp_path / "sensors.mcap"]) as source, View(source, port=0) as found:
        wait_until(lambda: source.seen == 1)
        yield found


def card(page: Page, name: str) -> str:
    found: str = page.locator("figure", has_text=name).inner_text()
    return found


def light(page: Page) -> int:
    """The brightness of the picture, 0 while there is none."""
    found: int = page.evaluate(
        """() => {
          const image = document.querySelector(".picture");
          if (!image?.complete || !image.naturalWidth) return 0;
          const canvas = document.createElement("canvas");
          canvas.width = canvas.height = 1;
          const context = canvas.getContext("2d");
          context.drawImage(image, 0, 0, 1, 1);
          return context.getImageData(0, 0, 1, 1).data[0];
        }"""
    )
    return found


def state(page: Page) -> str:
    found: str = page.inner_text("#state")
    return found


def test_looking_back(browser: Browser, walk: View, tmp_path: Path) -> None:
    page = browser.open(walk.url)
    wait_until(lambda: "0.0 0.0" in card(page, "/head/state:o"), what="the first message")
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    wait_until(lambda: "30.0 -30.0" in card(page, "/head/state:o"), what="that of the cursor")
    wait_until(lambda: abs(light(page) - 30) < 4, what="the picture of the cursor")
    assert "number 30, 3.000 s" in card(page, "/head/state:o") and "3.000 of 19.9 s" in state(page)
    # In the silence the last message stays.
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    wait_until(lambda: "79.0 -79.0" in card(page, "/head/state:o"))
    with page.expect_download() as saved:
        page.locator("figure", has_text="/head/state:o").get_by_text("CSV").click()
    lines = Path(saved.value.path()).read_text(encoding="utf-8").splitlines()
    assert len(lines) == 161 and saved.value.suggested_filename.startswith("head-state-o_")
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save").click()
    assert Path(saved.value.path()).read_bytes()[:2] == b"\xff\xd8"
    # A stretch is marked, and cut out.
    box = page.locator("#time canvas").bounding_box()
    assert box is not None
    top = box["y"] + box["height"] - 8
    page.keyboard.down("Shift")
    page.mouse.move(box["x"] + 400, top)
    page.mouse.down()
    page.mouse.move(box["x"] + 600, top, steps=3)
    page.mouse.up()
    page.keyboard.up("Shift")
    assert page.inner_text("#command").startswith("yarpy convert walk.mcap --start")
    with page.expect_download() as saved:
        page.locator("#cut").click()
    saved.value.save_as(tmp_path / "cut.mcap")
    with record.open(tmp_path / "cut.mcap") as recording:
        assert 1 < recording.end - recording.begin < 10
    # A click on a name closes a port, and opens it again.
    page.mouse.click(box["x"] + 40, box["y"] + 42 + 10)
    wait_until(lambda: page.locator("figure").count() == 1)
    page.mouse.click(box["x"] + 40, box["y"] + 42 + 10)
    wait_until(lambda: page.locator("figure").count() == 2)
    assert "port=%2Fhead" in page.url


def test_it_opens_where_each_port_has_said_something(browser: Browser, tmp_path: Path) -> None:
    with McapWriter(tmp_path / "late.mcap") as writer:
        for n in range(100):
            writer.add("/a", "", START + n * SECOND // 10, payload_of([n]))
            if n >= 5:
                writer.add("/b", "", START + n * SECOND // 10, payload_of([n * 10]))
    with FileSource([tmp_path / "late.mcap"]) as source, View(source, port=0) as view:
        wait_until(lambda: source.seen == 1)
        page = browser.open(view.url)
        wait_until(lambda: "\n50" in card(page, "/b") and "\n5" in card(page, "/a"))
        page.keyboard.press("Home")
        wait_until(lambda: "nothing came until here" in card(page, "/b"))


def test_playing(browser: Browser, walk: View) -> None:
    page = browser.open(walk.url, phone=True, dark=True)
    wait_until(lambda: "0.0 0.0" in card(page, "/head/state:o"))
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.select_option("#rate", "100")
    page.get_by_role("button", name="Play").click()
    wait_until(lambda: "199.0 -199.0" in card(page, "/head/state:o"), what="the end")
    wait_until(lambda: page.get_by_role("button", name="Play").count() == 1)
    wait_until(lambda: "19.900 of 19.9 s" in state(page))


def test_live(browser: Browser) -> None:
    with (
        yarpy.NameServer() as server,
        yarpy.Port("/a", names=server.client) as port,
        LiveSource(PortSelection(("/a",)), names=server.client) as source,
        View(source, port=0) as view,
    ):
        port.wait_for_outputs()
        page = browser.open(view.url)
        wait_until(lambda: "Nothing came yet" in page.inner_text("#trouble"))
        port.write([17])
        wait_until(lambda: "17" in card(page, "/a") if page.locator("figure").count() else False)
        page.get_by_role("button", name="Pause").click()
        wait_until(lambda: "live" not in state(page))
        port.write([18])
        wait_until(lambda: source.told()["ports"][0]["messages"] == 2)
        page.get_by_role("button", name="Live").click()
        wait_until(lambda: "18" in card(page, "/a"))
        port.write([19])
        wait_until(lambda: "19" in card(page, "/a") and "live" in state(page))


def painted(page: Page, canvas: str) -> str:
    """What a canvas shows, "" while there is nothing."""
    found: str = page.evaluate(
        """(name) => {
          const canvas = document.querySelector(`${name}:not([hidden])`);
          if (!canvas) return "";
          const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          return data.some((byte) => byte) ? canvas.toDataURL() : "";
        }""",
        canvas,
    )
    return found


def test_points_and_sounds(browser: Browser, sensors: View) -> None:
    page = browser.open(sensors.url)
    wait_until(lambda: painted(page, ".space") and painted(page, ".wave"))
    before, heard = painted(page, ".space"), painted(page, ".wave")
    page.focus(".space")
    page.keyboard.press("ArrowLeft")
    wait_until(lambda: painted(page, ".space") != before, what="the points are turned")
    assert "0.000 of 1.0 s" in state(page)  # the key was not for the time line
    page.dblclick(".space")
    wait_until(lambda: painted(page, ".space") == before)
    page.click("#forth")
    wait_until(lambda: painted(page, ".space") != before and painted(page, ".wave") != heard)
    page.locator("figure", has_text="/ear").get_by_text("Hear").click()
    assert page.get_attribute("figure:has-text('/ear') .hear", "aria-pressed") == "true"
    assert "300 points of /depth" in (page.get_attribute(".space", "aria-label") or "")


def test_files_logs_and_names_of_joints(browser: Browser, tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        writer.attach("walk.xml", b"<application/>", "application/xml")
        for n in range(3):
            time = START + n * SECOND
            line = ["[/log/lab/demo/7]", f"(level INFO) (systemtime 12.5) (message line{n})"]
            writer.add("/log", "", time, payload_of(line))
            state_ = [[[1, 2], "f"], ["hip", "knee"], [n + 0.5, 7.0], [], []]
            writer.add("/joints", "", time, payload_of(state_))
    with FileSource([tmp_path / "x.mcap"]) as source, View(source, port=0) as view:
        page = browser.open(view.url)
        wait_until(lambda: "knee position 7" in card(page, "/joints"))
        assert "hip position 0.5" in card(page, "/joints")
        assert page.get_by_role("link", name="walk.xml").get_attribute("download") == "walk.xml"
        wait_until(lambda: "INFO /log/lab/demo/7: line0" in card(page, "/log"))
        page.keyboard.press("End")  # where one is led at once, the lines before are there, too
        wait_until(
            lambda: "line2" in card(page, "/log") and "hip position 2.5" in card(page, "/joints")
        )
        assert "line1" in card(page, "/log") and "line0" in card(page, "/log")


def test_two_recordings(browser: Browser, tmp_path: Path) -> None:
    """The same port of both, at one cursor; the second one begins later then."""
    for name, base in (("one", 0), ("two", 100)):
        with McapWriter(tmp_path / f"{name}.mcap") as writer:
            for n in range(10):
                time = START + (base + n) * SECOND
                writer.add("/a", f"{n} 1", time, payload_of([base + n]))
    first, second = (FileSource([tmp_path / f"{name}.mcap"]) for name in ("one", "two"))
    with BesideSource(first, second) as source, View(source, port=0) as view:
        page = browser.open(view.url)
        wait_until(lambda: "100" in card(page, "/B/a"))
        for _ in range(3):
            page.keyboard.press("ArrowRight")
        wait_until(lambda: "103" in card(page, "/B/a") and "3" in text_of(page, "/A/a"))
        page.fill("#beside input", "2")
        page.keyboard.press("Enter")
        # What Playwright knows of the address is brought up to date by asking for something else.
        wait_until(lambda: page.locator("figure").count() == 2 and "offset=2" in page.url)
        page.keyboard.press("End")
        wait_until(lambda: text_of(page, "/A/a") == "9" and text_of(page, "/B/a") == "109")
        assert "of 11.0 s" in state(page)
        page.keyboard.press("Home")
        wait_until(lambda: text_of(page, "/A/a") == "0")
        assert "nothing came until here" in card(page, "/B/a")


def text_of(page: Page, name: str) -> str:
    """The message that is shown of a port."""
    return page.locator("figure", has_text=name).locator(".text").inner_text().strip()
