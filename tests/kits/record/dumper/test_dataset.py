"""The parts of a data set: names, times, numbers."""

from pathlib import Path

import pytest

from yarpy.errors import MissingFile
from yarpy.kits.record.dumper.dataset import Dataset

GOLDEN = Path(__file__).parents[3] / "golden" / "datadumper"


def part(folder: Path, lines: str, stamps: str = "rx") -> None:
    folder.mkdir(parents=True)
    (folder / "info.log").write_text(
        f"Type: Bottle;\nStamp: {stamps};\n[1.000000] /a [connected]\n"
    )
    (folder / "data.log").write_text(lines)


def test_names(tmp_path: Path) -> None:
    for folder in ("head", "arms/left", "arms/right", "legs/arms/left"):
        part(tmp_path / folder, "1 1.500000 7\n")
    data = Dataset(tmp_path)
    assert [*data.parts] == ["arms_left", "arms_right", "head", "legs_arms_left"]
    assert {name: facts.messages for name, facts in data.ports.items()} == dict.fromkeys(
        data.parts, 1
    )
    assert [*Dataset(tmp_path / "head").parts] == ["head"]
    with pytest.raises(MissingFile):
        Dataset(tmp_path / "nowhere")


def test_frames_and_times(tmp_path: Path) -> None:
    part(tmp_path / "x", "8 1.500000 7\n-1 2.500000 nonsense\nbroken\n9 3.500000 9\n")
    data = Dataset(tmp_path)
    assert (data.begin, data.end, data.complete, len(data.notes())) == (
        1_500_000_000,
        3_500_000_000,
        True,
        1,
    )
    found = [(one.envelope, one.value, one.port) for one in data.messages()]
    assert found == [("0 1.5", [7], "x"), ("1 2.5", ["nonsense"], "x"), ("2 3.5", [9], "x")]
    assert [data.frame("x", moment) for moment in (0, 1_500_000_001, 9_000_000_000)] == [0, 1, 3]
    assert data.moment("x", 2) == 3_500_000_000 and data.size > 0
    for wrong in (-1, 3):
        with pytest.raises(IndexError):
            data.moment("x", wrong)
    assert [one.value for one in data.messages(["x"], 2_000_000_000, 3_000_000_000)] == [
        ["nonsense"]
    ]
    assert [*data.messages(["y"])] == [] and data.damages


def test_the_column_of_times(tmp_path: Path) -> None:
    """A file may have two of them and not say so."""
    part(tmp_path / "x", "1 1.500000 8.500000 7\n")
    assert [(one.value, one.received) for one in Dataset(tmp_path).messages()] == [([8.5, 7], 1.5)]
    for column, time in ((1, 1.5), (2, 8.5)):
        data = Dataset(tmp_path, column)  # type: ignore[arg-type]
        assert [(one.value, one.received) for one in data.messages()] == [([7], time)]
    (first, *_) = Dataset(GOLDEN / "bottle_rxtx").messages()
    assert (first.received, first.value, first.envelope) == (100.25, [1, "ping", 3.14], "0 100.25")
