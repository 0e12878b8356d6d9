"""The simulated robot and the panel with C++ in between: its client drives our head, its server is
driven by our page.

    page -> HTTP -> controlBoard_nws_yarp -> remote_controlboard -> simulated head
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.cpp import CppYarp
from support.cpp_device import cpp_device, device_host
from support.peer import brings
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli.service import server
from yarpy.kits.devices import ControlBoard, FrameGrabber, MultiSensor
from yarpy.kits.sim.robot import Robot, icub_head
from yarpy.kits.views.panel import Panel

if TYPE_CHECKING:
    from support.browser import Browser

SLOW = 2 * HANG  # seconds


@pytest.fixture(autouse=True)
@brings("g++")
def devices(our_names: CppYarp) -> None:
    device_host(our_names)


@pytest.fixture
def head():
    """The device itself, which is at rest, and its ports."""
    parts = icub_head((160, 120))
    with Robot("/icubSim", parts):
        yield parts.boards["head"]


def chain(programs: CppYarp):
    return cpp_device(
        programs,
        "controlBoard_nws_yarp",
        subdevice="remote_controlboard",
        remote="/icubSim/head",
        local="/between",
        name="/cpp/head",
        period=0.01,
    )


def test_client_of_cpp_drives_the_head(our_names: CppYarp, head) -> None:
    with chain(our_names), ControlBoard("/cpp/head", "/mine", timeout=SLOW) as board:
        assert list(board.axis_names) == head.axis_names
        assert board.position_limits[1] == (-70.0, 60.0)
        board.position_move([1, 2], [45.0, -20.0])
        wait_until(lambda: abs(head.encoders()[1] - 45) < 0.01, SLOW)
        wait_until(lambda: abs(board.encoders()[2] + 20) < 0.01, SLOW)
        wait_until(lambda: all(board.motion_done()), SLOW)
        board.switch_control_modes([2], ["vel"])
        wait_until(lambda: board.control_modes()[2] == "vel", SLOW)
        board.velocity_move([2], [10.0])
        wait_until(lambda: head.encoder_speeds()[2] > 5, SLOW)
        board.stop([2])
        board.switch_control_modes(range(6), ["posd"] * 6)
        wait_until(lambda: set(head.control_modes()) == {"posd"}, SLOW)
        board.position_direct(range(6), [0.0] * 5 + [5.0])
        wait_until(lambda: abs(head.encoders()[5] - 5) < 0.01, SLOW)


def test_clients_of_cpp_see_and_feel(our_names: CppYarp, head) -> None:
    with (
        cpp_device(
            our_names,
            "frameGrabber_nws_yarp",
            subdevice="frameGrabber_nwc_yarp",
            remote="/icubSim/cam/left",
            local="/between/eye",
            name="/cpp/eye",
            period=0.03,
        ),
        cpp_device(
            our_names,
            "multipleanalogsensorsserver",
            subdevice="multipleanalogsensorsclient",
            remote="/icubSim/inertial",
            local="/between/imu",
            name="/cpp/imu",
            period=10,
        ),
        FrameGrabber("/cpp/eye") as eye,
        MultiSensor("/cpp/imu") as imu,
    ):
        wait_until(lambda: eye.image(SLOW).array.std() > 20, SLOW)
        assert eye.resolution == (160, 120)
        wait_until(lambda: imu.accelerometers()["head_imu"][2] > 9, SLOW)


def test_page_drives_a_robot_of_cpp(our_names: CppYarp, head, browser: Browser) -> None:
    """The ports of the C++ board answer the page in their own HTTP."""
    if our_names.version >= (4, 0):
        pytest.skip("boards of C++ YARP 4 know no questions in words, which the page asks")
    # It sends no events, which the page has to try first, and hangs up after each answer.
    browser.excuse(r"/r\?sse|net::ERR_")
    with chain(our_names), yarpy.Port("/panel", callback=lambda message: None) as port:
        Panel(port, "/cpp", server())
        page = browser.open()
        page.goto(f"http://{port.address}/", wait_until="commit")
        page.get_by_label("neck_roll").fill("30")
        wait_until(lambda: abs(head.encoders()[1] - 30) < 0.01, SLOW)
        page.locator(".joint .value", has_text="30.0°").wait_for()
        head.position_move([2], [-15.0])
        page.locator(".joint .value", has_text="-15.0°").wait_for()
        browser.picture(page, "panel-cpp")
