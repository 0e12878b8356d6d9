"""Recordings are played as topics of a node. The peers of ROS 2 are programs of others: cyclonedds
with a type of its own, and zenoh-ros2-sdk."""

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from support.dds_program import Peer
from support.process import Process
from support.recordings import START, payload_of
from support.ros2_peer import peer_command, peer_environment, ros2_router
from support.wait import HANG, wait_until

import yarpy
from yarpy import record, ros2
from yarpy.errors import AddressError, LocalProtocolError
from yarpy.kits.record.mcap.layout import Channel, Other, Schema
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.playback.topic import checked_node
from yarpy.peers.ros2.dds.participant import LOCAL

OWN = f"n{os.getpid()}"  # names that nothing else on this computer has


def body(name: str, /, **fields: object) -> bytes:
    return b"".join(map(bytes, ros2.load(name)(**fields).to_ros()))


@pytest.fixture
def recording(tmp_path: Path) -> Iterator[record.Recording]:
    """Texts and a type that only the file defines, of ROS 2, and a vector of YARP."""
    with McapWriter(tmp_path / "x.mcap") as writer:
        words = Channel(
            "/words", "cdr", Schema("std_msgs/msg/String", "ros2msg", b"string data"), {}
        )
        mine = Channel("/mine", "cdr", Schema("own_msgs/msg/Text", "ros2msg", b"string data"), {})
        data = body("std_msgs/msg/String", data="hello")
        for n in range(50):
            at = START + n * 10_000_000
            writer.add_other(Other(words, n, at, at, data))
            writer.add_other(Other(mine, n, at, at, data))
            writer.add("/numbers", f"{n} 1.5", at, payload_of(yarpy.Vector([0.5, n])))
    with record.open(tmp_path / "x.mcap") as found:
        yield found


@contextmanager
def played(recording: record.Recording, node: str) -> Iterator[record.Player]:
    """Play it again and again."""
    with record.Player(
        recording, node=node, loop=True, prefix=f"/{OWN}", names=yarpy.LocalNames()
    ) as player:
        playing = threading.Thread(target=player.play)
        playing.start()
        try:
            yield player
        finally:
            player.stop()
            playing.join(HANG)
        assert not playing.is_alive()


@pytest.mark.parametrize("text", ["/player", "/a/b", "ros2://player", "ros2+dds+domain.7://a/b"])
def test_names_of_nodes(text: str) -> None:
    assert checked_node(text) == text


@pytest.mark.parametrize(
    "text", ["player", "/", "/a//b", "/a b", "/a+@/b", "ros2:/a", "://a", "ros2:///a", "ros2://a/"]
)
def test_what_is_no_name_of_a_node(text: str) -> None:
    with pytest.raises(LocalProtocolError, match="no name of a node"):
        checked_node(text)


def test_over_dds(recording: record.Recording, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CYCLONEDDS_URI", LOCAL)
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    heard: list[list[float]] = []
    node = f"{OWN}_dds"
    with Peer() as peer, played(recording, f"ros2+dds://{node}") as player:
        peer.do("reader", "r", f"/{OWN}/words", "reliable", "volatile", 10)
        wait_until(lambda: "hello" in peer.heard("r"))
        with ros2.Node(f"{OWN}_ear", rmw="dds") as ear:
            numbers, kind = f"/{OWN}/numbers", "std_msgs/msg/Float64MultiArray"
            ear.subscriber(numbers, kind, lambda found: heard.append([*found.data]))
            wait_until(lambda: bool(heard))
        assert heard[0][0] == 0.5
        assert player.dropped == 0


def test_over_zenoh(
    recording: record.Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A type that only the file defines is known by its first message."""
    pytest.importorskip("zenoh", reason="the wheel of eclipse-zenoh does not load under wine")
    with ros2_router() as router:
        monkeypatch.setenv("YARPY_ZENOH", f"127.0.0.1:{router}")
        monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
        command = peer_command(router, "hear", f"/{OWN}/words")
        hearing = Process(command, env=peer_environment(tmp_path))
        with hearing, played(recording, f"ros2://{OWN}_zenoh"):
            hearing.wait_line('"hello"', stream="out")
            with ros2.Node(f"{OWN}_looks") as looks:
                listed = peer_command(router, "list")
                del looks
            with Process(listed, env=peer_environment(tmp_path)) as listing:
                listing.wait(HANG)
                assert "own_msgs/msg/Text" in listing.stdout


def test_a_name_that_is_none_in_ros_2(
    recording: record.Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CYCLONEDDS_URI", LOCAL)
    with pytest.raises(AddressError, match=r"no name of ROS 2.*--rename /words=/other"):
        record.Player(
            recording,
            ["/words"],
            node=f"ros2+dds://{OWN}",
            rename={"/words": "/state:o"},
            names=yarpy.LocalNames(),
        )
