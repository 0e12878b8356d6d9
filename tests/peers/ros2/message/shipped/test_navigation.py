"""Types of Nav2, by the hashes that ROS 2 has for them."""

from support.type_hashes import JAZZY, hashes_of, names_of, others

from yarpy.peers import ros2
from yarpy.peers.ros2.message.library import Action
from yarpy.peers.ros2.message.shipped import navigation

PUBLISHED = hashes_of("nav2_msgs", "geographic_msgs")
# Younger than what was published of the package.
YOUNGER = {
    f"nav2_msgs/action/FollowObject_{part}" for part in ("SendGoal", "GetResult", "FeedbackMessage")
}


def test_hashes_are_those_of_ros() -> None:
    assert names_of(navigation) - PUBLISHED.keys() == YOUNGER
    assert others(PUBLISHED) == []
    for name in YOUNGER:
        JAZZY.load(name)


def test_a_goal() -> None:
    navigate = ros2.load("nav2_msgs/action/NavigateToPose")
    assert isinstance(navigate, Action)
    goal = navigate.Goal()
    goal.pose.pose.position.x = 2.5  # type: ignore[attr-defined]
    again = navigate.Goal.from_ros(b"".join(goal.to_ros()))
    assert again.pose.pose.position.x == 2.5  # type: ignore[attr-defined]
    dock = ros2.load("nav2_msgs/action/DockRobot")
    assert dock.Goal().max_staging_time == 1000  # type: ignore[union-attr]
