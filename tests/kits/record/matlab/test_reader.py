"""Files of robometry. Those in `data/robometry` were written by it, in both versions of the format:
`scalar`, `joints::positions`, `joints::matrix`, `ints`, `words`, and `empty` without a sample."""

import json
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from yarpy import record
from yarpy.errors import DecodeError, MissingFile
from yarpy.kits.record.convert import convert

pytestmark = pytest.mark.skipif(
    find_spec("pymatreader") is None, reason="files of robometry take the package pymatreader"
)

THEIRS = Path(__file__).parents[3] / "data" / "robometry"


@pytest.mark.parametrize("version", ["v5", "v73"])
def test_what_robometry_wrote(version: str) -> None:
    with record.open(THEIRS / f"{version}.mat") as found:
        kinds = {name: (facts.kinds, facts.messages) for name, facts in found.ports.items()}
        assert kinds == {
            "/scalar": (["yarp/vector"], 3),
            "/joints/positions": (["yarp/vector"], 3),
            "/joints/matrix": (["yarp/matrix"], 3),
            "/ints": (["yarp/vector"], 3),
            "/words": (["yarp/bottle"], 3),
        }
        times, angles = found.numbers("/joints/positions")
        assert times.tolist() == [1000.0, 1000.25, 1000.5]
        assert angles.tolist() == [[1, 2, 3, 4], [2, 3, 4, 5], [3, 4, 5, 6]]
        second = [*found.messages(["/joints/matrix"])][1]
        # Column by column, as in C++.
        assert second.value.array.tolist() == [[2, 4, 6], [3, 5, 7]]
        assert [one.value for one in found.messages(["/words"])] == ["w0", "w1", "w2"]
        assert second.envelope == "1 1000.25"
        facts = found.storages[0].facts
        assert facts["yarp_robot_name"] == "demo"
        assert json.loads(facts["elements_names"])["/joints/positions"] == ["a", "b", "c", "d"]


def test_there_and_back(tmp_path: Path) -> None:
    """Values, times of sending and names of ports come back; what robometry says is kept."""
    with record.open(THEIRS / "v73.mat") as found:
        convert(found, tmp_path / "one.mcap", ports=["/joints/positions", "/joints/matrix"])
    with record.open(tmp_path / "one.mcap") as found:
        convert(found, tmp_path / "two", form="robometry")
    # The configuration finds what it has written.
    with record.open(tmp_path / "two.json") as again, record.open(THEIRS / "v5.mat") as first:
        for port in ("/joints/positions", "/joints/matrix"):
            assert [(one.value, one.envelope) for one in again.messages([port])] == [
                (one.value, one.envelope) for one in first.messages([port])
            ]
        facts = again.storages[0].facts
        assert json.loads(facts["units_of_measure"])["/joints/positions"] == ["rad"] * 4
        assert json.loads(facts["description_list"]) == ["head", "left_arm"]


def test_what_is_no_file_of_robometry(tmp_path: Path) -> None:
    whole = (THEIRS / "v5.mat").read_bytes()
    for n, data in enumerate([b"", b"hello" * 50, whole[:3000], whole[:130]]):
        path = tmp_path / f"{n}.mat"
        path.write_bytes(data)
        with pytest.raises(DecodeError, match=r"\.mat: "):
            record.open(path)
    with pytest.raises(MissingFile):
        record.open(tmp_path / "none.mat")
    said = tmp_path / "x.json"
    for text, error in (
        ("[", DecodeError),
        ("{}", DecodeError),
        ('{"filename": "y"}', MissingFile),
    ):
        said.write_text(text, encoding="utf-8")
        with pytest.raises(error):
            record.open(said)


def test_samples_that_are_no_samples(tmp_path: Path) -> None:
    from scipy.io import savemat

    good = {"data": np.ones((2, 1, 3)), "dimensions": [2, 1, 3], "timestamps": [1.0, 2.0, 3.0]}
    bad = {
        "times": {**good, "timestamps": [1.0, float("nan"), 3.0]},
        "few": {**good, "timestamps": [1.0, 2.0]},
        "sizes": {**good, "dimensions": [5, 1, 3]},
    }
    savemat(tmp_path / "x.mat", {"x": {"good": good, **bad}})
    with record.open(tmp_path / "x.mat") as found:
        assert [*found.ports] == ["/good"]
        assert len(found.damages) == 3
