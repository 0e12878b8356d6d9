"""Two recordings on one time line: names, times, and what a page is told and sent."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from urllib.request import urlopen

import pytest
from support.foxglove_client import Client
from support.recordings import START, payload_of
from support.wait import HANG, wait_until

from yarpy import record
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.view.beside import FARTHEST, LABELS, BesideSource, MovedStorage, own_names
from yarpy.kits.record.view.server import View
from yarpy.kits.record.view.source import FileSource

SECOND = 1_000_000_000
LATER = 1000 * SECOND  # when the second one was recorded


def written(path: Path, start: int, count: int, base: int, *more: str) -> Path:
    """A message a second from /a, of /only and others the first alone; a mark, a file."""
    with McapWriter(path) as writer:
        for n in range(count):
            writer.add("/a", f"{n} {n}.5", start + n * SECOND, payload_of([base + n]))
        for port in more:
            writer.add(port, "", start, payload_of([1]))
        writer.note({"what": "mark", "text": path.stem}, start + SECOND)
        writer.note({"what": "lost", "port": "/a"}, start + SECOND)
        writer.attach("walk.xml", path.stem.encode(), "application/xml")
    return path


@pytest.fixture
def both(tmp_path: Path) -> Iterator[BesideSource]:
    """10 s and, beginning together, 4 s."""
    first = FileSource([written(tmp_path / "one.mcap", START, 10, 0, "/only")])
    second = FileSource([written(tmp_path / "two.mcap", START + LATER, 4, 100, "/other")])
    with BesideSource(first, second) as source:
        wait_until(lambda: source.told()["seen"] == 1)
        yield source


def values(source: BesideSource, offset: float, **limits: int) -> list[tuple[str, int, float]]:
    """Port, value, and seconds from the beginning."""
    moved = source.at(offset)
    with moved.open() as recording:
        ports = [name for name in moved.kinds if name.endswith("/a")]
        return [
            (one.port, one.value[0], (one.received_ns - START) / SECOND)
            for one in recording.between(ports, **limits)
        ]


def test_they_begin_together(both: BesideSource) -> None:
    assert [*both.kinds] == ["/A/a", "/B/a", "/A/only", "/B/other"]
    assert (both.begin, both.end) == (START, START + 9 * SECOND)
    found = values(both, 0.0)
    assert sorted(found[:4]) == [("/A/a", 0, 0), ("/A/a", 1, 1), ("/B/a", 100, 0), ("/B/a", 101, 1)]
    assert len(found) == 14 and [at for _, _, at in found] == sorted(at for _, _, at in found)


def test_an_offset(both: BesideSource) -> None:
    assert values(both, 2.5)[3:5] == [("/B/a", 100, 2.5), ("/A/a", 3, 3)]
    assert values(both, -0.5)[0] == ("/B/a", 100, -0.5)
    part = {"begin": START + 3 * SECOND, "end": START + 5 * SECOND}
    assert values(both, 2.5, **part) == [
        ("/A/a", 3, 3),
        ("/B/a", 101, 3.5),
        ("/A/a", 4, 4),
        ("/B/a", 102, 4.5),
    ]
    moved = both.at(20.0)
    assert (moved.begin, moved.end) == (START, START + 23 * SECOND)
    with moved.open() as recording:
        found = moved.before(recording, ["/A/a", "/B/a"], START + 30 * SECOND)
        assert {one.port: one.value for one in found} == {"/A/a": [9], "/B/a": [103]}
        assert moved.before(recording, ["/B/a"], START + 19 * SECOND) == []
    for wrong in (float("nan"), float("inf"), 2 * FARTHEST):
        with pytest.raises(ValueError, match="an offset of"):
            both.at(wrong)


def test_what_a_page_is_told(both: BesideSource) -> None:
    told = both.at(2.0).told()
    rows = {row["name"]: row for row in told["ports"]}
    assert (rows["/A/a"]["from"], rows["/A/a"]["length"]) == (0, 9)
    assert (rows["/B/a"]["from"], rows["/B/a"]["length"]) == (2, 3)
    assert told["begin"] == str(START) and told["length"] == 9 and told["problem"] == ""
    notes = [(note["what"], note["text"], note["t"]) for note in told["notes"]]
    assert notes == [
        ("mark", "one", 1),
        ("lost", "/A/a", 1),
        ("mark", "two", 3),
        ("lost", "/B/a", 3),
    ]
    assert told["beside"] == {"offset": 2.0, "recorded": 1000.0}
    assert told["title"] == "one.mcap beside two.mcap"
    assert [file["name"] for file in told["attached"]] == ["/A/walk.xml", "/B/walk.xml"]
    assert both.attachment("/B/walk.xml") == b"two"
    with pytest.raises(KeyError):
        both.attachment("walk.xml")


def test_a_time_that_began_with_zero(tmp_path: Path) -> None:
    """As recordings of a simulation do: nothing is before 1970."""
    first = FileSource([written(tmp_path / "one.mcap", 0, 3, 0)])
    second = FileSource([written(tmp_path / "two.mcap", 0, 3, 100)])
    with BesideSource(first, second, -2.0) as source:
        assert (source.begin, source.end) == (0, 4 * SECOND)
        with source.open() as recording:
            assert min(one.received_ns for one in recording) == 0


def test_a_file_that_is_moved(tmp_path: Path) -> None:
    path = written(tmp_path / "one.mcap", START, 3, 0)
    with record.open(path) as recording:
        moved = MovedStorage(recording.storages[0], LABELS[1], 5)
        assert (moved.begin, moved.end) == (START + 5, START + 2 * SECOND + 5)
        assert moved.size == path.stat().st_size and moved.complete and not moved.damages
        assert moved.facts == recording.storages[0].facts
        assert moved.ports["/B/a"].messages == 3 and moved.ports["/B/a"].name == "/B/a"
        assert [one.received_ns for one in moved.messages(["/B/a"], START + 6)] == [
            START + SECOND + 5,
            START + 2 * SECOND + 5,
        ]
        assert [*moved.messages(["/A/a", "/a"])] == []
        assert [note["time_ns"] for note in moved.notes()] == [START + SECOND + 5] * 2
        assert moved.notes()[1]["port"] == "/B/a"
    assert own_names(["/A/a", "/B/a", "/AB/a"], "/A") == ["/a"]


def test_the_server_has_an_offset_for_each_question(both: BesideSource, tmp_path: Path) -> None:
    with View(both, port=0) as view:

        def get(question: str) -> bytes:
            with urlopen(view.url + question, timeout=HANG) as answer:
                body: bytes = answer.read()
            return body

        assert json.loads(get("timeline?offset=2"))["ports"][1]["from"] == 2
        assert json.loads(get("timeline"))["ports"][1]["from"] == 0
        found = json.loads(get("curve?port=/B/a&offset=2&begin=2.5&end=3.5"))
        assert found["columns"] == [[101]] and found["times"] == pytest.approx([3])
        assert len(get("data.csv?port=/B/a&offset=2").splitlines()) == 5
        assert get("look_beside.js").startswith(b"//")
        (tmp_path / "cut.mcap").write_bytes(get("cut.mcap?offset=2&begin=1.5&end=3.5"))
        with record.open(tmp_path / "cut.mcap") as recording:
            cut = [(one.port, one.value[0]) for one in recording.messages(["/A/a", "/B/a"])]
        assert sorted(cut) == [("/A/a", 2), ("/A/a", 3), ("/B/a", 100), ("/B/a", 101)]
        with Client(view.url) as client:
            assert client.until("serverInfo")["dataEndTime"]["sec"] == START // SECOND + 9
        with Client(f"{view.url}?offset=20") as client:
            assert client.until("serverInfo")["dataEndTime"]["sec"] == START // SECOND + 23
        with Client(f"{view.url}?offset=nan") as client:
            assert client.refused == 400
