"""The page of a robot, in a real browser, with the simulated head behind it."""

from __future__ import annotations

import base64
import json
import re
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.access import allow
from support.http_error import http_error
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.sig import jpeg
from yarpy.kits.sim.axis import Axis
from yarpy.kits.sim.board import Board
from yarpy.kits.sim.body import Body
from yarpy.kits.sim.joint import Joint
from yarpy.kits.sim.robot import Parts, Robot, icub_head
from yarpy.kits.views.panel import Panel

if TYPE_CHECKING:
    from playwright.sync_api import Page
    from support.browser import Browser

JOINTS = ["neck_pitch", "neck_roll", "neck_yaw", "eyes_tilt", "eyes_version", "eyes_vergence"]


@pytest.fixture(scope="module")
def names() -> Iterator[yarpy.YarpNameClient]:
    server = yarpy.NameServer()
    yield server.client
    server.close()


@pytest.fixture(scope="module")
def robot(names: yarpy.YarpNameClient) -> Iterator[Robot]:
    with Robot("/icubSim", icub_head(), names=names) as robot:
        yield robot


@pytest.fixture(scope="module")
def url(names: yarpy.YarpNameClient) -> Iterator[str]:
    with yarpy.Port("/panel", names=names) as port:
        Panel(port, "/icubSim", names)
        yield f"http://{port.address}/"


@pytest.fixture
def head(robot: Robot, names: yarpy.YarpNameClient) -> Iterator[yarpy.RpcClient]:
    """Asks the head; all joints are at zero when a test begins."""
    with yarpy.RpcClient("/icubSim/head/rpc:i", names=names) as client:
        client.call("set", "poss", [0.0] * 6)
        wait_until(lambda: max(map(abs, encoders(client))) < 0.01)
        yield client


def encoders(head: yarpy.RpcClient) -> list[float]:
    return list(head.call("get", "encs")[2])


def get(url: str) -> Any:
    with urllib.request.urlopen(url, timeout=HANG) as answer:
        return json.load(answer)


def opened(browser: Browser, url: str, **wishes: bool) -> Page:
    """The page, as soon as it shows the joints; the pictures never end."""
    page = browser.open(**wishes)
    page.goto(url, wait_until="commit")
    page.get_by_text("live: drag the sliders").wait_for()
    return page


def seen(page: Page, number: int = 0) -> list[int]:
    """The green in a camera's picture, in 8 times 6 fields."""
    shot = base64.b64encode(page.locator("#cameras canvas").nth(number).screenshot()).decode()
    script = """async shot => {
        const bytes = Uint8Array.from(atob(shot), letter => letter.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes], {type: "image/png"}));
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [8, 6];
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0, 8, 6);
        return [...context.getImageData(0, 0, 8, 6).data].filter((_, place) => place % 4 === 1);
    }"""
    found: list[int] = page.evaluate(script, shot)
    return found


def loaded(page: Page) -> bool:
    """Whether both pictures have come."""
    script = "[...document.querySelectorAll('#cameras canvas')].map(canvas => canvas.width)"
    return bool(min(page.evaluate(script), default=0) > 4)


def test_ports_of_the_robot(robot: Robot, url: str, names: yarpy.YarpNameClient) -> None:
    told = get(f"{url}robot")
    assert told["robot"] == "/icubSim"
    assert told["server"] == ["", names.port]
    [board] = told["boards"]
    assert board["name"] == "/icubSim/head"
    for name, port in (("rpc:i", board["rpc"]), ("state:o", board["state"])):
        found = names.query(f"/icubSim/head/{name}")
        assert found is not None
        assert port == ["", found.port]
    assert [one["name"] for one in told["cameras"]] == ["/icubSim/cam/left", "/icubSim/cam/right"]
    assert [one["name"] for one in told["sensors"]] == ["/icubSim/inertial"]


def test_robot_that_is_not_there(names: yarpy.YarpNameClient) -> None:
    with yarpy.Port("/panel/of/nobody", names=names) as port:
        Panel(port, "nobody", names)
        told = get(f"http://{port.address}/robot")
        assert told["robot"] == "/nobody"
        assert told["boards"] == told["cameras"] == told["sensors"] == []
        assert told["missing"].startswith("waiting for the robot /nobody: no control board")


def test_robots_that_are_there_instead(robot: Robot, names: yarpy.YarpNameClient) -> None:
    with yarpy.Port("/panel/of/nosuch", names=names) as port:
        panel = Panel(port, "/nosuch", names)
        assert "there is /icubSim (yarpy panel /icubSim)" in panel.missing()
        assert Panel(port, "/icubSim", names).missing() == ""
    with yarpy.NameServer() as server, yarpy.Port("/panel", names=server.client) as port:
        assert "`yarpy demo` simulates one" in Panel(port, "/nosuch", server.client).missing()


def test_names_that_nobody_keeps() -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/panel", names=names) as port, yarpy.Port("/r/eye", names=names) as eye:
        panel = Panel(port, "/r", names)
        assert panel.robot()["server"] is None
        with yarpy.Port("/r/eye/rpc", names=names):
            [camera] = panel.robot()["cameras"]
            assert camera == {"name": "/r/eye", "images": ("", eye.contact.port)}


def test_what_the_page_loads(url: str) -> None:
    with urllib.request.urlopen(url, timeout=HANG) as answer:
        page = answer.read().decode()
    files = re.findall(r'(?:src|href)="/([\w.*/]+)"', page)
    assert {"panel.js", "panel.css", "*/style.css"} <= {*files}
    for name in files:
        with urllib.request.urlopen(url + name, timeout=HANG) as answer:
            assert answer.status == 200
            files += {*re.findall(r'from "\.?/([\w.*/]+)"', answer.read().decode())} - {*files}
    assert {"*/common.js", "panel_camera.js", "horizon.js"} <= {*files}
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', page)
    assert policy is not None and "unsafe" not in policy[1]


def test_sliders_move_the_head_and_the_pictures(
    browser: Browser, head: yarpy.RpcClient, url: str
) -> None:
    page = opened(browser, url)
    assert page.locator(".joint .name").all_inner_texts() == JOINTS
    wait_until(lambda: loaded(page))
    before = seen(page)
    page.get_by_label("neck_roll").fill("45")
    wait_until(lambda: abs(encoders(head)[1] - 45) < 0.1)
    page.locator(".said", has_text='["ok"]').wait_for()
    page.get_by_label("neck_pitch").fill("-18")
    wait_until(lambda: abs(encoders(head)[0] + 18) < 0.1)
    page.locator(".joint .value", has_text="45.0°").wait_for()
    change = [abs(a - b) for a, b in zip(before, seen(page), strict=True)]
    assert sum(change) / len(change) > 20
    page.locator(".said", has_text="/?req=set+pos+$axis+$angle&axis=0&angle=-18'").wait_for()
    page.locator(".said", has_text='["ok"]').wait_for()
    page.locator(".attitude .facts", has_text="pitch").wait_for()
    browser.picture(page, "panel")


def test_curves(browser: Browser, head: yarpy.RpcClient, url: str) -> None:
    page = opened(browser, url)
    page.locator("#curves article").nth(2).wait_for()
    assert page.locator("#curves h2").all_inner_texts() == [
        *("head position", "inertial gyroscope", "inertial accelerometer")
    ]
    assert page.locator("#curves .joints .legend li").all_inner_texts() == JOINTS
    script = """canvas => {
        const {width, height} = canvas;
        const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
        return data.some((value, place) => place % 4 === 3 && value > 0);
    }"""
    for number in range(3):
        plot = page.locator(".plot").nth(number)
        wait_until(lambda plot=plot: plot.evaluate(script))
    wait_until(lambda: page.locator(".horizon").evaluate(script))


def test_click_looks_there(browser: Browser, head: yarpy.RpcClient, url: str) -> None:
    page = opened(browser, url)
    left = page.locator("#cameras .looks").first
    left.wait_for()
    size = left.bounding_box()
    assert size is not None
    # A quarter of the picture to the left of its middle: atan(tan(32) / 2) to the left.
    left.click(position={"x": size["width"] / 4, "y": size["height"] / 2})
    wait_until(lambda: abs(encoders(head)[2] - 17.4) < 0.7)
    assert abs(encoders(head)[0]) < 0.7


def test_buttons(browser: Browser, head: yarpy.RpcClient, url: str) -> None:
    page = opened(browser, url)
    page.get_by_role("button", name="Try each joint").click()
    wait_until(lambda: encoders(head)[0] > 5)
    wait_until(lambda: encoders(head)[0] < -5)
    page.get_by_role("button", name="All to zero").click()
    wait_until(lambda: abs(encoders(head)[0]) < 0.01)
    page.locator("#try[aria-pressed=false]").wait_for()


def test_others_move_it_too(browser: Browser, head: yarpy.RpcClient, url: str) -> None:
    page = opened(browser, url)
    head.call("set", "pos", 2, -30)
    page.locator(".joint .value", has_text="-30.0°").wait_for()
    wait_until(lambda: page.get_by_label("neck_yaw").input_value() == "-30")


@pytest.mark.parametrize(("dark", "phone"), [(True, False), (False, True), (True, True)])
def test_dark_and_on_a_phone(
    browser: Browser, head: yarpy.RpcClient, url: str, dark: bool, phone: bool
) -> None:
    page = opened(browser, url, dark=dark, phone=phone)
    wait_until(lambda: loaded(page))
    page.get_by_label("neck_pitch").fill("-18")
    page.locator(".joint .value", has_text="-18.0°").wait_for()
    wide = page.evaluate("document.documentElement.scrollWidth - innerWidth")
    assert wide <= 0, "nothing sticks out to the right"
    name = "panel" + ("-dark" if dark else "") + ("-phone" if phone else "")
    browser.picture(page, name, whole=phone)


def test_joints_that_slide_or_have_no_limits(browser: Browser, names: yarpy.YarpNameClient) -> None:
    browser.excuse("ERR_|Failed to load")  # when the robot goes before the page
    axes = [Axis("rail", -400.0, 400.0, kind="prismatic"), Axis("wheel", -1e6, 1e6)]
    parts = Parts({"base": Board(Body([Joint(axis) for axis in axes]))})
    with (
        Robot("/cart", parts, names=names),
        yarpy.Port("/panel/of/cart", names=names) as port,
    ):
        Panel(port, "/cart", names)
        page = opened(browser, f"http://{port.address}/")
        page.get_by_label("wheel").fill("30")
        page.locator(".joint .value", has_text="30.0°").wait_for()
        assert page.locator(".joint .value").first.inner_text() == "0.0"
        assert page.get_by_label("rail").get_attribute("max") == "400"
        assert page.get_by_label("wheel").get_attribute("max") == "360"
        assert page.locator("#cameras figure").count() == 0


def test_robot_that_falls_silent(browser: Browser, names: yarpy.YarpNameClient) -> None:
    browser.excuse("ERR_CONNECTION_REFUSED|Failed to load|ERR_INCOMPLETE|ERR_EMPTY")
    with yarpy.Port("/panel/late", names=names) as port:
        Panel(port, "/late", names)
        page = browser.open()
        page.goto(f"http://{port.address}/", wait_until="commit")
        page.get_by_text("waiting for the robot").wait_for()
        with Robot("/late", icub_head((32, 24)), names=names):
            page.get_by_text("live: drag the sliders").wait_for()
        page.get_by_text("the robot has been silent for").wait_for()


def test_robot_that_is_started_again(browser: Browser, names: yarpy.YarpNameClient) -> None:
    """Its ports have other numbers then. Until then a still picture looks still."""
    browser.excuse("ERR_|Failed to load")
    with yarpy.Port("/panel/again", names=names) as port:
        Panel(port, "/again", names)
        with Robot("/again", icub_head((64, 48)), names=names):
            page = opened(browser, f"http://{port.address}/")
            wait_until(lambda: loaded(page))
            page.locator("#cameras .facts", has_text=re.compile("64 . 48")).first.wait_for()
            assert page.locator(".still").count() == 0
            page.evaluate("window.same = true")
        page.locator(".badge", has_text=re.compile(r"^still for \d")).first.wait_for()
        wait_until(lambda: page.locator("#cameras figure.still").count() == 2)
        page.get_by_text("the robot has been silent for").wait_for()
        browser.picture(page, "panel_silent")
        with Robot("/again", icub_head((96, 72)), names=names):
            page.locator("#cameras .facts", has_text=re.compile("96 . 72")).nth(1).wait_for()
            page.get_by_text("live: drag the sliders").wait_for()
            wait_until(lambda: page.locator(".still").count() == 0)
            page.get_by_label("neck_roll").fill("30")
            page.locator(".joint .value", has_text="30.0°").wait_for()
        assert page.evaluate("window.same"), "the page was loaded anew"


def test_limits_and_units(browser: Browser, head: yarpy.RpcClient, url: str) -> None:
    page = opened(browser, url)
    limits = page.locator(".joint .limits").nth(1)
    assert limits.locator(".low").inner_text() == "-70°"
    assert limits.locator(".high").inner_text() == "60°"


def test_nothing_is_wasted_on_a_wide_screen(
    browser: Browser, head: yarpy.RpcClient, url: str
) -> None:
    page = opened(browser, url)
    page.locator("#curves article").nth(2).wait_for()
    for width in (1280, 1920):
        page.set_viewport_size({"width": width, "height": 1080})
        rights = page.locator("#curves article").evaluate_all(
            "all => all.map(e => Math.round(e.getBoundingClientRect().right))"
        )
        assert rights[0] == rights[2], "the curves leave a hole"
        edge = page.locator("#boards").evaluate("e => e.getBoundingClientRect().right")
        assert width - edge < 40
        browser.picture(page, f"panel_{width}")


class CppCamera(BaseHTTPRequestHandler):
    """A camera of C++ YARP in HTTP: scripts of other pages may look at nothing of it."""

    def do_GET(self) -> None:
        self.send_response(200)
        if "action=stream" not in self.path:
            self.end_headers()
            return
        self.send_header("Content-Type", "multipart/x-mixed-replace;boundary=xyz")
        self.end_headers()
        data = jpeg.encode(yarpy.Image(np.full((48, 64, 3), (30, 200, 40), "u1")))
        try:
            while True:
                head = f"--xyz\r\nContent-Type: image/jpeg\r\nContent-Length: {len(data)}\r\n\r\n"
                self.wfile.write(head.encode() + data + b"\r\n")
                time.sleep(0.05)
        except OSError:
            pass

    def log_message(self, *details: object) -> None:
        pass


def test_camera_that_only_browsers_may_look_at(
    browser: Browser, names: yarpy.YarpNameClient
) -> None:
    browser.excuse("ERR_|Failed to load|CORS|Access to")
    camera = ThreadingHTTPServer(("127.0.0.1", 0), CppCamera)
    camera.daemon_threads = True
    threading.Thread(target=camera.serve_forever, daemon=True).start()
    for name in ("/old/cam", "/old/cam/rpc"):
        names.register(name, "tcp", "127.0.0.1", camera.server_address[1])
    with yarpy.Port("/panel/of/old", names=names) as port:
        Panel(port, "/old", names)
        page = browser.open()
        page.goto(f"http://{port.address}/", wait_until="commit")
        page.locator("#cameras .facts", has_text=re.compile("64 . 48")).wait_for()
        assert page.locator("#cameras img").count() == 1
        assert page.locator(".still").count() == 0
        camera.shutdown()
        camera.server_close()
        page.locator(".badge", has_text="still for").wait_for()
        browser.picture(page, "panel_cpp_camera")


def test_questions_go_to_ports_of_the_robot_alone(robot: Robot, url: str, names: Any) -> None:
    """The page asks through its own port, as ports let no page of another origin act."""
    told = get(f"{url}robot")
    where = told["boards"][0]["rpc"]

    def ask(*words: object, **headers: str) -> Any:
        body = json.dumps({"admin": 1, "req": ["ask", *words]}).encode()
        kind = {"Content-Type": "application/json", **headers}
        request = urllib.request.Request(f"{url}form", body, kind)
        with urllib.request.urlopen(request, timeout=HANG) as answer:
            return json.load(answer)

    assert ask(*where, "get axes")[:3] == ["is", "axes", 6]
    assert ask("", names.port, "list")[0] == "fail"  # the name server is no port of the robot
    with http_error(403):
        ask(*where, "get axes", Origin="http://evil.test")


def test_commands_go_to_the_port_that_is_meant(names: Any) -> None:
    """And not to one that has the number by now, while the name server remembers another."""
    asked: list[Any] = []
    with (
        yarpy.RpcServer("/arm", lambda message: asked.append(message.value), names=names) as arm,
        yarpy.Port("/panel/of/hand", names=names) as port,
    ):
        for end in ("rpc:i", "state:o"):
            names.register(f"/hand/{end}", "tcp", "127.0.0.1", arm.contact.port)
            names.set(f"/hand/{end}", "process", 1)  # as ports say of themselves
        panel = Panel(port, "/hand", names)
        panel.robot()
        answer = panel._told("", arm.contact.port, "set pos 0 5")
        assert "/arm" in str(answer) and "not" in str(answer)
        assert not asked


def test_command_to_a_robot_that_has_just_started(names: Any) -> None:
    """The page hears of it, and may be used, before it asks again where the robot is."""
    with yarpy.Port("/panel/of/just", names=names) as port:
        panel = Panel(port, "/just", names)
        panel.robot()
        with yarpy.RpcServer("/just/rpc:i", lambda message: ["moved"], names=names) as arm:
            assert panel._told("", arm.contact.port, "set pos 0 5") == ["moved"]
            assert panel._told("", 1, "set pos 0 5")[0] == "fail"


def test_questions_are_pages_and_move_nothing(robot: Robot, url: str, names: Any) -> None:
    host, port = get(f"{url}robot")["boards"][0]["rpc"]

    def asked(question: str, number: int = port) -> Any:
        return get(f"{url}get?host={host}&port={number}&question={question}")

    assert asked("get+axes")[:3] == ["is", "axes", 6]
    assert asked("get+axes", names.port)[0] == "fail"  # no port of the robot
    for bad in ("set+pos+0+5", "", "[set]+pos+0+5"):
        with http_error(400):
            asked(bad)
    with http_error(400):
        get(f"{url}get?host={host}&port=x&question=get+axes")


def test_who_may_only_look_cannot_move_the_robot(
    browser: Browser,
    head: yarpy.RpcClient,
    names: yarpy.YarpNameClient,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with yarpy.Port("/panel/public", names=names) as port:
        Panel(port, "/icubSim", names)
        page = browser.open(f"http://{port.address}/")
        page.locator("#state", has_text="read only").wait_for()
        assert page.locator(".joint .name").all_inner_texts() == JOINTS
        assert page.locator(".joint input:enabled").count() == 0
        assert not page.get_by_role("button", name="All to zero").is_visible()
        head.call("set", "pos", 2, -30)
        page.locator(".joint .value", has_text="-30.0°").wait_for()  # it is live
        wait_until(lambda: loaded(page))
        assert page.locator("#cameras .looks").count() == 0
        browser.picture(page, "panel_read_only")
        # Whoever tries all the same is refused.
        host, number = get(f"http://{port.address}/robot")["boards"][0]["rpc"]
        body = {"admin": 1, "req": ["ask", host, number, "set pos 0 5"]}
        status = page.evaluate(
            """async body => (await fetch("/form", {method: "POST", body: JSON.stringify(body),
            headers: {"Content-Type": "application/json"}})).status""",
            body,
        )
        assert status == 403
        browser.excuse("403")
