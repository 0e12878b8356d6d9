"""The page of a log: what it tells, and what a browser makes of it."""

import json
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

import yarpy
from yarpy.kits.launch.page.log_page import MOST, PROGRAMS, LogPage
from yarpy.port.keep.log_line import LogLine

if TYPE_CHECKING:
    from support.browser import Browser

EVIL = "<b>bold</b> \x1b[2J"


def line(text: str, level: str = "INFO", program: str = "arm", component: str = "") -> LogLine:
    return LogLine(f"/log/vm/{program}/7", level, text, 1795219554.5, component)


@pytest.fixture
def port(network: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/logger", names=network, callback=lambda message: None) as port:
        yield port


def told(port: yarpy.Port, **fields: object) -> dict[str, Any]:
    shown = port._program.on_page
    asked = {"most": "100", **{key: str(value) for key, value in fields.items()}}
    found: dict[str, Any] = json.loads(shown("/lines", asked).body)
    return found


def texts(port: yarpy.Port, **fields: object) -> list[str]:
    return [one[-1] for one in told(port, **fields)["lines"]]


def test_lines_are_filtered(port: yarpy.Port) -> None:
    LogPage(port).add(
        [
            line("ready"),
            line("Too Hot", "WARNING", "leg", "yarp.os"),
            line("bare", ""),
            line("gone", "ERROR", "leg"),
        ]
    )
    assert texts(port) == ["ready", "Too Hot", "bare", "gone"]
    assert texts(port, level="WARNING") == ["Too Hot", "bare", "gone"]  # nobody told how bad it is
    assert texts(port, program="leg") == ["Too Hot", "gone"]
    assert texts(port, text="too hot") == texts(port, text="YARP.os") == ["Too Hot"]
    assert texts(port, text=".*") == [], "words, and no pattern"
    assert texts(port, since=2) == ["bare", "gone"]
    assert texts(port, most=1) == ["gone"]
    assert texts(port, level="nonsense", since="-1", most="x") == []
    assert told(port, most=0)["programs"] == ["arm", "leg"]
    assert told(port)["lines"][1] == [
        2, 1795219554.5, "leg", "/log/vm/leg/7", "WARNING", "yarp.os", "Too Hot",
    ]  # fmt: skip


def test_the_oldest_are_forgotten(port: yarpy.Port) -> None:
    shown = LogPage(port, kept=3)
    shown.add([line(str(number)) for number in range(5)])
    assert texts(port) == texts(port, since=1) == ["2", "3", "4"]
    assert texts(port, since=4) == ["4"] and texts(port, since=5) == texts(port, since=99) == []
    shown.lost = 7
    assert (told(port)["newest"], told(port)["lost"]) == (5, 7)


def test_an_answer_has_a_limit(port: yarpy.Port) -> None:
    shown = LogPage(port)
    shown.add([line("x" * 10_000)] * (MOST + 5))
    shown.add([line("p", program=f"p{number}") for number in range(PROGRAMS + 5)])
    found = told(port, most=10**9, program="arm")
    assert len(found["lines"]) == MOST and len(found["programs"]) == PROGRAMS
    assert len(found["lines"][0][-1]) < 5000


def test_a_person_filters_and_searches(browser: "Browser", port: yarpy.Port) -> None:
    shown = LogPage(port)
    shown.add([line("ready"), line(EVIL, "ERROR", "leg", "yarp.os"), line("warm", "WARNING")])
    page = browser.open(f"http://{port.address}/")
    page.get_by_text("3 lines · 2 programs").wait_for()
    rows = page.locator("#lines > div")
    page.get_by_text(re.compile(r"<b>bold</b>")).wait_for()  # as text
    page.get_by_label("Least bad level").select_option("WARNING")
    page.locator("#lines").get_by_text("ready").wait_for(state="detached")
    page.get_by_label("Program").select_option("leg")
    page.locator("#lines").get_by_text("warm").wait_for(state="detached")
    page.get_by_text("yarpy log --level WARNING --program leg").wait_for()
    page.keyboard.press("Escape")
    page.get_by_label("Least bad level").select_option("")
    page.get_by_label("Program").select_option("")
    page.locator("#lines").get_by_text("ready").wait_for()
    page.get_by_label("Show lines that contain this").fill("WARM")
    page.locator("#lines").get_by_text("ready").wait_for(state="detached")
    shown.add([line("cold"), line("warm again", "FATAL", "new")])
    page.get_by_text("warm again").wait_for()
    page.get_by_text("5 lines · 3 programs").wait_for()
    assert rows.count() == 2
    page.get_by_label("Show lines that contain this").fill("")
    page.get_by_text("cold").wait_for()
    browser.picture(page, "log")
    page.get_by_role("button", name="Follow").click()
    assert page.get_by_role("button", name="Follow").get_attribute("aria-pressed") == "false"
    small = browser.open(f"http://{port.address}/", dark=True, phone=True)
    small.get_by_text("warm again").wait_for()
    browser.picture(small, "log-phone")
