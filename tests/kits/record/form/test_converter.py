"""What is recorded of each kind of message, and that it comes back to the byte."""

from pathlib import Path

import mcap.reader
import numpy as np
import pytest
from support.recordings import START, payload_of

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.record.form.converter import Converter
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.mcap.storage import McapStorage
from yarpy.kits.record.mcap.writer import McapWriter

JOINTS = Bottle([part for _ in range(11) for part in (Bottle([1.5, 2.5]), Vocab("ok"))])
ROWS = [
    (yarpy.Image(np.zeros((4, 5, 3), "u1")), "foxglove.RawImage"),
    (yarpy.Image(np.zeros((4, 5, 3), "f4"), "rgb."), "yarp/image"),
    (yarpy.PointCloud([[1.0, 2, 3]]), "foxglove.PointCloud"),
    (yarpy.Sound(np.zeros((2, 8), "i2")), "foxglove.RawAudio"),
    (yarpy.Vector([1.5, 2]), "std_msgs/msg/Float64MultiArray"),
    (yarpy.Vector([1, 2], dtype="float32"), "std_msgs/msg/Float64MultiArray"),
    (yarpy.Matrix(np.eye(2)), "std_msgs/msg/Float64MultiArray"),
    ([1, 2.5, [3, 4]], "std_msgs/msg/Float64MultiArray"),
    (JOINTS, "foxglove.JointStates"),
    ([0.0, 180.0, 0.1, 5.0, [1.0, 2.0], 0], "foxglove.LaserScan"),
    (["[/log/a/b/1]", "(level INFO) (message hi)"], "foxglove.Log"),
    (["some", "words", 5], "yarp/bottle"),
    ("word", "yarp/bottle"),
]


@pytest.mark.parametrize(
    "envelope", ["3 1.5", "", "free text", "5 1700000000.12345600128173828125"]
)
def test_every_kind_comes_back(tmp_path: Path, envelope: str) -> None:
    path = tmp_path / "all.mcap"
    payloads = [payload_of(value) for value, _ in ROWS]
    with McapWriter(path) as writer:
        for n, payload in enumerate(payloads):
            writer.add(f"/{n}", envelope, START + n, payload)
    storage = McapStorage(path)
    found = [*storage.messages()]
    assert [one.payload for one in found] == payloads
    assert {one.envelope for one in found} == {envelope}
    assert storage.damages == []
    assert [facts.kinds for facts in storage.ports.values()] == [[kind_of(one)] for one in payloads]
    assert all(facts.playable for facts in storage.ports.values())
    storage.close()
    with open(path, "rb") as file:
        reader = mcap.reader.make_reader(file, validate_crcs=True)
        names = {channel.topic: schema.name for schema, channel, _ in reader.iter_messages()}
    assert names == {f"/{n}": name for n, (_, name) in enumerate(ROWS)}


def test_plain(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "plain.mcap", plain=True) as writer:
        writer.add("/a", "", START, payload_of([1, 2]))
    with open(tmp_path / "plain.mcap", "rb") as file:
        ((_, channel, message),) = mcap.reader.make_reader(file).iter_messages()
    assert (channel.message_encoding, message.data) == ("yarp", payload_of([1, 2]))


def test_a_time_that_nobody_has_room_for() -> None:
    assert Converter().converted("/a", "yarp/bottle", payload_of([1]), 1 << 63) is None
