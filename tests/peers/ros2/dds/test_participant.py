"""Topics over DDS, on this computer alone: between ports, and with a program of another kind."""

import json
import logging
import os
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest
from support import dds_peer, fast_dds
from support.port import addresses
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import UnknownName
from yarpy.names.address import is_loopback, local_addresses
from yarpy.names.default import DEFAULT
from yarpy.peers import ros2
from yarpy.peers.ros2.dds.participant import LOCAL, POOL, Participant, settings
from yarpy.peers.ros2.token import PUBLISHER


@pytest.fixture(autouse=True)
def _here(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Nothing leaves this computer."""
    monkeypatch.setenv("CYCLONEDDS_URI", LOCAL)
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    names = yarpy.LocalNames()
    DEFAULT.push(names)
    yield
    DEFAULT.pop(names)


class Peer(Process):
    def __init__(self, *words: str) -> None:
        super().__init__([sys.executable, "-P", str(Path(dds_peer.__file__)), *words])
        wait_until(lambda: "ready" in self.said, HANG, "the peer is ready")

    @property
    def said(self) -> list[object]:
        return [json.loads(line) for line in self.stdout.splitlines()]


SUBNET = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}


@pytest.mark.parametrize(
    ("environment", "bound", "told", "who"),
    [
        ({"ROS_LOCALHOST_ONLY": "1"}, "", LOCAL, "this computer alone"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "localhost"}, "", LOCAL, "this computer alone"),
        ({"ROS_LOCALHOST_ONLY": "0", **SUBNET}, "", "", "all networks"),
        ({}, "", "", "all networks"),
        ({}, "127.0.0.1", LOCAL, "this computer alone"),
        (SUBNET, "127.0.0.1", "", "all networks"),
        ({"CYCLONEDDS_URI": "<x/>"}, "127.0.0.1", "", "CYCLONEDDS_URI"),
        ({}, "192.168.1.7", '<NetworkInterface address="192.168.1.7"/>', ""),
    ],
)
def test_where_others_are_looked_for(
    environment: dict[str, str], bound: str, told: str, who: str
) -> None:
    found = settings(environment, bound)
    assert (told in found[0] if told else not found[0]) and who in found[1]


OUTWARD = [one for one in local_addresses() if "." in one and not is_loopback(one)]


SAYS = """
import logging, sys, yarpy
logging.basicConfig(level=logging.INFO)
with yarpy.Port("/out", names=yarpy.LocalNames()) as out:
    out.connect(f"ros2+dds:/{sys.argv[1]}~std_msgs/msg/String", timeout=float(sys.argv[2]))
    for line in sys.stdin:
        out.write(line.strip())
"""


@pytest.mark.skipif(not OUTWARD, reason="this computer has no address but the loopback")
@pytest.mark.skipif(sys.platform != "linux", reason="needs Linux' /proc")
@pytest.mark.parametrize("bind", ["", "local"])
def test_a_program_sends_where_its_ports_listen(topic: str, bind: str) -> None:
    """And is heard there: the other program is at the loopback, and ours tells it where it is."""
    said = "this computer alone" if bind else "all networks"
    ours = {**os.environ, "YARPY_BIND": bind, "CYCLONEDDS_URI": ""}
    with (
        Peer("hear", topic) as hears,
        Process([sys.executable, "-c", SAYS, topic, str(HANG)], env=ours) as says,
    ):
        says.wait_line(f"DDS is spoken in domain 0, open to {said}")
        if bind:
            wait_until(lambda: says.write_line("hello") or "hello" in hears.said)
            assert OUTWARD[0] not in addresses(says.pid, "udp")
        else:  # Linux lists sockets in parts, and leaves out some where others come and go
            wait_until(lambda: OUTWARD[0] in addresses(says.pid, "udp"))


def test_a_domain_of_this_computer_is_joined_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """The settings are the library's for as long as anybody is in the domain."""
    monkeypatch.delenv("CYCLONEDDS_URI")
    monkeypatch.setenv("ROS_LOCALHOST_ONLY", "1")
    for _ in range(2):
        with yarpy.Port("/out") as out:
            out.connect("ros2+dds+domain.7://chatter~std_msgs/msg/String")
            assert len(out.outputs) == 1


def test_a_domain_of_this_computer_is_joined_while_it_is_left(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As by a port that opens while another thread closes the last one."""
    monkeypatch.delenv("CYCLONEDDS_URI")
    monkeypatch.setenv("ROS_LOCALHOST_ONLY", "1")
    leaving = Participant(8)
    joining = Participant(8)
    leaving.end()
    assert joining.seen("/nobody", PUBLISHER) == []
    joining.end()
    Participant(8).end()


def test_a_picture(topic: str) -> None:
    pixels = np.arange(12, dtype="u1").reshape(2, 2, 3)
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in") as reader:
        out.connect(f"ros2+dds:/{topic}~sensor_msgs/msg/Image")
        reader.listen_to(f"ros2+dds:/{topic}")  # it learns the type
        wait_until(lambda: out.write(yarpy.Image(pixels)) and reader.waiting)
        found = reader.read(timeout=HANG)
        assert np.array_equal(found.as_(yarpy.Image).array, pixels)
        assert found.stamp is not None
        assert abs(found.stamp.time - time.time()) < 2 * HANG


def test_with_a_program_of_another_kind(topic: str) -> None:
    with (
        Peer("hear", f"{topic}/chatter") as hears,
        Peer("say", f"{topic}/news") as says,
        yarpy.Port("/out") as out,
        yarpy.BufferedPort("/in", strict=True) as reader,
    ):
        out.connect(f"ros2+dds:/{topic}/chatter")
        reader.listen_to(f"ros2+dds:/{topic}/news", timeout=HANG)
        wait_until(lambda: out.write("grüße") and "grüße" in hears.said)
        wait_until(lambda: says.write_line("hello from there") or reader.waiting)
        assert reader.read(timeout=HANG).value == "hello from there"


@pytest.mark.peer("fast_dds", "g++")
def test_with_fast_dds(tmp_path: Path) -> None:
    """The library that nodes of ROS 2 use by default."""
    program = str(fast_dds.build(tmp_path))
    with (
        Process([program, "hear", f"/chatter{os.getpid()}"]) as hears,
        Process([program, "say", f"/news{os.getpid()}"]) as says,
        yarpy.Port("/out") as out,
        yarpy.BufferedPort("/in", strict=True) as reader,
    ):
        for each in (hears, says):
            each.wait_line("^ready$", stream="out")
        out.connect(f"ros2+dds+qos.all://chatter{os.getpid()}", timeout=HANG)
        # Nobody need have been found by then.
        wait_until(lambda: out.write("grüße") and "grüße" in hears.stdout)
        for number in range(300):
            out.write(f"number {number}")
        out.write("x" * 60_000, wait=True)
        hears.wait_line("^x{60000}$", stream="out")
        heard = sum("number" in line for line in hears.stdout.splitlines())
        assert heard + out.stats.outputs[0].drops == 300
        reader.connect(f"ros2+dds+qos.all+sub://news{os.getpid()}", timeout=HANG)
        wait_until(lambda: says.write_line("first") or reader.waiting)  # it has found us, too
        for number in range(300):
            says.write_line(f"ä {number}")
        found = [reader.read(timeout=HANG).ros.data for _ in range(300)]
        while found[0] == "first":
            found = [*found[1:], reader.read(timeout=HANG).ros.data]
        assert found == [f"ä {number}" for number in range(300)]


def test_what_others_promise_is_taken(topic: str) -> None:
    with (
        Peer("sensor", topic) as says,
        yarpy.BufferedPort("/in", strict=True) as reader,
    ):
        reader.listen_to(f"ros2+dds:/{topic}", timeout=HANG)
        wait_until(lambda: says.write_line("seen") or reader.waiting)
        assert reader.read(timeout=HANG).value == "seen"


def test_a_promise_that_is_not_enough_is_named(
    topic: str, caplog: pytest.LogCaptureFixture
) -> None:
    with (
        yarpy.Port("/out") as out,
        yarpy.BufferedPort("/in") as reader,
        caplog.at_level(logging.WARNING, logger="yarpy"),
    ):
        reader.listen_to(f"ros2+dds+qos.default:/{topic}~std_msgs/msg/String")
        out.connect(f"ros2+dds+qos.sensor:/{topic}~std_msgs/msg/String")
        wait_until(lambda: "promises less than we ask for" in caplog.text)


def test_several_threads_look_at_once() -> None:
    """The library translates what others promise in variables that all threads share."""
    own = f"/many_{os.getpid()}"
    qualities = {f"{own}/arm": "sensor", f"{own}/head": "latched", f"{own}/leg": "default"}
    with ExitStack() as held:
        node = held.enter_context(ros2.Node(own, rmw="dds"))
        for name, qos in qualities.items():
            node.publisher(name, "std_msgs/msg/String", qos=qos)
        part = POOL.take(0)
        held.callback(POOL.leave, part)
        expected = {name: part.seen(name, PUBLISHER)[0].qos for name in qualities}
        assert len(set(expected.values())) == len(qualities)

        def look(name: str) -> set[object]:
            return {item.qos for _ in range(100) for item in part.seen(name, PUBLISHER)}

        names = [*qualities] * 2
        with ThreadPoolExecutor(len(names)) as pool:
            assert [*pool.map(look, names)] == [{expected[name]} for name in names]


def test_what_was_latched(topic: str) -> None:
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:
        out.connect(f"ros2+dds+qos.latched:/{topic}~std_msgs/msg/String")
        out.write("first")
        out.write("last")
        reader.listen_to(f"ros2+dds:/{topic}")
        assert reader.read(timeout=HANG).value == "last"


def test_what_is_wrong(own: str) -> None:
    with yarpy.BufferedPort("/in") as reader:
        with pytest.raises(UnknownName, match=f"nobody publishes {own} over DDS"):
            reader.listen_to(f"ros2+dds:/{own}")
        with pytest.raises(UnknownName, match=f"nobody serves {own} over DDS"):
            reader.connect(f"ros2+dds+srv:/{own}")
        assert reader.stats.inputs == []
