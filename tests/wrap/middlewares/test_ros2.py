"""Topics of ROS 2 from hints, over a router of Zenoh, beside a port that knows no decorators."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
import pytest
from support.patience import patience
from support.port import free_port
from support.wait import wait_until

import yarpy
from yarpy import wrap
from yarpy.wrap.hint import shape_of
from yarpy.wrap.middleware import Way
from yarpy.wrap.middlewares.ros2 import target_of

for _name in ("zenoh", "rosbags", "xxhash"):
    pytest.importorskip(_name)
PATIENCE = patience(10.0)
Picture = Annotated[np.ndarray, wrap.Image("bgr")]


class Robot:
    @wrap.on("/camera", "ros2")
    @wrap.on("/state", "ros2")
    @wrap.on("/word", "ros2")
    def see(self) -> tuple[Picture, dict, str]:
        return np.full((2, 4, 3), (1, 2, 3), "u1"), {"t": (1, None)}, "hello"

    @wrap.on("/ask", "ros2")
    def ask(self) -> str:
        return ""


@pytest.fixture
def router(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    from yarpy.transports.zenoh import close
    from yarpy.transports.zenoh_router import open_router

    where = f"tcp/127.0.0.1:{free_port()}"
    opened = open_router([where])
    monkeypatch.setenv("YARPY_ZENOH", where)
    yield
    close(opened)


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

        wait_until(seen, PATIENCE)
        assert ear.read(timeout=PATIENCE).value == "hello"


def test_targets_and_what_is_refused() -> None:
    target = target_of(Way("/camera/image", carrier="domain.7+node.me"), shape_of(Picture))
    assert target == "ros2+domain.7+node.me://camera/image~sensor_msgs/msg/Image"
    for mode in (wrap.serve, wrap.call):
        with pytest.raises(yarpy.LocalProtocolError, match="a service of ROS 2 has a type"):
            mode(Robot().ask)
    for wrong in ({"middleware": "ros2://here"}, {"keep": 3}):
        with pytest.raises(ValueError):
            wrap.on("/x", **({"middleware": "ros2"} | wrong))(lambda: 1)  # type: ignore[arg-type]
