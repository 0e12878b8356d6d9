"""What a program says, read from its file."""

import os
from pathlib import Path

import pytest
from support.system import NO_RUN_SERVER

from yarpy.kits.launch.run.output import LONGEST, Output

pytestmark = pytest.mark.skipif(bool(NO_RUN_SERVER), reason=NO_RUN_SERVER)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "out"
    path.touch()
    return path


def test_lines_come_when_they_are_whole(path: Path) -> None:
    output = Output(path)
    with path.open("ab", buffering=0) as program:
        program.write(b"one\r\ntw")
        assert output.read() == ["one"]
        program.write(b"o\n\nthree \xff")
        assert output.read() == ["two", ""]
        assert output.read(whole=True) == ["three \ufffd"]
    output.close()


def test_the_next_reader_goes_on_where_the_last_one_was(path: Path) -> None:
    path.write_bytes(b"a\nb")
    first = Output(path)
    assert first.read() == ["a"]
    at = first.read_so_far
    first.close()
    with path.open("ab") as program:
        program.write(b"c\n")
    second = Output(path, at)
    assert second.read() == ["bc"]
    second.close()


def test_no_line_is_longer_than_the_longest(path: Path) -> None:
    path.write_bytes(b"x" * (3 * LONGEST + 5) + b"\n" + b"y" * (LONGEST + 1))
    output = Output(path)
    lines = output.read(whole=True)
    assert [len(line) for line in lines] == [LONGEST] * 3 + [5, LONGEST, 1]
    output.close()


def test_what_comes_too_fast_is_left_out_and_counted(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("yarpy.kits.launch.run.output.RUN_BEHIND", 100)
    path.write_bytes(b"a" * 1000 + b"\nlast\n")
    output = Output(path)
    lines = output.read()
    assert lines[-1] == "last" and output.lost == 1006 - 100
    output.close()


def test_what_was_read_takes_no_room(path: Path) -> None:
    output = Output(path)
    for _ in range(4):
        with path.open("ab") as program:
            program.write(b"x" * 1023 + b"\n" * 1 + (b"y" * 1023 + b"\n") * 2047)
        while output.read():
            pass
    held = os.stat(path).st_blocks * 512
    output.close()
    if held > 4 << 20:
        pytest.skip("this file system cannot give back part of a file")
    assert path.stat().st_size == 8 << 20 and held <= 1 << 20
