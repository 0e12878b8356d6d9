"""Values by chance: of every type, and not always the same."""

from random import Random

from support.ros_value import filled

from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.source import Standard


def test_every_field_gets_a_value() -> None:
    cloud = Library([Standard()]).message("sensor_msgs/PointCloud2")
    chance = Random(3)
    made = [filled(cloud, chance) for _ in range(30)]
    assert len({message.header.frame_id for message in made}) > 2
    assert any(message.fields for message in made)
    assert {type(message) for message in made} == {cloud}
