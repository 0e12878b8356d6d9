"""The ports of a file."""

import json
from pathlib import Path

import mcap.writer
from support.recordings import START, STEP, payload_of, recorded

import yarpy
from yarpy.kits.record.mcap.storage import McapStorage
from yarpy.kits.record.mcap.writer import McapWriter


def test_ports_and_messages(tmp_path: Path) -> None:
    storage = McapStorage(recorded(tmp_path / "x.mcap"))
    assert [(one.name, one.messages, one.kinds) for one in storage.ports.values()] == [
        ("/a", 5, ["yarp/bottle"]),
        ("/b", 5, ["yarp/bottle"]),
    ]
    assert (storage.begin, storage.end, storage.complete) == (START, START + 9 * STEP, True)
    found = [*storage.messages(["/b"])]
    assert [(one.port, one.envelope, one.as_(int)) for one in found[:2]] == [
        ("/b", "1 1.5", 1),
        ("/b", "3 3.5", 3),
    ]
    storage.close()


def test_a_port_whose_type_changes(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        writer.add("/a", "1 1", START, payload_of([1, "x"]))
        writer.add("/a", "", START + 1, payload_of(yarpy.Vector([1.5])))
        writer.add("/a", "free", START + 2, payload_of([2, "x"]))
    storage = McapStorage(path)
    assert [*storage.ports] == ["/a"] and storage.ports["/a"].messages == 3
    assert storage.ports["/a"].kinds == ["yarp/bottle", "yarp/vector"]
    found = [*storage.messages(["/a"])]
    assert [one.envelope for one in found] == ["1 1", "", "free"]
    assert isinstance(found[1].value, yarpy.Vector) and found[2].value == [2, "x"]
    storage.close()


def test_a_port_that_comes_late_in_an_unfinished_file(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap", "zstd") as writer:
        writer.add("/a", "", START, payload_of([1]))
        writer.flush()
        writer.add("/b", "", START + 1, payload_of([2]))
        writer.flush()
        storage = McapStorage(tmp_path / "x.mcap")
        assert [*storage.ports] == ["/a", "/b"] and not storage.complete
        assert [one.as_(int) for one in storage.messages(["/b"])] == [2]
        storage.close()


def test_notes(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        writer.note({"what": "mark", "text": "fell over"}, START)
        writer.add("/a", "", START, payload_of([1]))
    storage = McapStorage(path)
    assert storage.notes() == [{"what": "mark", "text": "fell over", "time_ns": START}]
    assert [*storage.ports] == ["/a"] and len([*storage.messages()]) == 1
    storage.close()


def test_channels_of_other_programs_are_listed_and_not_read(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with open(path, "wb") as file:
        writer = mcap.writer.Writer(file)
        writer.start()
        channel = writer.register_channel("/point", "json", 0)
        writer.add_message(channel, START, json.dumps({"x": 1}).encode(), START)
        broken = writer.register_channel("/broken", "yarp", 0, {"envelope": "text"})
        writer.add_message(broken, START, b"\xff\xff\xff\xff", START)
        writer.finish()
    storage = McapStorage(path)
    assert not storage.ports["/point"].playable and storage.ports["/point"].kinds == ["json"]
    assert [*storage.messages()] == []
    assert "a message of /broken: an envelope that is longer" in str(storage.damages[0])
    storage.close()
