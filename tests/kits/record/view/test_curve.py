"""Curves: how few points, which ones, and all as CSV."""

from pathlib import Path

import pytest
from support.recordings import START, STEP, payload_of

import yarpy
from yarpy import record
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.view import curve
from yarpy.kits.record.view.curve import as_csv, curves


@pytest.fixture
def recording(tmp_path: Path):
    """1000 messages of /a: n, and 7 but for one peak; some words of /b; a clock of /c."""
    with McapWriter(tmp_path / "x.mcap") as writer:
        for n in range(1000):
            values = yarpy.Vector([n, 7 + 100 * (n == 123)])
            writer.add("/a", f"{n} {n}.5", START + n * STEP, payload_of(values))
        writer.add("/b", "", START + 1, payload_of(["it, fell"]))
        writer.add("/c", "", START + 2, payload_of([5, START / 1e9 + 3]))
    with record.open(tmp_path / "x.mcap") as found:
        yield found


def test_all_points(recording) -> None:
    found = curves(recording, "/a", START, START + 10 * STEP, START + 20 * STEP, 100)
    assert found["times"] == [pytest.approx(n / 100) for n in range(10, 20)]
    assert found["columns"][0] == [*range(10, 20)] and (found["every"], found["of"]) == (1, 10)


def test_a_peak_is_kept(recording) -> None:
    found = curves(recording, "/a", START, START, START + 1000 * STEP, 50)
    assert len(found["times"]) == 50 and max(found["columns"][1]) == 107
    assert found["columns"][0][:2] == [0, 39] and found["times"] == sorted(found["times"])


def test_not_everything_is_decoded(recording, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(curve, "DECODED", 100)
    found = curves(recording, "/a", START, START, START + 1000 * STEP, 4000)
    assert found["every"] == 16 and found["of"] == 1000
    assert found["columns"][0] == [*range(0, 1000, 16)]


def test_no_curve(recording) -> None:
    found = curves(recording, "/b", START, START, START + STEP, 100)
    assert found["columns"] == [] and found["of"] == 1
    assert curves(recording, "/none", START, START, START + STEP, 100)["times"] == []
    assert curves(recording, "/c", START, START, START + STEP, 100)["columns"] == [[5], [None]]


def test_csv(recording) -> None:
    lines = b"".join(as_csv(recording, "/a", START, START + 2 * STEP)).decode().splitlines()
    assert lines[0] == "received,sent,values"
    assert lines[2] == "1795000000.010000000,1.500000000,1.0,7.0" and len(lines) == 3
    (_, line) = as_csv(recording, "/b", START, START + STEP)
    assert line == b'1795000000.000000001,1795000000.000000001,"""it, fell"""\n'


def test_memory_is_that_of_a_curve() -> None:
    """Not that of all that was read: of long messages only the numbers are kept that are drawn, and
    of short ones not the megabytes that were read together with them."""
    chunk = bytes(payload_of([5])) + bytes(1 << 20)
    short = Recorded("/a", 1, 1, "", memoryview(chunk)[: len(payload_of([5]))])
    kept = curve._kept(short)
    assert isinstance(kept, Recorded) and kept.value == [5] and type(kept.payload) is bytes
    long = Recorded("/a", 1, 1, "", payload_of(yarpy.Vector(range(20_000))))
    assert curve._kept(long) == [*range(64)]
