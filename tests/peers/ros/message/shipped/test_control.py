"""Types of packages that Debian has not, by the sums that ROS has for them."""

import pytest

from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.source import Standard

OWN = Catalogue([Standard()])

MESSAGES = {
    "control_msgs/FollowJointTrajectoryAction": "bc4f9b743838566551c0390c65f1a248",
    "control_msgs/FollowJointTrajectoryGoal": "69636787b6ecbde4d61d711979bc7ecb",
    "control_msgs/JointControllerState": "987ad85e4756f3aef7f1e5e7fe0595d1",
    "control_msgs/JointTolerance": "f544fe9c16cf04547e135dd6063ff5be",
    "control_msgs/JointTrajectoryControllerState": "10817c60c2486ef6b33e97dcd87f4474",
    "control_msgs/GripperCommand": "680acaff79486f017132a7f198d40f08",
    "control_msgs/PointHeadGoal": "8b92b1cd5e06c8a94c917dc3209a4c1d",
    "control_msgs/SingleJointPositionGoal": "fbaaa562a23a013fd5053e5f72cbb35c",
    "actionlib_tutorials/FibonacciAction": "f59df5767bf7634684781c92598b2406",
    "dynamic_reconfigure/ConfigDescription": "757ce9d44ba8ddd801bb30bc456f946f",
    "rospy_tutorials/Floats": "420cd38b6b071cd49f2970c3e2cee511",
}
SERVICES = {
    "dynamic_reconfigure/Reconfigure": "bb125d226a21982a4a98760418dc2672",
    "nav_msgs/GetMap": "6cdd0a18e0aff5b0a3ca2326a89b54ff",
    "rospy_tutorials/AddTwoInts": "6a2e34150c00229791cc89ff309fff21",
    "roscpp_tutorials/TwoInts": "6a2e34150c00229791cc89ff309fff21",
    "control_msgs/QueryTrajectoryState": "ec93cdecbd8062d761aa52b7c90cd44b",
    "control_msgs/QueryCalibrationState": "28af3beedcb84986b8e470dc5470507d",
}


@pytest.mark.parametrize(("name", "sum_"), MESSAGES.items())
def test_messages(name: str, sum_: str) -> None:
    assert OWN.message(name).md5sum == sum_


@pytest.mark.parametrize(("name", "sum_"), SERVICES.items())
def test_services(name: str, sum_: str) -> None:
    assert OWN.service(name).md5sum == sum_
