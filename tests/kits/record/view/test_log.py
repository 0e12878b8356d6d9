"""The lines of a log until a moment of a recording."""

from pathlib import Path

from support.recordings import START, payload_of

from yarpy import record
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.view.log import LINES, lines_before


def text(n: int) -> list[str]:
    return ["[/log/lab/demo/7]", f'(level WARNING) (systemtime 12.5) (message "line {n}")']


def test_lines_until_a_moment(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        for n in range(4):
            writer.add("/log", "", START + n * SECOND, payload_of(text(n)))
        writer.add("/log", "", START + 4 * SECOND, payload_of(["no", "line"]))
        writer.add("/other", "", START, payload_of(text(9)))
    with record.open(tmp_path / "x.mcap") as found:
        lines = lines_before(found, "/log", START, START + 2 * SECOND)
        assert [(one["t"], one["text"]) for one in lines] == [
            (0.0, "line 0"), (1.0, "line 1"), (2.0, "line 2"),
        ]  # fmt: skip
        assert (lines[0]["level"], lines[0]["from"]) == ("WARNING", "/log/lab/demo/7")
        assert len(lines_before(found, "/log", START, START + 9 * SECOND)) == 4
        assert lines_before(found, "/log", START, START - 1) == []


def test_no_more_than_the_newest(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        for n in range(LINES + 10):
            writer.add("/log", "", START + n * SECOND, payload_of(text(n)))
    with record.open(tmp_path / "x.mcap") as found:
        lines = lines_before(found, "/log", START, START + (LINES + 4) * SECOND)
    assert [one["text"] for one in lines] == [f"line {n}" for n in range(5, LINES + 5)]
