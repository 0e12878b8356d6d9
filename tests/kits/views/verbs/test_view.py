"""`yarpy view`: by itself, in a browser, and with a camera that knows nothing of YARP."""

from __future__ import annotations

import json
import signal
import sys
import types
import urllib.error
import urllib.request
from contextlib import nullcontext

import numpy as np
import pytest
from support.http_error import http_error
from support.peer import program
from support.port import free_port
from support.process import Process
from support.recordings import recorded
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import LinkClosed
from yarpy.kits.views.verbs import view
from yarpy.kits.views.verbs.view import in_rerun, names_of


def status(url):
    with urllib.request.urlopen(f"{url}status", timeout=HANG) as answer:
        return json.load(answer)


def address(process):
    return process.wait_line(r"^/\S+ is shown at (http://\S+/)$", stream="out", timeout=HANG)[1]


def pictures(url, index=0):
    return status(url)["pictures"][index]


def test_images_of_a_port(cli, names):
    with (
        yarpy.Port("/vw/cam", names=names) as camera,
        cli.start("view", "/vw/a", "/vw/b", "--connect", "/vw/cam", "--rate", "5") as process,
    ):
        url = address(process)
        assert url == f"http://{names.query('/vw/a').address}/"
        assert camera.wait_for_outputs(timeout=HANG)
        camera.write(yarpy.Image(np.zeros((4, 6), "u1")))
        wait_until(lambda: pictures(url)["frames"] == 1)
        assert status(url)["wish"] == "quality=75&rate=5"
        a, b = status(url)["pictures"]
        assert (a["name"], a["width"], a["pixel"]) == ("/vw/a", 6, "mono")
        assert (b["name"], b["sources"], b["frames"]) == ("/vw/b", [], 0)
        for path in ("", "view.js", "*/style.css", "*/common.js"):
            with urllib.request.urlopen(f"{url}{path}", timeout=HANG) as answer:
                assert answer.status == 200
        process.signal(signal.SIGINT)
        assert process.wait() == 130
    assert names.query("/vw/a") is None
    assert names.query("/vw/b") is None


def test_sources_that_are_not_there_and_clicks(cli, names):
    words = ("--connect", "/vw/x", "--connect", "/vw/y", "--out", "/vw/clicks", "--carrier", "udp")
    with (
        cli.start("view", "/vw/c", *words, "--no-browser") as process,
        yarpy.BufferedPort("/vw/heard", strict=True, names=names) as heard,
    ):
        url = address(process)
        assert [one["name"] for one in status(url)["pictures"]] == ["/vw/c", "/view/2"]
        assert pictures(url)["waiting"].startswith("Waiting for /vw/x: ")
        heard.listen_to("/vw/clicks")
        body = b'{"admin": 1, "req": ["click", 0, 30, 40]}'
        kind = {"Content-Type": "application/json"}
        asked = urllib.request.Request(f"{url}form", body, kind)
        urllib.request.urlopen(asked, timeout=HANG).close()
        assert heard.read(timeout=HANG).value == [30, 40]
        with yarpy.Port("/vw/y", names=names) as late:
            assert late.wait_for_outputs(timeout=HANG)
            assert late.outputs[0].carrier == "udp"
            wait_until(lambda: not pictures(url, 1)["waiting"])


def test_what_cannot_be_opened(here, names):
    with yarpy.Port("/vw/taken", names=names):
        said = here("view", "/vw/taken")
    assert (said.code, said.out) == (1, "")
    assert "is in use" in said.err
    assert here("view", "/vw/d", "--quality", "0").code == 1
    said = here("view", "/vw/d", "--connect", "/vw/e", "--carrier", "nonsense")
    assert said.code == 1 and "nonsense" in said.err
    assert names.query("/vw/d") is None


@pytest.mark.parametrize(
    ("ports", "count", "expected"),
    [
        ((), 0, ["/view"]),
        ((), 2, ["/view", "/view/2"]),
        (("/a", "/b"), 1, ["/a", "/b"]),
        (("/a",), 2, ["/a", "/view/2"]),
    ],
)
def test_names(ports, count, expected):
    assert names_of(ports, count) == expected


class Ffmpeg(Process):
    """A camera at http://127.0.0.1:NUMBER/mjpg/video.mjpg that shows one colour."""

    def __init__(self, number, colour):
        source = f"color={colour}:size=160x120:rate=20"
        where = f"http://127.0.0.1:{number}/mjpg/video.mjpg"
        quiet = ["-nostdin", "-loglevel", "error"]
        made = ["-re", "-f", "lavfi", "-i", source, "-f", "mpjpeg", "-listen", "1", where]
        super().__init__([program("ffmpeg"), *quiet, *made])


def middle(page):
    script = """() => {
        const canvas = document.querySelector("canvas");
        if (!canvas) return [0, 0, 0, 0, 0];
        const x = canvas.width >> 1, y = canvas.height >> 1;
        return [canvas.width, ...canvas.getContext("2d").getImageData(x, y, 1, 1).data];
    }"""
    return page.evaluate(script)


@pytest.mark.peer("ffmpeg")
def test_a_camera_as_in_the_paper(cli, browser):
    """yarpview /view &
    yarp connect /HOST:PORT /view mjpeg+path.mjpg/video.mjpg?camera=1
    with ffmpeg as the camera, which goes away and returns."""
    number = free_port()
    with cli.start("view", "/view") as process:
        url = address(process)
        page = browser.open(url)
        with Ffmpeg(number, "red"):
            carrier = "mjpeg+path.mjpg/video.mjpg?camera=1"

            def connected():
                return cli.run("connect", f"/127.0.0.1:{number}", "/view", carrier).returncode == 0

            wait_until(connected, HANG, "the camera has started")

            def is_red():
                page.wait_for_timeout(50)
                width, red, green, _, _ = middle(page)
                return width == 160 and red > 200 and green < 50

            wait_until(is_red, HANG, "the red camera is seen")
            told = pictures(url)
            assert told["sources"][0]["carrier"] == carrier
            assert (told["width"], told["height"], told["others"]) == (160, 120, 0)
            browser.picture(page, "view_ffmpeg")
        wait_until(lambda: not pictures(url)["sources"], HANG, "the camera is missed")
        with Ffmpeg(number, "blue"):

            def is_blue():
                page.wait_for_timeout(50)
                _, red, _, blue, _ = middle(page)
                return blue > 200 and red < 50

            wait_until(is_blue, HANG, "the camera that came back is seen")
        browser.close()


@pytest.mark.peer("ffmpeg")
def test_a_camera_as_a_source(cli):
    """Started after the viewer, with a carrier in front of its address."""
    number = free_port()
    source = f"mjpeg+path.mjpg/video.mjpg://127.0.0.1:{number}/"
    with cli.start("view", "/vw/camera", "--connect", source) as process:
        url = address(process)
        assert "Waiting for mjpeg" in pictures(url)["waiting"]
        with Ffmpeg(number, "green"):
            wait_until(lambda: pictures(url)["frames"] > 3)
            assert pictures(url)["waiting"] == ""


def test_a_recording_and_the_last_minutes(cli, names, tmp_path):
    path = recorded(tmp_path / "walk.mcap")
    both = (str(path), "--beside", str(path), "--offset", "2")
    for words, title in (
        ((str(path),), "walk.mcap"),
        (both, "walk.mcap beside walk.mcap"),
        (("--keep", "30s", "/a"), "the last 30 s"),
    ):
        with cli.start("view", *words, "--no-browser") as viewer:
            shown = r"^(.*) is shown at (http://127\.0\.0\.1:\d+/)$"
            found = viewer.wait_line(shown, stream="out", timeout=HANG)
            assert found[1] == title
            with urllib.request.urlopen(f"{found[2]}timeline", timeout=HANG) as answer:
                assert json.load(answer)["title"] == title
            viewer.signal(signal.SIGINT)
            assert viewer.wait(HANG) in (0, 130), viewer.stderr


def test_foxglove_may_read_when_it_is_told_so(cli, names, tmp_path):
    path = str(recorded(tmp_path / "walk.mcap"))
    for words, allowed in (((), False), (("--foxglove",), True)):
        with cli.start("view", path, *words, "--no-browser") as viewer:
            shown = r"is shown at (http://127\.0\.0\.1:\d+/)$"
            url = viewer.wait_line(shown, stream="out", timeout=HANG)[1]
            if allowed:
                viewer.wait_line(
                    "Foxglove at https://app.foxglove.dev/", stream="out", timeout=HANG
                )
            asked = urllib.request.Request(
                f"{url}timeline", headers={"Origin": "https://app.foxglove.dev"}
            )
            with nullcontext() if allowed else http_error(403):
                urllib.request.urlopen(asked, timeout=HANG).close()


@pytest.mark.parametrize(
    ("words", "said"),
    [(("--keep", "much"), "no time that is kept"), (("--keep", "5MB"), "no time that is kept"),
     (("none.mcap",), "none.mcap"), (("--foxglove", "/a"), "--keep"),
     (("/a", "--beside", "x.mcap"), "FILE --beside FILE"),
     (("x.mcap", "--offset", "1"), "--beside FILE")],
)  # fmt: skip
def test_what_cannot_be_looked_back_at(words, said, cli):
    done = cli.run("view", "--no-browser", *words)
    assert done.returncode == 1 and said in done.stderr


class Rerun(types.ModuleType):
    """Stands in for the library of Rerun, whose window may be gone."""

    gone = False

    def __getattr__(self, name):
        return lambda *words, **more: self

    def flush(self):
        if self.gone:
            raise RuntimeError("gRPC connection severed")


def test_rerun_without_a_window_says_so(tmp_path, monkeypatch) -> None:
    library = Rerun("rerun")
    monkeypatch.setitem(sys.modules, "rerun", library)
    walk = (str(recorded(tmp_path / "walk.mcap")),)
    assert in_rerun(walk, "", False) == 0
    library.gone = True
    with pytest.raises(LinkClosed, match="has not got all of it: gRPC connection severed"):
        in_rerun(walk, "", False)
    monkeypatch.setattr(view, "has_display", lambda platform, environment: False)
    with pytest.raises(LinkClosed, match=r"no display .*--no-browser"):
        in_rerun(walk, "", True)
