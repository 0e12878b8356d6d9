"""What a node tells of its types, as another implementation and we ask for it."""

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.message.description import type_of
from yarpy.peers.ros2.message.library import hash_of
from yarpy.peers.ros2.node.describer import TYPE

ADD = "example_interfaces/srv/AddTwoInts"


@pytest.mark.parametrize(
    ("name", "kind"),
    [("sensor_msgs/JointState", "msg"), (ADD.replace("/srv", ""), "srv")],
)
def test_types_of_the_node(names: yarpy.LocalNames, name: str, kind: str) -> None:
    whole = name.replace("/", f"/{kind}/")
    with ros2.Node("/arm") as arm, ros2.Node("/asker") as asker:
        if kind == "msg":
            arm.publisher("joints", whole)
        else:
            arm.service("add", whole, lambda asked: [asked.a])
        hash_ = hash_of(ros2.load(whole))
        assert asker.client("/arm/get_type_description", TYPE).wait(HANG)
        for said in (hash_, ""):
            asked = {"type_name": whole, "type_hash": said}
            found = asker.call("/arm/get_type_description", TYPE, asked, timeout=HANG)
            assert found.successful
            made = type_of(found.type_description, name, kind, hash_)
            assert hash_of(made) == hash_


def test_other_types(names: yarpy.LocalNames) -> None:
    with ros2.Node("/arm") as arm, ros2.Node("/asker") as asker:
        assert asker.client("/arm/get_type_description", TYPE).wait(HANG)
        asked = {"type_name": "sensor_msgs/msg/Imu"}
        found = asker.call("/arm/get_type_description", TYPE, asked, timeout=HANG)
        assert not found.successful and "has no type sensor_msgs/msg/Imu" in found.failure_reason
        arm.publisher("imu", "sensor_msgs/msg/Imu")
        wait_until(
            lambda: asker.call("/arm/get_type_description", TYPE, asked, timeout=HANG).successful
        )
