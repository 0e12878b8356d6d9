"""ROS 1 and ROS 2 by programs for Wrapyfi: types, encodings, services, parameters.

Rules: ROS 1 has its own master and tools beside, ROS 2 an independent implementation over a router
of Zenoh; real Wrapyfi on rospy is in test_with_wrapyfi.py.
"""

from __future__ import annotations

import json
import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.dds_program import Peer
from support.peer import brings
from support.process import Process
from support.ros2_peer import peer_command, peer_environment, ros2_router
from support.ros_graph import RosGraph, ros_graph
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.ros.message.library import default_library
from yarpy.peers.ros2.dds.participant import LOCAL

pytest.importorskip("zmq")

from wrapyfi.connect.wrapper import MiddlewareCommunicator
from wrapyfi.middlewares._ros import PictureForm, SoundForm, ours

register = MiddlewareCommunicator.register
pytestmark = pytest.mark.usefixtures("names")


def load(name: str) -> Any:
    return default_library().message(name)


class Robot(MiddlewareCommunicator):
    """Every type over either ROS."""

    @register("NativeObject", "$mware", "Robot", "/robot/native", should_wait="$wait")
    def native(self, obj=None, mware="", wait=True):
        return (obj,)

    @register("Image", "$mware", "Robot", "/robot/image", should_wait="$wait")
    def image(self, obj=None, mware="", wait=True):
        return (obj,)

    @register("AudioChunk", "$mware", "Robot", "/robot/sound", rate=8000, should_wait="$wait")
    def sound(self, obj=None, mware="", wait=True):
        return (obj,)

    @register("ROS2Message", "ros2", "Robot", "/robot/pose")
    def pose2(self, obj=None):
        return (obj,)

    @register("Properties", "ros", "Robot", "/robot/kept")
    @register("Properties", "ros", "Robot", "/robot/lost", persistent=False)
    def properties(self):
        return {"a": 1, "b": [0.5, "x"]}, "word"

    @register("NativeObject", "$mware", "Robot", "/robot/ask")
    def ask(self, number=0, mware="", **named):
        return ({"twice": 2 * number, **named},)

    @register("Image", "$mware", "Robot", "/robot/ask_image", jpg=True)
    @register("AudioChunk", "$mware", "Robot", "/robot/ask_sound", rate=8000)
    def ask_more(self, mware=""):
        return np.full((24, 32, 3), 9, np.uint8), (np.full((4, 1), 0.5, np.float32), 8000)


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("WRAPYFI_TIMEOUT", str(HANG))
    yield
    MiddlewareCommunicator.close_all_instances()


@pytest.fixture(scope="module")
@brings("ros", "rosmaster")
def master(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    with ros_graph(tmp_path_factory.mktemp("ros")) as found:
        yield found


@pytest.fixture
def graph(master: RosGraph, monkeypatch: pytest.MonkeyPatch) -> Iterator[RosGraph]:
    monkeypatch.setenv("ROS_MASTER_URI", master.uri)
    monkeypatch.setenv("ROS_IP", "127.0.0.1")
    yield master
    MiddlewareCommunicator.close_all_instances()


@pytest.fixture
def router(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    for needed in ("zenoh", "xxhash"):
        pytest.importorskip(needed)
    with ros2_router() as port:
        monkeypatch.setenv("YARPY_ZENOH", f"127.0.0.1:{port}")
        monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
        monkeypatch.delenv("ZENOH_SESSION_CONFIG_URI", raising=False)
        yield port
        MiddlewareCommunicator.close_all_instances()


@pytest.fixture
def dds(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """DDS on this computer alone, in a domain that other tests are not in."""
    pytest.importorskip("cyclonedds.builtin")
    monkeypatch.setenv("CYCLONEDDS_URI", LOCAL)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(100 + os.getpid() % 100))
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp")
    yield
    MiddlewareCommunicator.close_all_instances()


@contextmanager
def serving(act: Any) -> Iterator[None]:
    """Answer again and again in a thread, as a program's loop does."""
    done = threading.Event()

    def run() -> None:
        while not done.is_set():
            try:
                act()
            except yarpy.YarpError:
                return

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    yield
    done.set()
    MiddlewareCommunicator.close_all_instances()
    thread.join(HANG)
    assert not thread.is_alive()


def both_ways(mware: str) -> list[Robot]:
    """Values, pictures and sounds between two objects."""
    here, there = Robot(), Robot()
    image = np.arange(2 * 4 * 3, dtype=np.uint8).reshape(2, 4, 3)
    chunk = np.array([[0.5, -0.5], [1.0, 0.0]], np.float32)
    for name, value in (("native", {"t": (1, None)}), ("image", image), ("sound", chunk[:, :1])):
        here.activate_communication(name, "publish")
        there.activate_communication(name, "listen")
        sent = (value, 8000) if name == "sound" else value
        assert getattr(there, name)(mware=mware, wait=False) == [
            (None, 8000) if name == "sound" else None
        ]
        getattr(here, name)(sent, mware=mware)  # it waits for the listener
        got: list[Any] = []

        def heard(name: str = name, got: list[Any] = got, sent: Any = sent) -> bool:
            time.sleep(0.02)
            got[:] = getattr(there, name)(mware=mware, wait=False)
            if name == "sound":
                got[:] = [got[0][0]]
            if got[0] is None:
                getattr(here, name)(sent, mware=mware)
            return got[0] is not None

        wait_until(heard)
        assert np.array_equal(got[0], value) if name != "native" else got == [value]
    return [here, there]


def requests(mware: str, tells: bool = True) -> None:
    """Questions, also those that fail where that is told, and answers of every type."""
    here, there = Robot(), Robot()
    for one, mode in ((here, "reply"), (there, "request")):
        one.activate_communication("ask", mode)
        one.activate_communication("ask_more", mode)
    with serving(lambda: here.ask(mware=mware)):
        assert there.ask(4, mware=mware, name="x") == [{"twice": 8, "name": "x"}]
        if tells:
            with pytest.raises(yarpy.YarpError, match="unsupported operand"):
                there.ask(None, mware=mware)
        assert there.ask(1.5, mware=mware)[0]["twice"] == 3.0  # it lives
        with serving(lambda: here.ask_more(mware=mware)):
            image, (samples, rate) = there.ask_more(mware=mware)
    assert image.shape == (24, 32, 3) and abs(int(image[0, 0, 0]) - 9) < 4
    assert samples.tolist() == [[0.5]] * 4 and rate == 8000


def test_ros(graph: RosGraph) -> None:
    robots = both_ways("ros")
    assert "Type: sensor_msgs/Image" in graph.tool("rostopic", "info", "/robot/image")
    assert robots


def test_services_of_ros(graph: RosGraph) -> None:
    requests("ros")


def test_parameters_of_ros(graph: RosGraph) -> None:
    here, there = Robot(), Robot()
    here.activate_communication("properties", "publish")
    here.properties()
    assert graph.tool("rosparam", "get", "/robot/lost").strip() == "word"
    there.activate_communication("properties", "listen")
    assert there.properties() == [{"a": 1, "b": [0.5, "x"]}, "word"]
    here.close()
    assert "not set" in graph.tool("rosparam", "get", "/robot/lost")
    assert there.properties.__name__ == "properties"
    there.close()
    assert graph.tool("rosparam", "get", "/robot/kept/a").strip() == "1"


def test_ros2(router: int) -> None:
    both_ways("ros2")


def test_services_of_ros2(router: int) -> None:
    requests("ros2")


def test_ros2_over_dds(dds: None) -> None:
    both_ways("ros2")


def test_services_of_ros2_over_dds(dds: None) -> None:
    requests("ros2", tells=False)


def test_ros2_beside_a_program_of_dds(dds: None) -> None:
    here = Robot()
    here.activate_communication("native", "publish")
    with Peer() as peer:
        peer.do("reader", "it", "/robot/native", "reliable", "volatile", 0)
        here.native({"twice": (1, 2)}, mware="ros2")  # it waits for the reader
        wait_until(lambda: peer.heard("it"), HANG, "it is heard")
        (text,) = peer.heard("it")
        assert json.loads(text) == {"twice": {"__wrapyfi__": ["tuple", [1, 2]]}}


def test_ros2_beside_another_implementation(router: int, tmp_path: Path) -> None:
    pytest.importorskip("zenoh_ros2_sdk")
    here = Robot()
    here.activate_communication("native", "publish")
    command = peer_command(router, "hear", "/robot/native")
    with Process(command, env=peer_environment(tmp_path)) as peer:
        peer.wait_line("ready", timeout=HANG, stream="out")
        here.native({"twice": (1, 2)}, mware="ros2")
        line = peer.wait_line(r"^.*twice.*$", timeout=HANG, stream="out")[0]
        assert json.loads(json.loads(line)) == {"twice": {"__wrapyfi__": ["tuple", [1, 2]]}}


def test_messages_of_ros2(router: int) -> None:
    from yarpy.peers.ros2.message.library import default_library as library

    pose = library().message("geometry_msgs/msg/Pose")()
    pose.position.x = 0.5
    here, there = Robot(), Robot()
    here.activate_communication("pose2", "publish")
    there.activate_communication("pose2", "listen")
    with serving(lambda: (here.pose2(pose), time.sleep(0.02))):
        assert there.pose2()[0].position.x == 0.5


def test_pixels_of_cameras() -> None:
    """A camera that says rgb8 is understood; sizes that do not fit are not."""
    form = PictureForm({}, load)
    sent = form.spelled(np.full((2, 3, 3), (1, 2, 3), np.uint8))
    assert (sent.encoding, sent.height, sent.width, sent.step) == ("bgr8", 2, 3, 9)
    assert bytes(sent.data) == bytes([1, 2, 3] * 6) and sent.header.stamp.secs > 0
    sent.encoding = "rgb8"
    assert form.value(sent)[0, 0].tolist() == [3, 2, 1]
    sent.width = 1 << 30
    with pytest.raises(yarpy.DecodeError, match="does not fit together"):
        form.value(sent)
    floats = PictureForm({"fp": True, "rgb": False}, load).spelled(np.zeros((2, 3)))
    assert (floats.encoding, floats.step, len(floats.data)) == ("32FC1", 12, 24)


def test_sounds_that_do_not_fit() -> None:
    form = SoundForm({"rate": 8000}, load, "wrapyfi_ros_interfaces/ROSAudioMessage")
    assert form.spelled(None) is None and form.spelled((None, 8000)) is None
    sent = form.spelled((np.array([0.5, 1.0], np.float32), 8000))
    assert (sent.encoding, sent.chunk_size, sent.channels, sent.step) == ("S16LE", 2, 1, 4)
    sent.is_bigendian, sent.data = 1, sent.data.reshape(2, 4)[:, ::-1].reshape(-1)
    assert form.value(sent)[0].tolist() == [[0.5], [1.0]]
    sent.chunk_size = 1 << 31
    with pytest.raises(yarpy.DecodeError, match="in 8 bytes"):
        form.value(sent)


def test_messages_of_others() -> None:
    class Fields:
        """As rclpy makes them."""

        def __init__(self, **fields: Any) -> None:
            self.__dict__ = fields

        def get_fields_and_field_types(self) -> dict[str, str]:
            return dict.fromkeys(self.__dict__, "")

    class Pose(Fields):
        __module__ = "geometry_msgs.msg._pose"

    point, turn = Fields(x=0.5, y=1.0, z=2.0), Fields(x=0.0, y=0.0, z=0.0, w=1.0)
    found = ours(Pose(position=point, orientation=turn), load)
    assert (found._type, found.position.z, found.orientation.w) == ("geometry_msgs/Pose", 2.0, 1.0)
    with pytest.raises(TypeError, match="str is no message of ROS"):
        ours("x", load)
