"""`yarpy panel`."""

import json
import signal
import urllib.request

from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.sim.robot import Robot, icub_head


def test_robot_that_starts_later(cli, names):
    with cli.start("panel", "/pn/robot", "--name", "/pn/page") as process:
        shown = process.wait_line(r"^/pn/page is shown at (http://\S+/)$", timeout=HANG)[1]

        def boards():
            with urllib.request.urlopen(f"{shown}robot", timeout=HANG) as answer:
                return [board["name"] for board in json.load(answer)["boards"]]

        assert boards() == []
        with Robot("/pn/robot", icub_head((32, 24)), names=names):
            wait_until(lambda: boards() == ["/pn/robot/head"])
        process.signal(signal.SIGINT)
        assert process.wait(HANG) == 130
        assert "Traceback" not in process.stderr
    assert names.query("/pn/page") is None


def test_no_name_server(lone):
    said = lone.run("panel")
    assert said.returncode == 1
    assert said.stderr.startswith("error: ")


def test_name_that_is_taken(here, names):
    with yarpy.Port("/pn/taken", names=names):
        said = here("panel", "/x", "--name", "/pn/taken")
    assert said.code == 1 and "is in use" in said.err


def test_robot_without_a_name(here):
    said = here("panel", "")
    assert said.code == 1 and "an empty port name" in said.err
