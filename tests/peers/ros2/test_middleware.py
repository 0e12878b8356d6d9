"""Topics of ROS 2 from hints, over a router of Zenoh, beside a port that knows no decorators."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest
from support.process import Process
from support.ros2_peer import peer_command, peer_environment, ros2_router
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.middleware import Binding
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.peers.ros2.middleware import target_of

for _name in ("zenoh", "rosbags", "xxhash"):
    pytest.importorskip(_name)
Picture = Annotated[np.ndarray, wrap.Image("bgr")]


class Robot:
    @wrap.on("/camera", "ros2")
    @wrap.on("/state", "ros2")
    @wrap.on("/word", "ros2")
    def see(self) -> tuple[Picture, dict, str]:
        return np.full((2, 4, 3), (1, 2, 3), "u1"), {"t": (1, None)}, "hello"

    @wrap.on("/ask", "ros2", timeout=HANG)
    def ask(self, word: str, numbers: list[float] = [0.5]) -> dict:  # noqa: B006
        if not word:
            raise ValueError("nothing: was said")
        return {"word": word, "numbers": numbers}

    @wrap.on("/look", "ros2", timeout=HANG)
    def look(self, size: int) -> Picture:
        return np.full((size, 4, 3), (1, 2, 3), "u1")

    @wrap.on("/add~example_interfaces/srv/AddTwoInts", "ros2", timeout=HANG)
    def add(self, a: int, b: int) -> int:
        return a + b


@pytest.fixture
def router(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    with ros2_router() as port:
        monkeypatch.setenv("YARPY_ZENOH", f"tcp/127.0.0.1:{port}")
        yield port


@pytest.mark.usefixtures("names", "router")
def test_topics() -> None:
    here, there = Robot(), Robot()
    with (
        wrap.listen(there.see),
        wrap.publish(here.see),
        yarpy.BufferedPort("/ear") as ear,
    ):
        ear.listen_to("ros2://word~std_msgs/msg/String")

        def seen() -> bool:
            here.see()
            try:
                picture, state, word = there.see(timeout=0.2)
            except yarpy.Timeout:
                return False
            assert picture[0, 0].tolist() == [1, 2, 3]
            assert (state, word) == ({"t": (1, None)}, "hello")
            return ear.waiting > 0

        wait_until(seen)
        assert ear.read(timeout=HANG).value == "hello"


def test_targets_and_what_is_refused() -> None:
    target = target_of(Binding("/camera/image", carrier="domain.7+node.me"), shape_of(Picture))
    assert target == "ros2+domain.7+node.me://camera/image~sensor_msgs/msg/Image"
    with pytest.raises(TypeError, match=r'"a": int64 in example_interfaces/.*says str'):
        wrap.on("/x~example_interfaces/srv/AddTwoInts", "ros2")(_wrong)
    for wrong in ({"middleware": "ros2://here"}, {"keep": 3}):
        with pytest.raises(ValueError):
            wrap.on("/x", **({"middleware": "ros2"} | wrong))(lambda: 1)  # type: ignore[arg-type]
    with pytest.raises(yarpy.LocalProtocolError, match=r'ros2 knows no "\+qso"'):
        wrap.on("/x", "ros2", carrier="qso.sensor")(lambda: 1)


def _wrong(a: str, b: int) -> int: ...


@pytest.mark.usefixtures("names")
def test_services(router: int) -> None:
    here, there = Robot(), Robot()
    with (
        wrap.serve(here.ask),
        wrap.serve(here.look),
        wrap.call(there.ask),
        wrap.call(there.look),
    ):
        assert there.ask("x", [1.0, 2.5]) == {"word": "x", "numbers": [1.0, 2.5]}
        assert there.ask("x") == {"word": "x", "numbers": [0.5]}
        with pytest.raises(wrap.RemoteError) as caught:
            there.ask("")
        assert (caught.value.type, caught.value.text) == ("ValueError", "nothing: was said")
        assert there.look(2)[1, 3].tolist() == [1, 2, 3]
    wrap.call(there.ask)
    with pytest.raises(yarpy.UnknownName, match="nobody serves"):
        there.ask("x", timeout=0.3)
    wrap.off(there.ask).close()


SERVER = """
import os, sys
from yarpy import wrap

class Robot:
    @wrap.on("/add~example_interfaces/srv/AddTwoInts", "ros2")
    def add(self, a: int, b: int) -> int:
        os._exit(1)

robot = Robot()
wrap.serve(robot.add)
print("ready", flush=True)
sys.stdin.read()
"""


@pytest.mark.usefixtures("names", "router")
def test_a_server_that_dies() -> None:
    there = Robot()
    with Process([sys.executable, "-c", SERVER]) as server:
        server.wait_line("ready", timeout=HANG, stream="out")
        with (
            wrap.call(there.add),
            pytest.raises(yarpy.LinkClosed, match="went away during the call"),
        ):
            there.add(1, 2)


@pytest.mark.usefixtures("names")
def test_services_beside_another_implementation(router: int, tmp_path: Path) -> None:
    pytest.importorskip("zenoh_ros2_sdk")
    known = peer_environment(tmp_path)
    here, there = Robot(), Robot()
    with wrap.serve(here.add), Process(peer_command(router, "call", "/add"), env=known) as peer:
        peer.wait_line("ready", timeout=HANG, stream="out")
        peer.write_line("5 37")
        peer.wait_line("^42$", timeout=HANG, stream="out")
    serve = peer_command(router, "serve", "/add")
    with wrap.call(there.add), Process(serve, env=known) as peer:
        assert there.add(2, b=3) == 5
