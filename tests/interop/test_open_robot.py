"""The simulated robot, as it is, for programs that know nothing of YARP: pyzmq, mosquitto, a node
of ROS 2 by others and a client of Zenoh see its camera and its joints, and move its head."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from support.peer import program
from support.port import free_block
from support.process import Process
from support.ros2_peer import ros2_router
from support.wait import HANG, wait_until

import yarpy
from yarpy.carriers.payload import value_of
from yarpy.kits.devices import ControlBoard
from yarpy.kits.sim.robot import Robot, icub_head

zmq = pytest.importorskip("zmq", reason="needs pyzmq (pip install pyzmq)")

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def names() -> Iterator[Any]:
    with (
        yarpy.NameServer(free_block(100)) as server,
        Robot("/icubSim", icub_head((64, 48)), names=server.client),
    ):
        yield server.client


@contextmanager
def connected(kind: int, names: Any, port: str) -> Iterator[Any]:
    """A socket at a port of the robot."""
    with zmq.Context() as context, context.socket(kind) as socket:
        socket.linger, socket.rcvtimeo = 0, int(1000 * HANG)
        socket.connect(f"tcp://{names.query(port).address}")
        yield socket


def mosquitto(name: str, names: Any, port: str, *words: str) -> bytes:
    contact = names.query(port)
    command = [program(name, of="mosquitto"), "-h", contact.host, "-p", str(contact.port), *words]
    return subprocess.run(command, capture_output=True, timeout=2 * HANG).stdout


def test_its_camera(names: Any) -> None:
    with connected(zmq.SUB, names, "/icubSim/cam/left") as socket:
        socket.subscribe(b"")
        topic, payload = socket.recv_multipart()
    assert topic == b"/icubSim/cam/left"
    assert (value_of(payload).width, value_of(payload).height) == (64, 48)


@pytest.mark.peer("mosquitto")
def test_its_camera_for_mosquitto(names: Any) -> None:
    payload = mosquitto("mosquitto_sub", names, "/icubSim/cam/left", "-t", "#", "-C", "1", "-N")
    assert (value_of(payload).width, value_of(payload).height) == (64, 48)


def test_its_joints(names: Any) -> None:
    with connected(zmq.SUB, names, "/icubSim/head/state:o") as socket:
        socket.subscribe(b"")
        assert len(value_of(socket.recv_multipart()[1])) == 6


@pytest.mark.peer("mosquitto")
def test_its_joints_for_mosquitto(names: Any) -> None:
    line = mosquitto("mosquitto_sub", names, "/icubSim/head/state:o", "-t", "#", "-C", "1")
    assert len(value_of(line.strip())) == 6


def test_its_head_is_moved(names: Any) -> None:
    with connected(zmq.REQ, names, "/icubSim/head/rpc:i") as socket:
        socket.send_json(["set", "pos", 0, 10.0])
        assert socket.recv_json()[-1] == "ok"
        socket.send_json(["get", "axes"])
        assert socket.recv_json()[:3] == ["is", "axes", 6]


@pytest.mark.peer("mosquitto")
def test_its_head_is_asked_by_mosquitto(names: Any) -> None:
    words = ("-t", "ask", "-e", "answer", "-m", '["get", "axes"]')
    answer = mosquitto("mosquitto_rr", names, "/icubSim/head/rpc:i", *words)
    assert value_of(answer.strip())[:3] == ["is", "axes", 6]


@pytest.mark.peer("mosquitto")
def test_all_at_once(tmp_path: Path) -> None:
    """The page docs/open-robot.md: `yarpy sim`, the example, and what it prints."""
    for needed in ("zenoh", "zenoh_ros2_sdk", "rosbags"):
        pytest.importorskip(needed)
    with ros2_router() as number, yarpy.NameServer(free_block(100)) as server:
        clean = {k: v for k, v in os.environ.items() if not k.startswith(("YARP", "ZENOH", "ROS"))}
        env = {**clean, **server.environment, "YARPY_ZENOH": f"tcp/127.0.0.1:{number}"}
        env["HOME"] = str(tmp_path)
        with Process([sys.executable, "-m", "yarpy", "sim"], env=env) as robot:
            robot.wait_line("is ready")
            with ControlBoard("/icubSim/head", names=server.client) as head:
                head.position_move([2], [20.0])
                wait_until(lambda: head.encoders() == [0, 0, 20, 0, 0, 0])
            with Process([sys.executable, str(ROOT / "examples/open_robot.py")], env=env) as seen:
                assert seen.wait(HANG) == 0, seen.stderr
    lines = seen.stdout.splitlines()
    assert len(lines) == 8
    assert "\n".join(lines) in (ROOT / "docs" / "open-robot.md").read_text()
    assert "which YARP" not in robot.stderr, "topics of ROS 2 are not asked which YARP they are"
