"""The newest messages at even distances in time."""

from pathlib import Path

import pytest
from support.recordings import START, payload_of

from yarpy import record
from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.kits.record.lerobot.frames import count, frames, stretch
from yarpy.kits.record.mcap.writer import McapWriter

MS = 1_000_000


def written(path: Path, **ports: list[int]) -> Path:
    """Messages of ports at these milliseconds, which are what they say, too."""
    with McapWriter(path) as writer:
        for time, port in sorted((time, port) for port, times in ports.items() for time in times):
            writer.add(f"/{port}", "", START + time * MS, payload_of([time]))
    return path


def test_the_newest_of_each(tmp_path: Path) -> None:
    path = written(tmp_path / "x.mcap", a=[0, 100, 200, 300, 400], b=[50, 160, 350], c=[1, 999])
    with record.open(path) as recording:
        begin, end = stretch(recording, ["/a", "/b"])
        assert (begin, end) == (START + 50 * MS, START + 350 * MS)
        assert count(begin, end, 10) == 4
        found = frames(recording, ["/a", "/b"], 10, begin, end)
        assert [(one["/a"].value[0], one["/b"].value[0]) for one in found] == [
            (0, 50),
            (100, 50),
            (200, 160),
            (300, 350),
        ]


def test_one_message_is_one_frame(tmp_path: Path) -> None:
    with record.open(written(tmp_path / "x.mcap", a=[7])) as recording:
        begin, end = stretch(recording, ["/a"])
        assert [one["/a"].value for one in frames(recording, ["/a"], 30, begin, end)] == [[7]]


def test_no_episode(tmp_path: Path) -> None:
    path = written(tmp_path / "x.mcap", a=[0, 10], b=[20, 30])
    with record.open(path) as recording:
        with pytest.raises(LocalProtocolError, match='"/b" begins when "/a" is over'):
            stretch(recording, ["/a", "/b"])
        with pytest.raises(UnknownName):
            stretch(recording, ["/none"])
