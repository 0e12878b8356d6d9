"""Recordings as columns, and as the tables of other libraries."""

from pathlib import Path

import numpy as np
import pytest
from support.recordings import START, STEP, fill, payload_of

import yarpy
from yarpy import record
from yarpy.errors import UnknownName
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.table import columns, frame, table


@pytest.fixture
def recording(tmp_path: Path):
    with McapWriter(tmp_path / "x.mcap") as writer:
        fill(writer, 6, ("/n",))
        for n in range(3):
            writer.add("/vec", "", START + n * STEP, payload_of(yarpy.Vector([n, -n])))
            writer.add("/mixed", "", START + n * STEP, payload_of(["a", n] if n else [1, 2]))
    with record.open(tmp_path / "x.mcap") as found:
        yield found


def test_numbers(recording: record.Recording) -> None:
    found = columns(recording, "/n")
    assert found["v0"].tolist() == [0, 1, 2, 3, 4, 5]
    assert found["count"].tolist() == [0, 1, 2, 3, 4, 5]
    assert found["received"][1] == np.datetime64(START + STEP, "ns")
    assert found["sent"][1] == np.datetime64(1_500_000_000, "ns")
    vectors = columns(recording, "/vec")
    assert vectors["v1"].tolist() == [0, -1, -2] and vectors["count"].tolist() == [-1] * 3


def test_what_is_no_numbers(recording: record.Recording) -> None:
    found = columns(recording, "/mixed")
    assert [[*one] for one in found["value"]] == [[1, 2], ["a", 1], ["a", 2]]
    with pytest.raises(UnknownName):
        columns(recording, "/none")


def test_pandas(recording: record.Recording) -> None:
    pytest.importorskip("pandas", reason="DataFrames need pandas: pip install 'yarpy[table]'")
    found = frame(recording, "/vec")
    assert found["v0"].tolist() == [0, 1, 2] and found.index.name == "sent"
    assert [*found.columns] == ["received", "count", "v0", "v1"]


def test_arrow(recording: record.Recording) -> None:
    pytest.importorskip("pyarrow", reason="Tables need pyarrow: pip install 'yarpy[table]'")
    found = table(recording, "/vec")
    assert found.column("v1").to_pylist() == [0, -1, -2]
    assert table(recording, "/mixed").column("value").to_pylist()[1] == "a 1"
