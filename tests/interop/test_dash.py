"""The page of the network with ports of C++ on it: seen, looked into, connected by hand."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli.service import server
from yarpy.kits.sim.robot import Robot, icub_head
from yarpy.kits.views.dash import Dash

if TYPE_CHECKING:
    from support.browser import Browser

SLOW = 2 * HANG  # seconds


@pytest.fixture(scope="module")
def network(our_names: CppYarp) -> CppYarp:
    """Our name server, which C++ programs use."""
    return our_names


def test_ports_of_cpp_are_part_of_the_picture(peer: CppProgram, browser: Browser) -> None:
    peer.do("out = yarp.BufferedPortBottle(); assert out.open('/cpp/out')")
    peer.do("inlet = yarp.BufferedPortBottle(); assert inlet.open('/cpp/in')")
    with (
        Robot("/icubSim", icub_head((160, 120))),
        yarpy.BufferedPort("/ours") as ours,
        yarpy.Port("/dash") as port,
    ):
        ours.listen_to("/cpp/out")
        shown = Dash(port, server())
        page = browser.open(f"http://{port.address}/")
        page.get_by_text(re.compile("1 connection ")).wait_for()
        assert page.evaluate("dash.network.ports.get('/cpp/out').state") == "alive"
        assert page.evaluate("dash.network.ports.get('/cpp/out').ours") is False
        page.evaluate("dash.graph.chosen('port', '/cpp/out')")
        page.get_by_text("none since you look").wait_for()
        wait_until(lambda: peer.do("out.getOutputCount()") == 2, SLOW)
        peer.do("b = out.prepare(); b.clear(); b.addString('hello'); b.addInt32(7); out.write()")
        page.locator("pre").get_by_text("hello 7").wait_for()
        page.get_by_label("The other port").fill("/icubSim/head/state:o")
        page.evaluate("dash.graph.chosen('port', '/cpp/in')")
        page.get_by_label("The other port").fill("/icubSim/head/state:o")
        page.get_by_role("button", name="Connect from").click()
        wait_until(lambda: peer.do("inlet.getInputCount()") == 1, SLOW)
        assert peer.do("inlet.read().size()") == 6
        page.get_by_role("button", name=re.compile("Undo")).wait_for()
        page.get_by_role("button", name="Cameras").click()
        wait_until(
            lambda: page.evaluate(
                "document.querySelector('#cameras img').naturalWidth"
            ) == 160, SLOW,
        )  # fmt: skip
        browser.picture(page, "dash-cpp")
        page.get_by_role("button", name=re.compile("Undo")).click()
        wait_until(lambda: peer.do("inlet.getInputCount()") == 0, SLOW)
        page.close()
        shown.close()
