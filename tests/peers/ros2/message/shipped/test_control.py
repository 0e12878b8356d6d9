"""Types of controllers and of the turtle, by the hashes that ROS 2 has for them."""

from support.type_hashes import JAZZY, hashes_of, names_of, others

from yarpy.peers import ros2
from yarpy.peers.ros2.message.library import Action
from yarpy.peers.ros2.message.shipped import control

PUBLISHED = hashes_of("control_msgs", "turtlesim")
# Younger than what was published of these packages.
YOUNGER = {
    *(
        f"control_msgs/msg/{name}"
        for name in ("BatteryStateArray", "Float64Values", "Keys", "VDA5050SafetyState")
    ),
    "control_msgs/srv/SetOdometry",
}


def test_hashes_are_those_of_ros() -> None:
    assert names_of(control) - PUBLISHED.keys() == YOUNGER
    assert others(PUBLISHED) == []
    for name in YOUNGER:
        JAZZY.load(name)


def test_a_trajectory_and_a_turtle() -> None:
    follow = ros2.load("control_msgs/action/FollowJointTrajectory")
    assert isinstance(follow, Action)
    goal = follow.Goal()
    goal.trajectory.joint_names = ["elbow"]  # type: ignore[attr-defined]
    again = follow.Goal.from_ros(b"".join(goal.to_ros()))
    assert again.trajectory.joint_names == ["elbow"]  # type: ignore[attr-defined]
    assert follow.Result.PATH_TOLERANCE_VIOLATED == -4  # type: ignore[attr-defined]
    pose = ros2.load("turtlesim/msg/Pose")
    assert [*pose().to_dict()][:3] == ["x", "y", "theta"]  # type: ignore[operator,union-attr]
    motion = ros2.load("control_msgs/msg/MotionPrimitive")
    assert motion().type == -1  # type: ignore[operator,union-attr]
