"""The simulated robot, as it is, for programs that know nothing of YARP: pyzmq and mosquitto see
its camera and its joints, and move its head."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from support.patience import patience
from support.port import free_block

import yarpy
from yarpy.carriers.payload import value_of
from yarpy.sim.robot import Robot, icub_head

zmq = pytest.importorskip("zmq", reason="needs pyzmq (pip install pyzmq)")

WAIT = patience(10.0)


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
        socket.linger, socket.rcvtimeo = 0, int(1000 * WAIT)
        socket.connect(f"tcp://{names.query(port).address}")
        yield socket


def mosquitto(program: str, names: Any, port: str, *words: str) -> bytes:
    if not shutil.which(program):
        pytest.skip("needs mosquitto-clients")
    contact = names.query(port)
    command = [program, "-h", contact.host, "-p", str(contact.port), *words]
    return subprocess.run(command, capture_output=True, timeout=2 * WAIT).stdout


def test_its_camera(names: Any) -> None:
    with connected(zmq.SUB, names, "/icubSim/cam/left") as socket:
        socket.subscribe(b"")
        topic, payload = socket.recv_multipart()
    assert topic == b"/icubSim/cam/left"
    assert (value_of(payload).width, value_of(payload).height) == (64, 48)
    payload = mosquitto("mosquitto_sub", names, "/icubSim/cam/left", "-t", "#", "-C", "1", "-N")
    assert (value_of(payload).width, value_of(payload).height) == (64, 48)


def test_its_joints(names: Any) -> None:
    with connected(zmq.SUB, names, "/icubSim/head/state:o") as socket:
        socket.subscribe(b"")
        assert len(value_of(socket.recv_multipart()[1])) == 6
    line = mosquitto("mosquitto_sub", names, "/icubSim/head/state:o", "-t", "#", "-C", "1")
    assert len(value_of(line.strip())) == 6


def test_its_head_is_moved(names: Any) -> None:
    with connected(zmq.REQ, names, "/icubSim/head/rpc:i") as socket:
        socket.send_json(["set", "pos", 0, 10.0])
        assert socket.recv_json()[-1] == "ok"
        socket.send_json(["get", "axes"])
        assert socket.recv_json()[:3] == ["is", "axes", 6]
    words = ("-t", "ask", "-e", "answer", "-m", '["get", "axes"]')
    answer = mosquitto("mosquitto_rr", names, "/icubSim/head/rpc:i", *words)
    assert value_of(answer.strip())[:3] == ["is", "axes", 6]
