"""What `yarpy.ros2` gives to programs."""

import pytest

from yarpy.errors import UnknownType
from yarpy.peers import ros2


def test_types_by_name() -> None:
    state = ros2.load("sensor_msgs/msg/JointState")(name=["elbow"], position=[0.5])
    assert type(state).from_ros(b"".join(state.to_ros())) == state
    assert ros2.load("std_srvs/srv/Trigger").Request()._type == "std_srvs/Trigger_Request"
    with pytest.raises(UnknownType, match="std_msgs/msg/Nothing"):
        ros2.load("std_msgs/msg/Nothing")
