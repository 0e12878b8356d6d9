"""Types of MoveIt, by the hashes that ROS 2 has for them."""

from support.type_hashes import hashes_of, names_of, others

from yarpy.peers import ros2
from yarpy.peers.ros2.message.library import Action
from yarpy.peers.ros2.message.shipped import moveit

PUBLISHED = hashes_of("moveit_msgs", "octomap_msgs", "object_recognition_msgs")


def test_hashes_are_those_of_ros() -> None:
    assert names_of(moveit) == PUBLISHED.keys()
    assert others(PUBLISHED) == []


def test_a_plan_is_asked_for() -> None:
    move = ros2.load("moveit_msgs/action/MoveGroup")
    assert isinstance(move, Action)
    goal = move.Goal()
    goal.request.group_name = "arm"  # type: ignore[attr-defined]
    again = move.Goal.from_ros(b"".join(goal.to_ros()))
    assert again.request.group_name == "arm"  # type: ignore[attr-defined]
    codes = ros2.load("moveit_msgs/msg/MoveItErrorCodes")
    assert codes.NO_IK_SOLUTION == -31  # type: ignore[union-attr]
