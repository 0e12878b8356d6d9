"""The page of pictures in a real browser."""

from __future__ import annotations

import json
import re
import socket
import threading
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.browser import OUTPUT, Browser
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.views.picture import Picture
from yarpy.kits.views.viewer import Viewer

if TYPE_CHECKING:
    from playwright.sync_api import Page

RED, GREEN, BLUE = (220, 20, 30), (30, 200, 40), (20, 40, 230)


def plain(colour: tuple[int, int, int], width: int = 64, height: int = 48) -> yarpy.Image:
    return yarpy.Image(np.full((height, width, 3), colour, "u1"))


class Room:
    """A viewer with its ports, and a camera for each."""

    def __init__(self, names: yarpy.LocalNames, ports: list[yarpy.BufferedPort]) -> None:
        self.names = names
        self.ports = ports
        self.pictures = [Picture(port) for port in ports]
        self.cameras = [yarpy.Port(f"/cam/{n}", names=names) for n in range(len(ports))]
        for camera, port in zip(self.cameras, ports, strict=True):
            camera.connect(port.name)
        self.url = f"http://{ports[0].address}/"

    def close(self) -> None:
        for port in (*self.cameras, *self.ports):
            port.close()


@contextmanager
def room(browser: Browser, *ports: str, **options: Any) -> Iterator[Room]:
    """The pages close before the ports do: they would complain that nobody answers."""
    names = yarpy.LocalNames()
    found = Room(names, [yarpy.BufferedPort(name, names=names) for name in ports])
    try:
        Viewer(found.pictures, **options)
        yield found
    finally:
        browser.close()
        found.close()


@contextmanager
def filming(camera: yarpy.Port, image: Callable[[int], object], rate: float) -> Iterator[None]:
    """Send pictures all the time."""
    stop = threading.Event()

    def run() -> None:
        number = 0
        while not stop.wait(1 / rate):
            camera.write(image(number), yarpy.Stamp(number, number / rate))
            number += 1

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join(HANG)


def colour(page: Page, number: int = 0) -> list[int]:
    """The pixel in the middle of a picture on the page; its alpha is 0 before anything is drawn."""
    script = """number => {
        const canvas = document.querySelectorAll("canvas")[number];
        if (!canvas) return [0, 0, 0, 0];
        const x = canvas.width >> 1, y = canvas.height >> 1;
        return [...canvas.getContext("2d").getImageData(x, y, 1, 1).data];
    }"""
    found: list[int] = page.evaluate(script, number)
    return found


def is_shown(page: Page, wanted: tuple[int, int, int], number: int = 0) -> bool:
    found = colour(page, number)
    return found[3] == 255 and all(abs(a - b) < 12 for a, b in zip(found, wanted, strict=False))


def shows(page: Page, wanted: tuple[int, int, int], number: int = 0) -> None:
    def look() -> bool:
        page.wait_for_timeout(20)
        return is_shown(page, wanted, number)

    wait_until(look, HANG, f"{wanted} is on the screen")


def reads(page: Page, selector: str, pattern: str) -> None:
    """Wait until the text there says so."""
    from playwright.sync_api import expect

    expect(page.locator(selector).first).to_have_text(re.compile(pattern), timeout=HANG * 1000)


def test_pictures_and_what_is_told_of_them(browser: Browser) -> None:
    with room(browser, "/left", "/right", quality=90) as here:
        page = browser.open(here.url)
        reads(page, ".says", "No picture came yet")
        here.cameras[0].write(plain(RED))
        here.cameras[1].write(plain(BLUE, 80, 20))
        shows(page, RED, 0)
        shows(page, BLUE, 1)
        assert page.locator(".name").all_inner_texts() == ["/left", "/right"]
        assert page.title() == "/left /right - yarpy view"
        facts = page.locator(".facts")
        reads(page, ".facts >> nth=1", r"^80 . 20 rgb · .* old · 0 replaced · from /cam/1 \(tcp\)$")
        with filming(here.cameras[0], lambda n: plain(GREEN if n % 2 else RED), 15):
            reads(page, ".facts >> nth=0", r"· \d[.\d]*/s · ")
            reads(page, "#state", "^1 of 2 pictures moving$")
            # Both came at once: they are side by side.
            left, right = (box.bounding_box() for box in page.locator("figure").all())
            assert left is not None and right is not None
            assert left["y"] == right["y"] and right["x"] >= left["x"] + left["width"]
        assert "quality.90" in here.ports[0].outputs[0].carrier
        reads(page, ".facts >> nth=0", r"· [3-9]\.?\d* s old")
        assert "warn" in (facts.first.get_attribute("class") or "")


def test_a_picture_that_stays_says_why(browser: Browser) -> None:
    with room(browser, "/view") as here:
        page = browser.open(here.url)
        here.cameras[0].write(plain(RED))
        shows(page, RED)
        assert page.locator(".still").count() == 0
        reads(
            page,
            "figure .banner",
            "^This picture is .* old. /cam/0 is connected, but sends nothing",
        )
        assert page.locator("figure.still").count() == 1
        here.cameras[0].disconnect("/view")
        reads(page, "figure .banner", "Nobody sends pictures here: yarpy connect /CAMERA /view$")
        here.pictures[0].wait_for('Waiting for /cam/0: no port "/cam/0" is registered')
        reads(page, "figure .banner", "Waiting for /cam/0: no port")
        here.cameras[0].write(plain(GREEN))
        here.cameras[0].connect("/view")
        here.cameras[0].write(plain(GREEN))
        here.pictures[0].wait_for("")
        shows(page, GREEN)
        wait_until(lambda: page.locator(".still").count() == 0)


def test_pause_costs_nothing_and_goes_on(browser: Browser) -> None:
    with room(browser, "/view") as here:
        page = browser.open(here.url)
        here.cameras[0].write(plain(RED))
        shows(page, RED)
        page.get_by_role("button", name="Pause", exact=True).click()
        assert page.locator(".badge").is_visible()
        wait_until(lambda: not here.ports[0].outputs, HANG, "nobody is watching")
        here.cameras[0].write(plain(GREEN))
        wait_until(lambda: here.pictures[0].status()["frames"] == 2)
        page.wait_for_timeout(500)
        assert is_shown(page, RED)
        page.keyboard.press("Escape")
        page.locator("h1").click()
        page.keyboard.press("Space")
        shows(page, GREEN)
        assert page.locator(".badge").is_hidden()
        page.keyboard.press("Space")
        assert page.locator(".badge").is_visible()


def test_a_page_that_nobody_sees_costs_nothing(browser: Browser) -> None:
    hide = """hidden => {
        Object.defineProperty(document, "hidden", {configurable: true, get: () => hidden});
        document.dispatchEvent(new Event("visibilitychange"));
    }"""
    with room(browser, "/view") as here:
        page = browser.open(here.url)
        here.cameras[0].write(plain(RED))
        shows(page, RED)
        page.evaluate(hide, True)
        wait_until(lambda: not here.ports[0].outputs, HANG, "nobody is watching")
        here.cameras[0].write(plain(BLUE))
        page.evaluate(hide, False)
        shows(page, BLUE)


def test_snapshots(browser: Browser) -> None:
    with room(browser, "/view/left") as here:
        page = browser.open(here.url)
        reads(page, ".name", "/view/left")
        assert page.locator(".jpeg").is_disabled()
        here.cameras[0].write(plain(BLUE))
        shows(page, BLUE)
        for kind, start in (("jpeg", b"\xff\xd8"), ("png", b"\x89PNG")):
            with page.expect_download() as waiting:
                page.locator(f".{kind}").click()
            name = waiting.value.suggested_filename
            ending = kind.replace("e", "")
            assert re.fullmatch(rf"view-left_\d{{4}}-\d\d-\d\d_[\d-]+\.\d+\.{ending}", name), name
            assert waiting.value.path().read_bytes().startswith(start)


def test_what_is_no_picture_is_said_and_never_run(browser: Browser) -> None:
    evil = "<script>window.bad=1</script><img/src=x/onerror=window.bad=1>"
    with room(browser, f"/{evil}") as here:
        page = browser.open(here.url)
        here.cameras[0].write([evil, 1])
        reads(page, ".banner", r"^1 message was no picture\. The last came from /cam/0: .*<script>")
        here.cameras[0].write([2])
        reads(page, ".banner", r"^2 messages were no pictures\. The last came from /cam/0: 2$")
        here.cameras[0].write(plain(GREEN))
        shows(page, GREEN)
        reads(page, ".name", "<script>window.bad=1</script>")
        assert "<script>" in page.title()
        assert page.evaluate("window.bad") is None
        assert page.locator("script").count() == 1
        assert page.locator("img").count() == 0


def test_clicks(browser: Browser) -> None:
    with (
        room(browser, "/one", "/two") as here,
        yarpy.BufferedPort("/clicks", strict=True, names=here.names) as heard,
        yarpy.Port("/out", names=here.names) as out,
    ):
        Viewer(here.pictures, clicks=[out])
        out.connect("/clicks")
        page = browser.open(here.url)
        for camera in here.cameras:
            camera.write(plain(RED, 100, 50))
        shows(page, RED, 0)
        shows(page, RED, 1)
        page.wait_for_selector("canvas.clicks")

        def at(x: float, y: float) -> tuple[float, float]:
            """Where this place of the picture is by now: rates beside it may still move it."""
            box = page.locator("canvas").first.bounding_box()
            assert box is not None
            scale = min(box["width"] / 100, box["height"] / 50)
            left, top = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
            return left + (x - 50) * scale, top + (y - 25) * scale

        page.mouse.click(*at(50.5, 25.5))
        assert heard.read(timeout=HANG).value == [50, 25]
        page.mouse.move(*at(9.6, 4.6))
        page.mouse.down()
        page.mouse.move(*at(60.6, 30.6))
        page.mouse.up()
        assert list(heard.read(timeout=HANG).value) == [9, 4, 60, 30]
        page.locator("canvas").nth(1).click()  # nobody wants to know
        box = page.locator("canvas").first.bounding_box()
        assert box is not None
        page.mouse.click(box["x"] + box["width"] / 2, box["y"] + 1)  # beside the picture, if there
        assert here.ports[0].waiting == 0
        assert here.pictures[0].status()["others"] == 0
        # What no page sends changes nothing.
        for bad in ('["click", 7, 1, 2]', '["click", 0, 1]', '["click", 0, "x", 1]', '["click"]'):
            body = f'{{"admin": 1, "req": {bad}}}'.encode()
            request = urllib.request.Request(
                f"{here.url}form", body, {"Content-Type": "application/json"}
            )
            with urllib.request.urlopen(request, timeout=HANG) as response:
                assert json.load(response)[0] == "fail"


def test_a_picture_stays_where_it_is_while_a_pointer_is_down(browser: Browser) -> None:
    """What is told beside it, of other lengths, would move it under the pointer."""
    with room(browser, "/one") as here, yarpy.BufferedPort("/out", names=here.names) as out:
        Viewer(here.pictures, clicks=[out])
        page = browser.open(here.url)
        here.cameras[0].write(plain(RED, 100, 50))
        shows(page, RED)
        page.wait_for_selector("canvas.clicks")
        box = page.locator("canvas").first.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        page.mouse.down()
        told = page.locator(".facts").first.text_content()
        with yarpy.Port("/another/camera", names=here.names) as other:
            other.connect(here.ports[0].name)
            for _ in range(3):  # the last of which was asked for behind that
                with page.expect_response("**/status"):
                    pass
            assert page.locator(".facts").first.text_content() == told
            assert page.locator("canvas").first.bounding_box() == box
            page.mouse.up()
            reads(page, ".facts", "/another/camera")


def test_a_stalled_browser_costs_nothing(browser: Browser) -> None:
    noise = yarpy.Image(np.random.default_rng(1).integers(0, 255, (480, 640, 3), "u1"))
    with room(browser, "/view") as here, socket.socket() as stalled:
        stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 12)
        contact = here.ports[0].contact
        stalled.connect((contact.host, contact.port))
        host = f"Host: {contact.host}\r\n\r\n".encode()
        stalled.sendall(b"GET /?action=stream HTTP/1.1\r\n" + host)
        assert here.ports[0].wait_for_outputs(timeout=HANG)

        def stuck() -> bool:
            here.cameras[0].write(noise)
            return any(link.stats.replaced > 3 for link in here.ports[0].outputs)

        wait_until(stuck, HANG, "the stalled reader misses pictures")
        page = browser.open(here.url)
        for wanted in (RED, GREEN, BLUE):
            here.cameras[0].write(plain(wanted))
            shows(page, wanted)
        assert len(here.ports[0].outputs) == 2


def test_a_browser_that_leaves_is_forgotten(browser: Browser) -> None:
    with room(browser, "/view") as here:
        page = browser.open(here.url)
        here.cameras[0].write(plain(RED))
        shows(page, RED)
        page.close()
        wait_until(lambda: not here.ports[0].outputs)


def test_a_program_that_ends_is_missed(browser: Browser) -> None:
    browser.excuse("ERR_CONNECTION_REFUSED|ERR_INCOMPLETE_CHUNKED|ERR_EMPTY_RESPONSE|RESET")
    with room(browser, "/view") as here:
        page = browser.open(here.url)
        here.cameras[0].write(plain(RED))
        shows(page, RED)
        here.close()
        reads(page, "#state", "the program does not answer")
        assert is_shown(page, RED)


def scene(number: int) -> yarpy.Image:
    y, x = np.mgrid[:240, :320]
    array = np.stack([x * 0.8, y, 255 - x * 0.5], -1).astype("u1")
    array[90:150, 40 + number % 200 : 100 + number % 200] = (255, 180, 40)
    return yarpy.Image(array)


def depth(number: int) -> yarpy.Image:
    y, x = np.mgrid[:240, :320]
    return yarpy.Image((np.hypot(x - 160 + number % 50, y - 120) / 60).astype("f4"))


@pytest.mark.parametrize("look", ["light", "dark", "phone"])
def test_how_it_looks(browser: Browser, look: str) -> None:
    with room(browser, "/view/left", "/view/depth", "/view/other") as here:
        here.pictures[2].wait_for('Waiting for /cam/right: no port "/cam/right" is registered')
        page = browser.open(here.url, dark=look == "dark", phone=look == "phone")
        here.cameras[2].write(["a list of words"])
        with filming(here.cameras[0], scene, 20), filming(here.cameras[1], depth, 10):
            reads(page, ".facts >> nth=0", r"320 . 240 rgb · \d[.\d]*/s")
            reads(page, ".facts >> nth=1", r"320 . 240 dec · 0 … [\d.]+ · \d[.\d]*/s")
            reads(page, ".banner >> nth=2", "a list of words")
            browser.picture(page, f"view_{look}", whole=True)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert (OUTPUT / f"view_{look}.png").exists()
