"""Curves in a real browser, and what the page is told."""

from __future__ import annotations

import json
import math
import re
import threading
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

import pytest
from support.browser import OUTPUT, Browser
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.sim.robot import Robot, icub_head
from yarpy.kits.views.scope import SOURCES, Scope

if TYPE_CHECKING:
    from playwright.sync_api import Page


class Bench:
    """A scope on a port, and ports that send to it."""

    def __init__(self, scope: Scope, names: yarpy.LocalNames, port: yarpy.Port) -> None:
        self.scope, self.names, self.port = scope, names, port
        self.stack = ExitStack()
        self.url = f"http://{port.address}/"

    def source(self, name: str) -> yarpy.Port:
        port = self.stack.enter_context(yarpy.Port(name, names=self.names))
        port.connect("/scope")
        return port

    def told(self, query: str = "") -> dict[str, Any]:
        with urllib.request.urlopen(f"{self.url}data{query}", timeout=HANG) as answer:
            found: dict[str, Any] = json.load(answer)
            return found


@contextmanager
def bench(browser: Browser | None, *args: Any, number: int = 0, **options: Any) -> Iterator[Bench]:
    """The pages close before the ports do: they would complain that nobody answers."""
    names = yarpy.LocalNames()
    scope = Scope(*args, **options)
    with yarpy.Port("/scope", names=names, tcp_port=number, callback=scope.take) as port:
        scope.serve(port)
        found = Bench(scope, names, port)
        with found.stack:
            try:
                yield found
            finally:
                if browser is not None:
                    browser.close()


@contextmanager
def sending(port: yarpy.Port, value: Callable[[float], object], rate: float) -> Iterator[None]:
    stop = threading.Event()

    def run() -> None:
        number = 0
        while not stop.wait(1 / rate):
            now = time.time()
            port.write(value(now), yarpy.Stamp(number, now))
            number += 1

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join(HANG)


def reads(page: Page, selector: str, pattern: str) -> None:
    from playwright.sync_api import expect

    expect(page.locator(selector).first).to_have_text(re.compile(pattern), timeout=HANG * 1000)


def lists(page: Page, selector: str, texts: list[str]) -> None:
    """Wait until the elements there say these."""
    from playwright.sync_api import expect

    expect(page.locator(selector)).to_have_text(texts, timeout=HANG * 1000)


# The vertical places, from 0 at the top to 1, of all pixels of about a colour in a plot.
PLACES = """([number, red, green, blue]) => {
    const canvas = document.querySelectorAll("canvas")[number];
    if (!canvas) return [];
    const {width, height} = canvas;
    const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
    const found = [];
    for (let at = 0; at < data.length; at += 4) {
        const away = Math.max(Math.abs(data[at] - red), Math.abs(data[at + 1] - green),
            Math.abs(data[at + 2] - blue));
        if (away < 25 && data[at + 3] > 100) found.push(Math.floor(at / 4 / width) / height);
    }
    return found;
}"""
BLUE, ORANGE, GREEN = (0x00, 0x72, 0xB2), (0xD5, 0x5E, 0x00), (0x00, 0x9E, 0x73)


def places(page: Page, colour: tuple[int, int, int], number: int = 0) -> list[float]:
    found: list[float] = page.evaluate(PLACES, [number, *colour])
    return found


def drawn(page: Page, colour: tuple[int, int, int], number: int = 0, least: int = 40) -> None:
    def look() -> bool:
        page.wait_for_timeout(30)
        return len(places(page, colour, number)) >= least

    wait_until(look, HANG, f"a curve of the colour {colour}")


def test_what_is_told() -> None:
    with bench(None, ["/b", "/a"], (), {"window": 5.0}) as here:
        here.scope.wait_for("/b", "not there")
        a, c = here.source("/a"), here.source("/c")
        a.write([1, 2.5])
        a.write([3, math.nan])
        c.write(["x"])

        def all_came() -> bool:
            *_, numbers, words = here.told()["sources"]
            return len(numbers["rows"]) == 2 and bool(words["empty"])

        wait_until(all_came)
        told = here.told()
        assert [one["name"] for one in told["sources"]] == ["/b", "/a", "/c"]
        assert [one["carrier"] for one in told["sources"]] == ["", "tcp", "tcp"]
        assert [row[1:] for row in told["sources"][1]["rows"]] == [[1, 2.5], [3, None]]
        assert (told["name"], told["view"]) == ("/scope", {"window": 5.0})
        assert told["waiting"] == ["not there"]
        here.scope.wait_for("/b", "")
        told = here.told("?after=0,1")
        assert [len(one["rows"]) for one in told["sources"]] == [0, 1, 0]
        assert told["waiting"] == []
        for odd in ("?after=", "?after=x,-1,1e9", f"?after={'9' * 99},2", "?after=" + ",9" * 999):
            assert len(here.told(odd)["sources"][1]["rows"]) in (0, 2)


def test_more_sources_than_can_be_drawn() -> None:
    with bench(None) as here:
        for number in range(SOURCES + 2):
            here.source(f"/s{number}").write([number])
        wait_until(lambda: here.told()["refused"] == 2)
        assert len(here.told()["sources"]) == SOURCES


def test_curves(browser: Browser) -> None:
    with bench(browser, ["/arm"]) as here:
        page = browser.open(here.url)
        reads(page, ".says", "Nothing came yet")
        arm = here.source("/arm")
        with sending(arm, lambda t: [5.0, ["speed", -5.0], "word"], 50):
            drawn(page, BLUE)
            drawn(page, ORANGE)
            # The larger number is above the other.
            assert max(places(page, BLUE)) < min(places(page, ORANGE))
            reads(
                page, ".facts", r"^tcp · \d[.\d]*/s · skipped, being no numbers: speed at 1, word"
            )
            lists(page, ".label", ["0", "2 speed"])
            lists(page, ".value", ["5", "-5"])
            reads(page, "#state", r"^\d+ points$")
            assert page.title() == "/arm - yarpy scope"
            # A curve that is switched off is gone, the other stays.
            page.locator(".curve").first.click()
            wait_until(lambda: not places(page, BLUE))
            drawn(page, ORANGE)
            page.locator(".curve").first.click()
            drawn(page, BLUE)


def test_joints_and_sensors_have_names_and_units(browser: Browser) -> None:
    with yarpy.NameServer() as server:
        scope = Scope()
        with (
            Robot("/sim", icub_head(), names=server.client) as robot,
            yarpy.Port("/scope", names=server.client, callback=scope.take) as port,
        ):
            assert robot
            scope.serve(port, server.client)
            for name in ("/sim/head/state:o", "/sim/inertial/measures:o"):
                yarpy.connect(name, "/scope", names=server.client)
            page = browser.open(f"http://{port.address}/")
            reads(page, "figure:has-text('state:o') .label >> nth=0", "^0 neck_pitch$")
            reads(page, "figure:has-text('state:o') .value >> nth=0", r"^-?\d.*\d°$|^0°$")
            imu = "figure:has-text('measures:o')"
            reads(page, f"{imu} .label >> nth=3", "^4 head_imu accelerometer x$")
            reads(page, f"{imu} .value >> nth=5", r"^9.8\d* m/s²$")
            browser.picture(page, "scope_robot", whole=True)
            # One unit for all curves of a plot stands at its axis.
            for place in (0, 1, 2, 6, 7, 8):
                page.locator(f"{imu} .curve").nth(place).click()
            page.wait_for_timeout(500)
            browser.picture(page, "scope_unit", whole=True)
            browser.close()


def test_pause_hover_and_time(browser: Browser) -> None:
    with bench(browser) as here:
        page = browser.open(here.url)
        reads(page, ".command", "^yarpy connect /PORT /scope$")
        ramp = here.source("/ramp")
        started = time.time()
        with sending(ramp, lambda t: [t - started], 100):
            drawn(page, BLUE)
            page.wait_for_timeout(1000)
            page.get_by_role("button", name="Pause").click()
            reads(page, "#state", ", paused$")

            def still() -> bool:
                before = places(page, BLUE)
                page.wait_for_timeout(300)
                return places(page, BLUE) == before

            wait_until(still, HANG, "nothing moves")
            # Values under the pointer: they grow from left to right.
            page.locator("#window").fill("1")
            box = page.locator("canvas").bounding_box()
            assert box is not None
            found: list[float] = []

            def look() -> bool:
                found.clear()
                for share in (0.4, 0.6, 0.8):
                    page.mouse.move(box["x"] + box["width"] * share, box["y"] + box["height"] / 2)
                    page.wait_for_timeout(300)
                    found.append(float(page.locator(".value").inner_text()))
                seconds = 0.4 * box["width"] / (box["width"] - 70)
                grow = found == sorted(found)
                return grow and found[2] - found[0] == pytest.approx(seconds, abs=0.1)

            wait_until(look, HANG, "a second is as wide as the page")
            # Dragging goes back in time, the wheel takes more of it.
            page.mouse.down()
            page.mouse.move(box["x"] + box["width"] * 0.95, box["y"] + box["height"] / 2)
            page.mouse.up()
            page.wait_for_timeout(300)
            page.mouse.move(box["x"] + box["width"] * 0.8, box["y"] + box["height"] / 2)
            wait_until(lambda: float(page.locator(".value").inner_text()) < found[2])
            page.mouse.wheel(0, 100)
            wait_until(lambda: page.locator("#window").input_value() == "1.15")
            page.locator("h1").click()
            page.keyboard.press("Space")
            reads(page, "#state", "points$")


def test_range_of_the_axis(browser: Browser) -> None:
    with bench(browser, (), (1,), {"min": 0.0, "max": 100.0, "window": 3.0}) as here:
        page = browser.open(here.url)
        wait_until(lambda: page.locator("#max").input_value() == "100")
        assert page.locator("#min").input_value() == "0"
        assert page.locator("#window").input_value() == "3"
        with sending(here.source("/s"), lambda t: [-7, 90.0], 50):
            drawn(page, BLUE)
            assert max(places(page, BLUE)) < 0.3
            page.locator("#min").fill("85")
            page.locator("#max").fill("")
            wait_until(lambda: min(places(page, BLUE), default=0) > 0.3)
            lists(page, ".label", ["1"])
            reads(page, ".facts", "1 number more: --index draws others")


# The seconds of a plot of 20 s in which something is drawn, of messages at these times.
DRAWN = """async (times) => {
    const {Plot} = await import("/*/plot.js");
    const canvas = document.createElement("canvas");
    canvas.style = "width: 1000px; height: 200px";
    document.body.prepend(canvas);
    const view = {end: 20, window: 20, low: 0, high: 10, hover: null};
    const plot = new Plot(canvas);
    const before = [];
    const look = (curves) => {
        plot.draw(curves, view);
        const {width, height} = canvas;
        return [...canvas.getContext("2d").getImageData(0, 0, width, height).data];
    };
    const [empty, full] = [look([]), look([{times, values: times.map(() => 5.3), number: 0}])];
    const found = new Set();
    full.forEach((value, at) => {
        const x = (at >> 2) % canvas.width;
        if (value !== empty[at]) found.add(Math.floor(plot.timeAt(x, view)));
    });
    canvas.remove();
    return [...found].filter((second) => second >= 0 && second < 20).sort((a, b) => a - b);
}"""


@pytest.mark.parametrize("rate", [10, 2000], ids=["few", "many"])
def test_no_line_is_drawn_across_an_outage(browser: Browser, rate: int) -> None:
    with bench(browser) as here:
        page = browser.open(here.url)
        times = [start + n / rate for start in (1.2, 7.2) for n in range(rate)] + [15.5]
        assert page.evaluate(DRAWN, times) == [1, 2, 7, 8, 15]
        # A port that sends a message every three seconds has no outage, nor one that hesitates.
        slow = [0.5, 3.5, 6.5, 9.5, 12.5, 15.5, 18.5]
        assert page.evaluate(DRAWN, slow) == [*range(19)]
        hesitating = [n / rate for n in range(5 * rate)] + [5.4 + n / rate for n in range(rate)]
        assert page.evaluate(DRAWN, hesitating) == [*range(7)]


def test_several_ports_in_one_plot(browser: Browser) -> None:
    with bench(browser, ["/one", "/two"]) as here:
        page = browser.open(here.url)
        one, two = here.source("/one"), here.source("/two")
        with sending(one, lambda t: [1.0], 30), sending(two, lambda t: [2.0], 30):
            drawn(page, BLUE, 0)
            drawn(page, BLUE, 1)
            page.get_by_role("button", name="In one plot").click()
            drawn(page, BLUE, 0)
            drawn(page, ORANGE, 0)
            assert page.locator("canvas").count() == 1
            lists(page, ".label", ["/one 0", "/two 0"])
            page.get_by_role("button", name="In one plot").click()
            assert page.locator("canvas").count() == 2


def test_thousands_of_points(browser: Browser) -> None:
    with bench(browser) as here:
        page = browser.open(here.url)
        port = here.source("/fast")
        for number in range(5000):
            port.write([math.sin(number / 50), 3 + math.cos(number / 50), number % 2 - 3])
        page.locator("#window").fill("60")
        reads(page, "#state", "^15000 points$")
        for colour in (BLUE, ORANGE, GREEN):
            drawn(page, colour, least=20)
        count = "Number(document.body.dataset.drawings)"
        first = page.evaluate(count)
        wait_until(lambda: page.evaluate(count) > first + 10, HANG, "it is drawn again")


def test_nothing_that_came_is_run(browser: Browser) -> None:
    evil = "<script>window.bad=1</script><img/src=x/onerror=window.bad=1>"
    with bench(browser) as here:
        here.scope.wait_for("x", f"Waiting for {evil}")
        page = browser.open(here.url)
        port = here.source(f"/{evil}")
        port.write([evil, 1.0])
        port.write([evil])
        reads(page, ".name", "^/<script>window.bad=1</script>")
        reads(page, ".label", "^1 <script>")
        reads(page, "figure .banner", "1 message had no number. The last: no number in: .*<script>")
        reads(page, "#banners .banner", "Waiting for <script>")
        assert page.evaluate("window.bad") is None
        assert page.locator("script").count() == 1
        assert page.locator("img").count() == 0


def test_a_program_that_is_started_again(browser: Browser) -> None:
    browser.excuse("ERR_|Failed to load")
    with bench(None) as here:
        page = browser.open(here.url)
        with sending(here.source("/old"), lambda t: [1.0, 2.0], 30):
            drawn(page, ORANGE)
            page.locator("#window").fill("5")
        number = here.port.contact.port
    reads(page, "#state", "the program does not answer")
    with bench(browser, number=number) as here, sending(here.source("/new"), lambda t: [1.0], 30):
        reads(page, ".name", "^/new$")
        drawn(page, BLUE)
        assert not places(page, ORANGE)
        assert page.locator("#window").input_value() == "5"


@pytest.mark.parametrize("look", ["light", "dark", "phone"])
def test_how_it_looks(browser: Browser, look: str) -> None:
    with bench(browser, ["/head/state", "/hand/force"], (), {"window": 3.0}) as here:
        here.scope.wait_for("/gone", 'Waiting for /gone: no port "/gone" is registered')
        head, hand = here.source("/head/state"), here.source("/hand/force")
        page = browser.open(here.url, dark=look == "dark", phone=look == "phone")

        def angles(t: float) -> list[float]:
            return [30 * math.sin(t * 2 + joint) + 5 * joint for joint in range(6)]

        def force(t: float) -> list[Any]:
            return [["fx", math.exp(-3 * (t % 1))], ["fy", math.cos(7 * t)], ["touch", t % 2 > 1]]

        with sending(head, angles, 50), sending(hand, force, 50):
            reads(page, ".facts >> nth=1", "skipped, being no numbers: fx at 0")
            page.wait_for_timeout(3500)
            if look != "phone":
                box = page.locator("canvas").first.bounding_box()
                assert box is not None
                page.mouse.move(box["x"] + box["width"] * 0.6, box["y"] + 60)
                page.wait_for_timeout(300)
            browser.picture(page, f"scope_{look}", whole=True)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert (OUTPUT / f"scope_{look}.png").exists()
