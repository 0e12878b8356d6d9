"""Bags of ROS 2 that unpack to more than there is room for, and databases that compute."""

import sqlite3
from pathlib import Path
from typing import Any

import pytest
from kits.record.bag.test_reader import made, read

from yarpy import record
from yarpy.errors import DecodeError
from yarpy.kits.record.bag import bounded_folder
from yarpy.kits.record.bag.reader import BagStorage

rosbags = pytest.importorskip("rosbags", reason="bags need rosbags: pip install 'yarpy[ros]'")

FEW = 5000


def packed(path: Path, how: str, storage: str = "sqlite3") -> Path:
    """A bag with a text of 10 000 letters that is packed."""
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
    writer = Writer(path, version=8, storage_plugin=plugin)
    writer.set_compression(getattr(CompressionMode, how), CompressionFormat.ZSTD)
    with writer:
        chat = writer.add_connection("/chat", "std_msgs/msg/String", typestore=store)
        string = store.types["std_msgs/msg/String"]
        writer.write(
            chat, 10**18, bytes(store.serialize_cdr(string(data="x" * 10_000), chat.msgtype))
        )
    return path


def messages(path: Path) -> tuple[list[bytes], list[str]]:
    bag = BagStorage(path)
    try:
        return [bytes(one.data) for one in bag.others()], [str(one) for one in bag.damages]
    finally:
        bag.close()


@pytest.mark.parametrize(
    ("how", "storage"), [("MESSAGE", "sqlite3"), ("FILE", "sqlite3"), ("STORAGE", "mcap")]
)
def test_what_is_packed_unpacks_to_a_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str, storage: str
) -> None:
    path = packed(tmp_path / "x", how, storage)
    (text,), damages = messages(path)
    assert len(text) > 10_000 and damages == []
    assert text == read(path)[0][3]
    if how == "FILE":
        monkeypatch.setattr(bounded_folder.shutil, "disk_usage", lambda where: Disk())
        with pytest.raises(DecodeError, match="more than half of what is free"):
            BagStorage(path)
        return
    monkeypatch.setattr(bounded_folder, "RECORDED_CHUNK", FEW)
    found, damages = messages(path)
    assert found == [] and f"has more than {FEW} bytes" in damages[0]


class Disk:
    free = 2 * FEW


def changed(path: Path, *words: str) -> Path:
    """The database of a bag after some commands."""
    made(path, 2)
    (file,) = path.glob("*.db3")
    with sqlite3.connect(file) as database:
        for word in words:
            database.execute(word)
    database.close()
    return path


def test_a_message_that_is_computed(tmp_path: Path) -> None:
    path = changed(
        tmp_path / "x",
        "ALTER TABLE messages RENAME TO old",
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER,"
        " data BLOB AS (zeroblob(900000000)))",
        "INSERT INTO messages SELECT id, topic_id, timestamp FROM old",
    )
    found, damages = messages(path)
    assert found == [] and "too big" in damages[0]


def test_a_table_that_never_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded_folder, "STEPS", 1_000_000)
    path = changed(
        tmp_path / "x",
        "DROP TABLE schema",
        "CREATE VIEW schema AS WITH RECURSIVE n(schema_version) AS"
        " (SELECT 1 UNION ALL SELECT schema_version + 1 FROM n)"
        " SELECT max(schema_version) AS schema_version FROM n",
    )
    with pytest.raises(DecodeError, match=r"(?i)interrupt"):
        BagStorage(path)


def test_metadata_beyond_its_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made(tmp_path / "x", 2)
    monkeypatch.setattr(bounded_folder, "ROS_BAG_METADATA", 100)
    with pytest.raises(DecodeError, match="100 at most are read"):
        record.open(tmp_path / "x")


def test_the_library_of_others_stays_as_it_is(tmp_path: Path) -> None:
    made(tmp_path / "x", 2)
    BagStorage(tmp_path / "x").close()
    library: Any = __import__("rosbags.rosbag2.reader", fromlist=["zstd"])
    assert library.zstd is not bounded_folder._library().zstd
    plugins = library.DirectoryReader.STORAGE_PLUGINS
    assert plugins["mcap"] is library.McapReader
    assert plugins != bounded_folder._library().DirectoryReader.STORAGE_PLUGINS
