"""Several files at once, and none."""

from pathlib import Path

import pytest
from support.recordings import START, fill, payload_of

from yarpy import record
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.dumper.writer import DumperWriter
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.sink import NullSink, Tee, named


def test_both(tmp_path: Path) -> None:
    sink = Tee(McapWriter(tmp_path / "x.mcap"), DumperWriter(tmp_path / "x"))
    fill(sink)  # type: ignore[arg-type]
    assert sink.pending > 0
    sink.note({"what": "mark"}, START)
    sink.add_metadata("yarpy", {"host": "lab"})
    sink.flush()
    sink.sync()
    assert sink.size == (tmp_path / "x.mcap").stat().st_size + sink._folder.size
    sink.close()
    with record.open(tmp_path / "x.mcap") as one, record.open(tmp_path / "x") as other:
        assert [found.value for found in one] == [found.value for found in other]
        assert len(one.notes()) == 1


@pytest.mark.parametrize("path", ["", ".", "..", "a/..", "/"])
def test_a_path_without_a_name(path: str) -> None:
    with pytest.raises(LocalProtocolError, match="no name of a recording"):
        named(path)


def test_nowhere() -> None:
    sink = NullSink()
    sink.add("/a", "", START, payload_of([1]))
    sink.note({}, START)
    sink.add_metadata("yarpy", {})
    sink.flush()
    sink.sync()
    sink.close()
    assert (sink.size, sink.pending) == (0, 0)
