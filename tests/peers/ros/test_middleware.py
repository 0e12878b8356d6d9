"""Topics of ROS 1 from hints, beside rostopic; types without a master."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pytest
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.peers.ros.middleware import type_of

Picture = Annotated[np.ndarray, wrap.Image("bgr")]


class Robot:
    @wrap.on("/camera", "ros")
    @wrap.on("/state", "ros")
    @wrap.on("/word", "ros")
    def see(self) -> tuple[Picture, dict, str]:
        return np.full((2, 4, 3), (1, 2, 3), "u1"), {"t": (1, None)}, "hello"

    @wrap.on("/ask", "ros", timeout=HANG)
    def ask(self, word: str, more: dict | None = None) -> dict:
        if not word:
            raise ValueError("nothing: was said")
        return {"word": word, "more": more}

    @wrap.on("/switch", "ros", timeout=HANG)
    def switch(self, data: bool) -> tuple[bool, str]:
        return data, "done"

    @wrap.on("/other~std_srvs/SetBool", "ros", timeout=HANG)
    def other(self, data: bool) -> tuple[bool, str]: ...


@pytest.mark.parametrize(
    ("hint", "type_"),
    [
        *[(str, "String"), (int, "Int64"), (float, "Float64"), (bool, "Bool"), (dict, "String")],
        *[(bytes, "String"), (Any, "String"), (yarpy.Vector, "String"), (np.ndarray, "String")],
    ],
)
def test_types_of_hints(hint: Any, type_: str) -> None:
    assert type_of(shape_of(hint)) == f"std_msgs/{type_}"


def test_types_of_sensors() -> None:
    assert type_of(shape_of(Picture)) == "sensor_msgs/Image"
    jpeg = Annotated[np.ndarray, wrap.Image("bgr", jpeg=90)]
    assert type_of(shape_of(jpeg)) == "sensor_msgs/CompressedImage"
    assert type_of(shape_of(yarpy.PointCloud)) == "sensor_msgs/PointCloud2"


def test_what_is_refused() -> None:
    for wrong in ({"carrier": "udp"}, {"keep": 3}, {"qos": yarpy.Qos(packets="HIGH")}):
        with pytest.raises(ValueError):
            wrap.on("/x", "ros", **wrong)(lambda: 1)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match='the parameter "c": std_srvs/SetBool has data'):
        wrap.on("/x~std_srvs/SetBool", "ros")(lambda c: None)
    with pytest.raises(yarpy.UnknownType):
        wrap.on("/x~nobody/Has", "ros")(lambda c: None)


@pytest.mark.usefixtures("names")
@pytest.mark.peer("ros", "rosmaster")
def test_topics(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_IP", "127.0.0.1")
    graph = RosGraph(tmp_path)
    try:
        here, there, place = Robot(), Robot(), f"ros://127.0.0.1:{graph.port}"
        wrap.listen(there.see, middleware=place)
        with wrap.publish(here.see, middleware=place) as out:
            echo = graph.run("rostopic", "echo", "-n", "1", "/word")
            wait_until(lambda: len(out.stats[2]["outputs"]) == 2)
            wait_until(lambda: all(one["outputs"] for one in out.stats))
            here.see()
            picture, state, word = there.see(timeout=HANG)
            assert picture.tolist() == here.see()[0].tolist()
            assert (state, word) == ({"t": (1, None)}, "hello")
            assert wrap.last(there.see)[0].stamp.count == 0
            echo.wait_line('data: "hello"', timeout=HANG)
    finally:
        wrap.off(there.see).close()
        graph.close()


SERVER = """
import rospy, std_srvs.srv
rospy.init_node("server")
def answer(asked):
    if not asked.data:
        raise ValueError("too dark")
    return [True, "light"]
rospy.Service("/other", std_srvs.srv.SetBool, answer)
print("ready", flush=True)
rospy.spin()
"""


@pytest.mark.usefixtures("names")
@pytest.mark.peer("ros", "rosmaster")
def test_services(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_IP", "127.0.0.1")
    graph = RosGraph(tmp_path)
    try:
        here, there, place = Robot(), Robot(), f"ros://127.0.0.1:{graph.port}"
        with (
            wrap.serve(here.ask, middleware=place),
            wrap.serve(here.switch, middleware=place),
            wrap.call(there.ask, middleware=place),
            wrap.call(there.switch, middleware=place),
            wrap.call(there.other, middleware=place),
        ):
            peer = graph.python(SERVER)
            assert there.ask("x", {"a": [1, None]}) == {"word": "x", "more": {"a": [1, None]}}
            assert there.ask(word="y") == {"word": "y", "more": None}
            with pytest.raises(wrap.RemoteError) as caught:
                there.ask("")
            assert (caught.value.type, caught.value.text) == ("ValueError", "nothing: was said")
            assert there.switch(True) == (True, "done")
            assert 'message: "done"' in graph.tool("rosservice", "call", "/switch", "true")
            peer.wait_line("ready", timeout=HANG, stream="out")
            assert there.other(True) == (True, "light")
            with pytest.raises(wrap.RemoteError, match="too dark"):
                there.other(False)
        with pytest.raises(yarpy.LocalProtocolError, match="is a service"):
            wrap.publish(there.other, middleware=place)
        wrap.call(there.ask, middleware=place)
        with pytest.raises(yarpy.Timeout, match="nobody served"):
            there.ask("x", timeout=0.3)
        wrap.off(there.ask).close()
    finally:
        graph.close()
