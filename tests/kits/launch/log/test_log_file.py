"""Files that keep a log."""

import json
from pathlib import Path

import pytest

import yarpy
from yarpy import record
from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.log.log_file import open_log_file
from yarpy.port.keep.log_line import LogLine, read_message
from yarpy.wire.message import Message

VALUE = yarpy.Bottle(["[/log/vm/arm/7]", '(level INFO) (systemtime 1795219554.5) (message "a b")'])


def kept(path: Path) -> LogLine:
    message = Message("D", VALUE.to_bytes())
    line = read_message(message)
    assert line is not None
    file = open_log_file(path)
    file.add(line, message)
    file.flush()
    before = path.stat().st_size
    file.close()
    assert before
    with pytest.raises(FileExistsError):
        open_log_file(path)
    return line


@pytest.mark.parametrize("name", ["x.log", "x.txt"])
def test_text(tmp_path: Path, name: str) -> None:
    kept(tmp_path / name)
    [text] = (tmp_path / name).read_text().splitlines()
    assert text.startswith("2026-11-2") and text.endswith(" vm/arm/7 [INFO] a b")


@pytest.mark.parametrize("name", ["x.json", "x.jsonl"])
def test_json(tmp_path: Path, name: str) -> None:
    kept(tmp_path / name)
    told = json.loads((tmp_path / name).read_text())
    assert told["message"] == "a b" and told["time"] == 1795219554.5


def test_mcap(tmp_path: Path) -> None:
    line = kept(tmp_path / "x.mcap")
    with record.open(tmp_path / "x.mcap") as recording:
        [found] = [*recording]
        assert found.port == line.origin and found.value == VALUE


def test_an_ending_that_nobody_knows(tmp_path: Path) -> None:
    with pytest.raises(LocalProtocolError, match=r"end it with \.log"):
        open_log_file(tmp_path / "x.xls")
