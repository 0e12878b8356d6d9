"""Bags that are cut off, changed, or lie: each is a DecodeError or a damage that names the byte."""

import random
import struct
from pathlib import Path
from typing import Any

import pytest
from kits.record.bag.test_foreign import drive

from yarpy import record
from yarpy.errors import DecodeError
from yarpy.kits.record.bag.bounded import BoundedFile
from yarpy.kits.record.bag.foreign import with_foreign

pytest.importorskip("rosbags", reason="bags need rosbags: pip install 'yarpy[ros]'")

TRIES = 60


def packed(path: Path, compression: str) -> Path:
    """A bag of ROS 1 with texts, packed."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    string = store.types["std_msgs/msg/String"]
    writer = Writer(path)
    if compression:
        writer.set_compression(Writer.CompressionFormat[compression])
    with writer:
        one = writer.add_connection("/chat", "std_msgs/msg/String", typestore=store)
        for n in range(20):
            text = store.serialize_ros1(string(data=f"word {n}" * 10), one.msgtype)
            writer.write(one, (n + 1) * 10**9, bytes(text))
    return path


def tried(path: Path) -> str:
    """What is told of a bag when all of it is read."""
    try:
        with record.open(path) as bag:
            found = with_foreign(bag)
            for _ in found:
                pass
            return " ".join(found.damages)
    except DecodeError as error:
        return str(error)


def changed(data: bytes, chance: random.Random) -> bytes:
    """The bytes with something wrong: cut off, a bit the other way round, a length that lies."""
    at = chance.randrange(len(data))
    which = chance.randrange(3)
    if which == 0:
        return data[:at]
    if which == 1:
        return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]
    lie = struct.pack("<I", chance.choice([0, 1, 0x7FFFFFFF, 0xFFFFFFFF]))
    return data[:at] + lie + data[at + 4 :]


@pytest.mark.parametrize("compression", ["", "BZ2", "LZ4"])
def test_whatever_is_wrong_with_a_bag_of_ros_1(tmp_path: Path, compression: str) -> None:
    whole = packed(tmp_path / "x.bag", compression).read_bytes()
    assert tried(tmp_path / "x.bag") == ""
    chance, said = random.Random(7), []
    for _ in range(TRIES):
        (tmp_path / "y.bag").write_bytes(changed(whole, chance))
        said.append(tried(tmp_path / "y.bag"))
    assert any("byte " in one for one in said)
    assert all("y.bag: byte " in one for one in said if one), said


def test_whatever_is_wrong_with_a_bag_of_ros_2(tmp_path: Path) -> None:
    folder = drive(tmp_path / "x", 2)
    (file,) = [one for one in folder.iterdir() if one.suffix != ".yaml"]
    whole, chance = file.read_bytes(), random.Random(7)
    for _ in range(TRIES):
        file.write_bytes(changed(whole, chance))
        tried(folder)
    file.write_bytes(whole)
    text = (folder / "metadata.yaml").read_bytes()
    for _ in range(TRIES):
        (folder / "metadata.yaml").write_bytes(changed(text, chance))
        tried(folder)


def test_a_bag_that_claims_more_than_it_has(tmp_path: Path) -> None:
    (tmp_path / "x.bag").write_bytes(b"#ROSBAG V2.0\n" + struct.pack("<I", 0xFFFFFFFF))
    assert "x.bag: byte 17: " in tried(tmp_path / "x.bag")


def test_an_index_that_leads_to_the_same_place(tmp_path: Path) -> None:
    (tmp_path / "x.bag").write_bytes(bytes(1000))
    file = BoundedFile(tmp_path / "x.bag")
    found: Any = None
    with pytest.raises(DecodeError, match="the same place over and over"):
        for _ in range(3000):
            file.seek(0)
            found = file.read(1 << 40)
    assert len(found) == 1000 and file.place == 0 and str(file) == str(tmp_path / "x.bag")
    assert file.exists() and file.open("rb") is file and file.tell() == 1000
    file.close()
