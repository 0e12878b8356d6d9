"""Real Wrapyfi 0.5: its own tests with only the package exchanged, and each type both ways."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
from support.broker import Broker
from support.peer import brings
from support.port import free_block, free_port
from support.process import Process
from support.ros import PYTHON
from support.ros2_peer import ros2_router
from support.ros_graph import ros_graph
from support.wait import HANG
from support.wrapyfi_venv import prepare

import yarpy

for needed in ("zmq", "zenoh", "xxhash"):
    pytest.importorskip(needed)
ROOT = Path(__file__).parents[2]
OURS = ROOT / "compat" / "wrapyfi" / "src"
CROSS = Path(__file__).parent / "programs" / "cross.py"
TESTS = {
    "test_wrapper.YarpTestWrapper": 3,
    "test_wrapper.ZeroMQTestWrapper": 3,
    "test_middleware.YarpTestMiddleware": 1,
    "test_middleware.ZeroMQTestMiddleware": 1,
    "test_wrapper.ROSTestWrapper": 3,
    "test_wrapper.ROS2TestWrapper": 3,
    "test_middleware.ROSTestMiddleware": 1,
}
TYPES = ("native", "rgb", "mono", "fp", "sound")
PICTURES: tuple[tuple[str, list[int], str], ...] = (
    ("rgb", [24, 32, 3], "uint8"),
    ("mono", [24, 32], "uint8"),
    ("fp", [24, 32, 3], "float32"),
    ("jpg", [24, 32, 3], "uint8"),
)
BYTES = ("zenoh", "mqtt", "websocket")
#: over YARP and ZeroMQ the other package's way of saving a JPEG file needs an older numpy; over
#: Zenoh it cannot read floats
SENT = {
    ("yarp", "ours"): (*TYPES, "jpg"),
    ("yarp", "real"): TYPES,
    ("zeromq", "ours"): (*TYPES, "jpg"),
    ("zeromq", "real"): TYPES,
    (",".join(BYTES), "ours"): ("native", "rgb", "mono", "jpg", "sound"),
    (",".join(BYTES), "real"): (*TYPES, "jpg"),
}


@pytest.fixture(scope="module")
@brings("wrapyfi")
def wrapyfi() -> Path:
    return prepare()


@pytest.fixture(scope="module")
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(free_block(200)) as found:
        yield found


def environment(server: yarpy.NameServer, path: str, **more: str) -> Mapping[str, str]:
    prefixes = ("YARP", "WRAPYFI", "XDG_", "PYTHON")
    clean = {k: v for k, v in os.environ.items() if not k.startswith(prefixes)}
    number = free_block(2)
    return {
        **clean,
        **server.environment,
        "PYTHONPATH": path,
        "WRAPYFI_ZEROMQ_SOCKET_PUB_PORT": str(number),
        "WRAPYFI_ZEROMQ_SOCKET_SUB_PORT": str(number + 1),
        **more,
    }


@contextmanager
def own_tests(
    wrapyfi: Path, server: yarpy.NameServer, folder: Path, ros: bool
) -> Iterator[dict[str, Process]]:
    """All of them at the same time: they sleep most of it. Their topics have the same names."""
    shutil.copytree(OURS / "wrapyfi", folder / "wrapyfi")
    theirs = next(wrapyfi.glob("lib/python*/site-packages/wrapyfi/tests"))
    shutil.copytree(theirs, folder / "wrapyfi" / "tests")
    with ExitStack() as stack:
        known = {"YARPY_ZENOH": f"127.0.0.1:{stack.enter_context(ros2_router())}"}
        if ros:
            known |= stack.enter_context(ros_graph(folder)).environment
        yield {
            name: stack.enter_context(
                Process(
                    [sys.executable, "-m", "unittest", "-v", f"wrapyfi.tests.{name}"],
                    env={
                        **environment(server, str(folder)),
                        **stack.enter_context(yarpy.NameServer(free_block(200))).environment,
                        **known,
                    },
                    cwd=folder,
                )
            )
            for name in TESTS
            if ("ROSTest" in name) == ros
        }


@pytest.fixture(scope="module")
def without_ros(
    wrapyfi: Path, server: yarpy.NameServer, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[str, Process]]:
    with own_tests(wrapyfi, server, tmp_path_factory.mktemp("exchanged"), ros=False) as found:
        yield found


@pytest.fixture(scope="module")
@brings("ros", "rosmaster")
def with_ros(
    wrapyfi: Path, server: yarpy.NameServer, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[str, Process]]:
    with own_tests(wrapyfi, server, tmp_path_factory.mktemp("exchanged"), ros=True) as found:
        yield found


@pytest.mark.parametrize("name", [name for name in TESTS if "ROSTest" not in name])
def test_its_own_tests_pass_with_the_package_exchanged(
    name: str, without_ros: dict[str, Process]
) -> None:
    passes(without_ros[name], TESTS[name])


@pytest.mark.parametrize("name", [name for name in TESTS if "ROSTest" in name])
def test_its_own_tests_of_ros_pass(name: str, with_ros: dict[str, Process]) -> None:
    passes(with_ros[name], TESTS[name])


def passes(process: Process, count: int) -> None:
    assert process.wait(2 * HANG) == 0, process.stderr
    assert f"Ran {count} test" in process.stderr
    assert "skipped" not in process.stderr
    assert "nothing is sent" not in process.stderr


@pytest.fixture(scope="module")
@brings("mosquitto")
def crossing(
    wrapyfi: Path, server: yarpy.NameServer, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[tuple[str, str], list[Process]]]:
    """Pairs of programs: who sends, and over what; the other side takes."""
    folder = tmp_path_factory.mktemp("cross")
    ours = sys.executable, str(OURS)
    real = str(wrapyfi / "bin/python"), f"{ROOT / 'src'}{os.pathsep}{ROOT / 'compat/src'}"
    pairs = {"ours": (ours, real), "real": (real, ours)}
    with ExitStack() as stack:
        pairs_of = {}
        for (mwares, side), types in SENT.items():
            # Its publishers over ZeroMQ do not see in time that somebody listens.
            waits = "0" if (mwares, side) == ("zeromq", "real") else "1"
            known = environment(server, "", CROSS_WAIT=waits)
            if mwares == "yarp":  # topics of their own at the name server
                own = stack.enter_context(yarpy.NameServer(free_block(200)))
                known = {**known, **own.environment}
                types = (*types, "ask")
            elif mwares != "zeromq":
                known = {**known, **_servers(stack, folder)}
            both = [
                stack.enter_context(
                    Process(
                        [python, CROSS, word, mwares, *types],
                        env={**known, "PYTHONPATH": path},
                        cwd=folder,
                    )
                )
                for word, (python, path) in zip(("send", "take"), pairs[side], strict=True)
            ]
            pairs_of.update({(mware, side): both for mware in mwares.split(",")})
        yield pairs_of


def _servers(stack: ExitStack, folder: Path) -> dict[str, str]:
    """A router of Zenoh, a broker of MQTT and a Socket.IO server, and how they are said."""
    pytest.importorskip("zenoh")
    pytest.importorskip("socketio")
    from support.socketio_server import SocketIoServer

    from yarpy.peers.zenoh.router import open_router
    from yarpy.peers.zenoh.transport import close

    broker = Broker(folder)
    stack.callback(broker.stop)
    router, events = free_port(), free_port()
    stack.callback(close, open_router([f"tcp/127.0.0.1:{router}"]))
    stack.enter_context(SocketIoServer(events))
    return {
        "WRAPYFI_ZENOH_PORT": str(router),
        "WRAPYFI_ZENOH_MODE": "client",
        "WRAPYFI_MQTT_BROKER_ADDRESS": "127.0.0.1",
        "WRAPYFI_MQTT_BROKER_PORT": str(broker.port),
        "WRAPYFI_WEBSOCKET_SOCKET_PORT": str(events),
    }


@pytest.mark.parametrize("side", ["ours", "real"])
@pytest.mark.parametrize("mware", ["yarp", "zeromq", *BYTES])
def test_each_type_crosses(
    mware: str, side: str, crossing: dict[tuple[str, str], list[Process]]
) -> None:
    """`side` sends; what the other one got is printed."""
    sender, process = crossing[mware, side]
    found: dict[str, Any] = {}
    sent = next(types for (known, who), types in SENT.items() if who == side and mware in known)
    for name in sent:
        pattern = rf'^\["{mware}", "{name}", .*\]$'
        try:
            line = process.wait_line(pattern, timeout=2 * HANG, stream="out")
        except AssertionError as error:
            raise AssertionError(f"{error}\nThe sender {sender}{sender.said()}") from None
        found[name] = json.loads(line[0])[2]
    native = "{'t': (1, 2), 's': {1, None}, 'a': array([0., 1., 2., 3.]), 'n': [None, True, 2.5]}"
    assert found["native"] in (native, native.replace("{1, None}", "{None, 1}"))
    for name, shape, kind in PICTURES:
        if name in found:
            assert found[name] == {"shape": shape, "dtype": kind, "near": True}
    assert found["sound"] == {"rate": 16000, "near": True}
    if mware == "yarp":
        line = process.wait_line(r'^\["yarp", "ask", .*\]$', timeout=HANG, stream="out")
        first = "(1, 2)" if side == "real" else "[1, 2]"  # nested tuples are marked here
        expected = f"{{'args': [{first}, [3]], 'kwargs': {{'k': {{'z': (9,)}}}}}}"
        assert json.loads(line[0])[2] == expected


ROS_TYPES = (*TYPES, "jpg", "pose", "property", "ask", "ask_rgb", "ask_sound")


@pytest.fixture(scope="module")
@brings("ros", "rosmaster")
def crossing_ros(
    wrapyfi: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[str, Process]]:
    """The same over ROS 1: the other side is Wrapyfi on rospy, in Debian's Python."""
    site = next(wrapyfi.glob("lib/python*/site-packages"))
    ours, real = (sys.executable, OURS), (PYTHON, site)
    with ExitStack() as stack:
        takers = {}
        graph = stack.enter_context(ros_graph(tmp_path_factory.mktemp("ros")))
        graph.needs_packages(site)
        for side, pair in {"ours": (ours, real), "real": (real, ours)}.items():
            known = {**graph.environment, "CROSS_TOPICS": f"/{side}"}
            for word, (python, path) in zip(("send", "take"), pair, strict=True):
                takers[side] = Process(
                    [python, CROSS, word, "ros", *ROS_TYPES],
                    env={**known, "PYTHONPATH": str(path)},
                    cwd=graph.home,
                )
                stack.enter_context(takers[side])
        yield takers


@pytest.mark.parametrize("side", ["ours", "real"])
def test_each_type_crosses_ros(side: str, crossing_ros: dict[str, Process]) -> None:
    found: dict[str, Any] = {}
    for name in ROS_TYPES:
        pattern = rf'^\["ros", "{name}", .*\]$'
        line = crossing_ros[side].wait_line(pattern, timeout=2 * HANG, stream="out")
        found[name] = json.loads(line[0])[2]
    assert "'t': (1, 2)" in found["native"] and "'n': [None, True, 2.5]" in found["native"]
    for name, shape, kind in (*PICTURES, ("ask_rgb", [24, 32, 3], "uint8")):
        assert found[name] == {"shape": shape, "dtype": kind, "near": True}
    assert found["sound"] == found["ask_sound"] == {"rate": 16000, "near": True}
    assert found["pose"] == [0.5, 0.0, "geometry_msgs/Pose"]
    assert found["property"] == "{'a': [1, 2.5], 'b': 'word'}"
    assert "[3]], 'kwargs': {'k': {'z': (9,)}}" in found["ask"]
