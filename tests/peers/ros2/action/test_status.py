"""What becomes of goals, and where actions are spoken of."""

from yarpy.peers import ros2
from yarpy.peers.ros2.action.status import (
    Refusal,
    Status,
    id_of,
    nanoseconds_of,
    new_id,
    place,
    stamp_of,
    uuid_of,
)


def test_numbers_are_those_of_ros() -> None:
    theirs = ros2.load("action_msgs/msg/GoalStatus")
    for status in Status:
        assert getattr(theirs, f"STATUS_{status.name}") == status
    assert [status for status in Status if status.is_over] == [4, 5, 6]
    answer = ros2.load("action_msgs/srv/CancelGoal").Response
    assert [answer.ERROR_NONE, answer.ERROR_REJECTED] == [Refusal.NONE, Refusal.REJECTED]
    assert answer.ERROR_UNKNOWN_GOAL_ID == Refusal.UNKNOWN_GOAL
    assert answer.ERROR_GOAL_TERMINATED == Refusal.TERMINATED


def test_names_and_numbers() -> None:
    assert place("/fib", "send_goal") == "/fib/_action/send_goal"
    one = new_id()
    assert len(one) == 16 and one != new_id() and one[6] >> 4 == 4
    kind = ros2.load("action_msgs/msg/GoalInfo")
    info = kind.from_bottle({"goal_id": uuid_of(one), "stamp": stamp_of(5_000_000_007)})
    assert id_of(info.goal_id) == one
    assert nanoseconds_of(info.stamp) == 5_000_000_007
