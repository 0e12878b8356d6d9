"""What becomes of goals, and the types of an action."""

import pytest

from yarpy.errors import DecodeError, UnknownType
from yarpy.peers.ros.action.status import Status, made, stamp_of, status_of, types_of
from yarpy.peers.ros.message.library import default_library


def test_numbers_are_those_of_actionlib() -> None:
    theirs = default_library().message("actionlib_msgs/GoalStatus")
    for status in Status:
        assert getattr(theirs, status.name) == status_of(status) == status
    assert [int(status) for status in Status if status.is_over] == [2, 3, 4, 5, 8]
    with pytest.raises(DecodeError, match="status 17"):
        status_of(17)


def test_types() -> None:
    types = types_of("actionlib_tutorials/Fibonacci")
    assert types == types_of("actionlib_tutorials/FibonacciAction")
    assert types.Goal._type == "actionlib_tutorials/FibonacciGoal"
    assert types.ActionResult().status.status == 0
    with pytest.raises(UnknownType):
        types_of("nobody/Nothing")


def test_what_is_made_of_values() -> None:
    kind = types_of("actionlib/Test").Goal
    assert made(kind, [3]).goal == made(kind, {"goal": 3}).goal == 3
    assert made(kind, None) == kind()
    assert made(kind, kind(goal=4)).goal == 4
    with pytest.raises(TypeError, match="actionlib/TestGoal is expected"):
        made(kind, types_of("actionlib/Test").Result())
    assert stamp_of(1.5).to_sec() == 1.5
