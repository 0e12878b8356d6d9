"""Bags of ROS 1 and 2, made by the library, become files of MCAP and bags again, to the byte."""

from pathlib import Path
from typing import Any

import pytest
from support.recordings import START

from yarpy import record
from yarpy.errors import DecodeError, MissingFile
from yarpy.kits.record.bag.reader import BagStorage, is_bag
from yarpy.kits.record.convert import convert

rosbags = pytest.importorskip("rosbags", reason="bags need rosbags: pip install 'yarpy[ros]'")

Row = tuple[str, str, int, bytes]


def made(path: Path, version: int) -> list[Row]:
    """A bag with two topics and a type that nobody knows; what is in it."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import Writer as Writer2
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if version == 1 else Stores.ROS2_HUMBLE)
    string = store.types["std_msgs/msg/String"]
    spell: Any = store.serialize_ros1 if version == 1 else store.serialize_cdr
    writer: Any = Writer1(path) if version == 1 else Writer2(path, version=8)
    rows = []
    with writer:
        chat = writer.add_connection("/chat", "std_msgs/msg/String", typestore=store)
        own: dict[str, Any] = {"msgdef": "int32 x\n"}
        if version == 1:
            own.update(md5sum="a" * 32, callerid="/node", latching=1)
        else:
            own.update(rihs01="RIHS01_" + "b" * 64)
        odd = writer.add_connection("/odd", "my_msgs/msg/Own", **own)
        for n in range(6):
            one = odd if n % 3 == 2 else chat
            data = bytes([n] * 5) if one is odd else bytes(spell(string(data=f"{n}"), chat.msgtype))
            writer.write(one, START + n * 10**9, data)
            rows.append((one.topic, one.msgtype, START + n * 10**9, data))
    return rows


def read(path: Path) -> list[Row]:
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2

    reader: Any = Reader2(path) if path.is_dir() else Reader1(path)
    with reader:
        return [
            (one.topic, one.msgtype, time, bytes(data)) for one, time, data in reader.messages()
        ]


def connections(path: Path) -> list[tuple[Any, ...]]:
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2

    reader: Any = Reader2(path) if path.is_dir() else Reader1(path)
    with reader:
        return sorted(
            (one.topic, one.msgtype, one.msgdef, one.digest, one.ext) for one in reader.connections
        )


@pytest.mark.parametrize("version", [1, 2])
def test_a_bag_a_file_and_a_bag(tmp_path: Path, version: int) -> None:
    bag = tmp_path / ("x.bag" if version == 1 else "x")
    rows = made(bag, version)
    with record.open(bag) as found:
        assert {name: facts.messages for name, facts in found.ports.items()} == {
            "/chat": 4, "/odd": 2,
        }  # fmt: skip
        assert not any(facts.playable for facts in found.ports.values())
        assert convert(found, tmp_path / "file").messages == 6
    with record.open(tmp_path / "file.mcap") as found:
        name = "my_msgs/Own" if version == 1 else "my_msgs/msg/Own"
        assert found.ports["/odd"].kinds == [name]
        form = "bag1" if version == 1 else "bag2"
        assert convert(found, tmp_path / "again", form=form).messages == 6
    again = tmp_path / ("again.bag" if version == 1 else "again")
    assert read(again) == rows
    assert connections(again) == connections(bag)


def test_a_part_of_it(tmp_path: Path) -> None:
    rows = made(tmp_path / "x.bag", 1)
    storage = BagStorage(tmp_path / "x.bag")
    found = [*storage.others({"/odd"}, START, START + 5 * 10**9)]
    assert [bytes(one.data) for one in found] == [rows[2][3]]
    assert (storage.begin, storage.end) == (START, START + 5 * 10**9)
    assert [*storage.messages()] == [] and storage.notes() == [] and storage.size > 100
    storage.close()


@pytest.mark.parametrize("keep", [0, 20, 4096, 5000])
def test_a_bag_that_is_cut_off(tmp_path: Path, keep: int) -> None:
    made(tmp_path / "x.bag", 1)
    data = (tmp_path / "x.bag").read_bytes()
    (tmp_path / "y.bag").write_bytes(data[:keep])
    with pytest.raises(DecodeError):
        BagStorage(tmp_path / "y.bag")


def test_what_is_no_bag(tmp_path: Path) -> None:
    assert not is_bag(tmp_path) and is_bag(Path("x.bag"))
    with pytest.raises(MissingFile):
        BagStorage(tmp_path / "none.bag")
