import logging
import threading
from http.client import HTTPConnection

import numpy as np
import pytest
from support.camera import FakeCamera
from support.capture import load_capture
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.devices.frame_grabber.server import FrameGrabberServer


@pytest.fixture
def camera():
    return FakeCamera()


@pytest.fixture
def server(camera, names):
    with FrameGrabberServer("/eye", camera, 0.005, names=names) as server:
        yield server


def steps(server):
    """Wait until it has been its time to grab, once from beginning to end."""
    seen, step = [], server._publisher._step
    server._publisher._step = lambda: (step(), seen.append(True))
    wait_until(lambda: seen)
    server._publisher._step = step


def test_images_are_numbered_and_timed(server, camera, names):
    camera.timestamp = lambda: 12.5
    with yarpy.BufferedPort("/me", names=names) as port:
        port.listen_to("/eye")
        first, second = port.read(HANG), port.read(HANG)
    assert first.stamp.count < second.stamp.count
    assert first.stamp.time == second.stamp.time == 12.5
    assert first.value.array.shape == (48, 64, 3)
    assert first.value.array[0, 0, 0] < second.value.array[0, 0, 0]


def test_headers_are_those_of_cpp(server, camera, names):
    """The recorded camera had 32 by 16 pixels."""
    camera.resolution = (32, 16)
    recorded = load_capture("grabber_image_tcp").steps[2].data
    with yarpy.BufferedPort("/me", names=names) as port:
        port.listen_to("/eye")
        data = bytes(port.read(HANG).payload)
    assert len(data) == 1596 and data[:60] in recorded


def test_nothing_is_grabbed_while_nobody_looks(server, camera, names):
    steps(server)
    assert camera.taken == 0
    with yarpy.BufferedPort("/me", names=names) as port:
        port.listen_to("/eye")
        port.read(HANG)
    wait_until(lambda: not server.images.outputs)
    steps(server)  # what was begun is done
    taken = camera.taken
    steps(server)
    assert camera.taken == taken


def test_a_viewer_of_another_system_sees_images_too(server, camera):
    class Viewer:
        outputs, seen = 0, []

        def write(self, image, stamp):
            self.seen.append((image.width, image.height, stamp.count))

    viewer = Viewer()
    server.viewers.append(viewer)
    steps(server)
    assert not viewer.seen and camera.taken == 0
    viewer.outputs = 1
    wait_until(lambda: len(viewer.seen) > 1)
    server.viewers.remove(viewer)
    assert [row[:2] for row in viewer.seen[:2]] == [(64, 48)] * 2
    assert viewer.seen[0][2] < viewer.seen[1][2]


def test_both_ports_answer(server, names):
    for port in ("/eye", "/eye/rpc"):
        with yarpy.RpcClient(port, names=names) as client:
            assert client.call("visr", "get", "res", timeout=HANG) == [
                "visr", "res", "is", 64, 48,
            ]  # fmt: skip
            assert client.call("help", timeout=HANG) == ["nak"]


def test_recorded_browsers(server, names):
    """`help` at a camera answers as it did: ["nak"]."""
    capture = load_capture("http_grabber_req")
    contact = names.query("/eye")
    web = HTTPConnection(contact.host, contact.port, timeout=HANG)
    web.request("GET", capture.steps[0].data.split()[1].decode())
    assert web.getresponse().read().strip() == b'["nak"]'
    assert b'["nak"]' in capture.steps[1].data
    web.request("GET", "/")
    assert b"This is /eye at" in web.getresponse().read()
    web.close()


def test_browsers_see_the_camera(server, names):
    contact = names.query("/eye")
    stream = HTTPConnection(contact.host, contact.port, timeout=HANG)
    stream.request("GET", "/?action=stream")
    assert b"image/jpeg" in stream.getresponse().read(200)
    stream.close()


def test_an_array_may_be_used_again(names):
    """The camera fills it while the last image is still on its way."""

    class Reusing:
        def __init__(self):
            self.pixels = np.zeros((300, 400, 3), "uint8")

        def image(self):
            self.pixels += 1
            return self.pixels

    with (
        FrameGrabberServer("/eye", Reusing(), 0.001, names=names),
        yarpy.BufferedPort("/me", strict=True, names=names) as port,
    ):
        port.listen_to("/eye")
        for _ in range(20):
            pixels = port.read(HANG).value.array
            assert pixels.min() == pixels.max()


def test_cameras_may_fail_and_pause(names, caplog):
    class Moody:
        count = 0

        def image(self):
            self.count += 1
            if self.count % 3 == 1:
                raise OSError("cable")
            return None if self.count % 3 == 2 else np.zeros((4, 8), "uint8")

    with (
        caplog.at_level(logging.WARNING),
        FrameGrabberServer("/eye", Moody(), 0.002, names=names),
        yarpy.BufferedPort("/me", names=names) as port,
    ):
        port.listen_to("/eye")
        for _ in range(3):
            assert port.read(HANG).value.code == "mono"
        with yarpy.RpcClient("/eye/rpc", names=names) as client:
            replies = {client.call("fgi", "get", "imgr", timeout=HANG)[0] for _ in range(12)}
    assert replies <= {"fgi", "fail"} and "fail" in replies
    assert caplog.text.count("cable") == 1


def test_images_go_as_they_are(names):
    class Depth:
        def image(self):
            return yarpy.Image(np.full((2, 5), 1.5, "float32"))

    with (
        FrameGrabberServer("/eye", Depth(), 0.005, names=names),
        yarpy.BufferedPort("/me", names=names) as port,
    ):
        port.listen_to("/eye")
        assert port.read(HANG).value.code == "dec"


def test_closing_leaves_nothing(names):
    before = {thread.name for thread in threading.enumerate()}
    server = FrameGrabberServer("eye", FakeCamera(), names=names)
    assert repr(server) == "<FrameGrabberServer /eye>"
    assert "yarpy device /eye" in {thread.name for thread in threading.enumerate()}
    server.close()
    server.close()
    wait_until(lambda: {thread.name for thread in threading.enumerate()} <= before)
    assert names.query("/eye") is None and names.query("/eye/rpc") is None


def test_bad_devices_open_nothing(names):
    with pytest.raises(ValueError, match="image"):
        FrameGrabberServer("/eye", object(), names=names)
    with pytest.raises(ValueError, match="period"):
        FrameGrabberServer("/eye", FakeCamera(), -1, names=names)
    assert names.query("/eye") is None
