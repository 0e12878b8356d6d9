"""Names of the numbers of a message."""

import pytest
from support.recordings import START, payload_of

from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.view.labels import labels_of
from yarpy.kits.record.view.spelling import NUMBERS, numbers_of


def labels(value: object, count: int = NUMBERS) -> list[str]:
    return labels_of(Recorded("/a", START, 0, "", payload_of(value)), count)


def test_joint_states_of_ros() -> None:
    value = [[[1, 2], "frame"], ["hip", "knee"], [1.0, 2.0], [3.0, 4.0], []]
    found = labels(value)
    assert found == ["", "", "hip position", "knee position", "hip velocity", "knee velocity"]
    assert len(found) == len(numbers_of(Recorded("/a", START, 0, "", payload_of(value))))
    assert labels(value, 3) == ["", "", "hip position"]


def test_the_state_of_a_control_board() -> None:
    quantities = [[0.5 * n, 1.0] for n in range(9)] + [[1, 2], [3, 4]]
    value = [part for numbers in quantities for part in (numbers, 1)]
    found = labels(value)
    assert len(found) == 33
    assert found[:3] == ["joint 0 position", "joint 1 position", "position is valid"]
    assert found[18:20] == ["joint 0 torque", "joint 1 torque"]
    assert found[-1] == "interaction mode is valid"


def test_names_before_numbers_of_any_message() -> None:
    assert labels([["x", "y"], [1, 2], [3, 4], 5]) == ["x 1", "y 1", "x 2", "y 2", ""]
    assert labels([["x" * 1000], [1]]) == ["x" * 60 + " 1"]


@pytest.mark.parametrize(
    "value", [[1.0, 2.0], "word", [[1, 2], [3]], [["x", "y"], [1, 2, 3]], [["x"], "y"], 3, []]
)
def test_numbers_without_names(value: object) -> None:
    assert labels(value) == []


def test_what_cannot_be_read() -> None:
    assert labels_of(Recorded("/a", START, 0, "", b"\0\1"), 3) == []
