"""The page of the network: what it serves, and what a real browser makes of it."""

from __future__ import annotations

import json
import re
import threading
import urllib.error
import urllib.request
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest
from support.access import allow
from support.http_error import http_error
from support.network import large
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.views import dash
from yarpy.kits.views.dash import Dash

if TYPE_CHECKING:
    from pathlib import Path

    from support.browser import Browser

EVIL = "/<img_src=x_onerror=hacked()>"


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def url(names: yarpy.LocalNames) -> Iterator[str]:
    with yarpy.Port("/dash", names=names) as port:
        shown = Dash(port, names)
        yield f"http://{port.address}"
        shown.close()


@pytest.fixture
def out(names: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/out", names=names) as port, yarpy.BufferedPort("/in", names=names):
        yield port


def get(url: str) -> Any:
    with urllib.request.urlopen(url, timeout=HANG) as answer:
        return json.load(answer)


def post(url: str, *words: str) -> Any:
    body = json.dumps({"admin": 1, "req": ["dash", *words]}).encode()
    head = {"Content-Type": "application/json"}
    request = urllib.request.Request(f"{url}/form", body, head)
    with urllib.request.urlopen(request, timeout=HANG) as answer:
        return json.load(answer)


def test_pages(url: str, out: yarpy.Port) -> None:
    for path in ("/", "/dash.js", "/dash.css", "/dash_layout.js"):
        with urllib.request.urlopen(f"{url}{path}", timeout=HANG) as answer:
            assert answer.status == 200
    wait_until(lambda: get(f"{url}/network?since=-1&event=0").get("ports"))
    found = get(f"{url}/network?since=x&event=999999999999999999999")
    assert {"/out", "/in", "/dash"} == {port["name"] for port in found["ports"]}
    assert "ports" not in get(f"{url}/network?since={found['version']}&event=0")
    assert get(f"{url}/peek?port=/nobody")["problem"]
    with http_error(404):
        urllib.request.urlopen(f"{url}/peek.jpg?port=/out", timeout=HANG)


def test_changes(url: str, out: yarpy.Port) -> None:
    assert post(url, "connect", "/out", "/in", "fast_tcp")[0] == "ok"
    assert str(out.outputs[0].carrier) == "fast_tcp"
    assert get(f"{url}/network")["undo"] == "disconnect /out → /in"
    assert post(url, "connect", "/out", "/nowhere", "")[0] == "fail"
    assert post(url, "undo")[0] == "ok"
    wait_until(lambda: not out.outputs)
    wait_until(
        lambda: any("by hand: connected" in one[2] for one in get(f"{url}/network")["events"])
    )


def test_who_may_only_read_changes_nothing(
    names: yarpy.LocalNames, out: yarpy.Port, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with yarpy.Port("/dash", names=names) as port:
        shown = Dash(port, names)
        with http_error(403):
            post(f"http://{port.address}", "connect", "/out", "/in", "")
        shown.close()
    assert not out.outputs


def test_nobody_is_asked_while_nobody_looks(
    names: yarpy.LocalNames, out: yarpy.Port, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dash, "WANTED", 0.0)
    with yarpy.Port("/dash", names=names) as port:
        shown = Dash(port, names)
        assert shown._thread is None
        get(f"http://{port.address}/network")
        wait_until(lambda: shown._view.snapshot is not None)
        wait_until(lambda: shown._thread is None and not out.inputs)
        shown.close()


def test_no_name_server(names: yarpy.LocalNames) -> None:
    gone = yarpy.YarpNameClient("127.0.0.1", 1)
    with yarpy.Port("/dash", names=names) as port:
        shown = Dash(port, gone)
        url = f"http://{port.address}/network"
        get(url)
        wait_until(lambda: "127.0.0.1:1" in get(url)["problem"])
        shown.close()


# ------------------------------------------------------------------------------------- in a browser


def test_a_person_looks_connects_and_undoes(
    browser: Browser, url: str, names: yarpy.LocalNames, out: yarpy.Port
) -> None:
    with yarpy.Port(EVIL, names=names):
        page = browser.open(url)
        page.get_by_text(re.compile("4 ports")).wait_for()
        page.get_by_role("button", name="List").click()
        page.get_by_text("no connections").wait_for()
        page.keyboard.press("/")
        page.evaluate("dash.graph.chosen('port', '/out')")
        page.get_by_label("The other port").fill("/in")
        page.get_by_role("combobox", name="Carrier").fill("fast_tcp")
        page.get_by_role("button", name="Connect to").click()
        page.get_by_role("cell", name="fast_tcp").wait_for()
        assert str(out.outputs[0].carrier) == "fast_tcp"
        page.get_by_text("none since you look").wait_for()
        out.write(["<b>bold</b>"])
        page.locator("pre").get_by_text("<b>bold</b>").wait_for()
        page.get_by_role("row", name=re.compile("fast_tcp")).click()
        page.get_by_role("heading", name="/out → /in").wait_for()
        page.get_by_role("combobox", name="Carrier").fill("tcp")
        page.get_by_role("button", name="Change carrier").click()
        page.get_by_role("button", name="Undo: /out → /in over fast_tcp again").click()
        page.get_by_role("cell", name="fast_tcp").wait_for()
        page.get_by_role("combobox", name="Carrier").fill("pigeon")
        page.get_by_role("button", name="Change carrier").click()
        page.get_by_role("alert").get_by_text("pigeon").wait_for()
        page.get_by_role("button", name="Disconnect", exact=True).click()
        page.get_by_text("no connections").wait_for()
        page.locator("summary").click()
        page.get_by_role("listitem").get_by_text("by hand: disconnected /out → /in").wait_for()
        page.evaluate(f"dash.graph.chosen('port', {EVIL!r})")
        page.get_by_role("heading", name=EVIL).wait_for()


def test_what_a_pointer_holds_stays_under_it(browser: Browser, url: str, out: yarpy.Port) -> None:
    """Ports come and go meanwhile; the picture is drawn anew when it is let go."""
    page = browser.open(url)
    page.get_by_text(re.compile("3 ports")).wait_for()
    places = "JSON.stringify([...dash.graph.map.at].map(([name, {x, y}]) => [name, x, y]))"
    before, view = page.evaluate(places), page.evaluate("dash.graph.view")
    box = page.locator("#graph").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 5, box["y"] + 5)
    page.mouse.down()
    with yarpy.Port("/aaa/comes", names=out._hub.names):
        page.get_by_text(re.compile("4 ports")).wait_for()
        assert page.evaluate(places) == before and page.evaluate("dash.graph.view") == view
        page.mouse.move(box["x"] + 45, box["y"] + 25)
        assert page.evaluate("dash.graph.view.x") == view["x"] + 40
        assert page.evaluate(places) == before
        page.mouse.up()
        assert page.evaluate("dash.graph.map.at.has('/aaa/comes')")


def test_a_thousand_ports(browser: Browser, names: yarpy.LocalNames) -> None:
    """That it is fast enough is measured by bench/dash.py; here it has to be right."""
    with yarpy.Port("/dash", names=names) as port:
        shown = Dash(port, names)
        shown._until = float("inf")
        shown._thread = dash.threading.current_thread()  # nobody else looks
        shown._view.take(large(1000, 3000))
        page = browser.open(f"http://{port.address}")
        page.get_by_text(re.compile("1000 ports · 3000 connections")).wait_for()
        browser.picture(page, "dash-thousand")
        count = page.evaluate("dash.graph.map.boxes.length")
        assert count == 100
        apart = page.evaluate(
            """() => dash.graph.map.boxes.every((a, i, all) => all.slice(i + 1).every((b) =>
            a.x + a.w <= b.x || b.x + b.w <= a.x || a.y + a.h <= b.y || b.y + b.h <= a.y))"""
        )
        assert apart  # no box covers another
        page.get_by_label(re.compile("^Search")).fill("module42/port3")
        page.get_by_role("button", name="List").click()
        rows = page.get_by_role("row").count() - 1
        assert 0 < rows < 20
        shown._thread = None
        shown.close()


def test_a_hundred_pages_cost_the_ports_no_more_than_one(url: str, out: yarpy.Port) -> None:
    answers: list[Any] = []
    pages = [
        threading.Thread(target=lambda: answers.append(get(f"{url}/network"))) for _ in range(100)
    ]
    for page in pages:
        page.start()
    for page in pages:
        page.join()
    assert len(answers) == 100
    wait_until(lambda: get(f"{url}/network?since=-1").get("ports"))
    asking = [one for one in threading.enumerate() if one.name == "yarpy dash"]
    assert len(asking) == 1  # the one that asks ports, for all of them
