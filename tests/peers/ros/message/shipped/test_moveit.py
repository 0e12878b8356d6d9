"""Types of MoveIt, by the sums that generated code of others has for them."""

import pytest

from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.source import Standard

OWN = Catalogue([Standard()])

MESSAGES = {
    "moveit_msgs/AllowedCollisionMatrix": "aedce13587eef0d79165a075659c1879",
    "moveit_msgs/AttachedCollisionObject": "30199ef516f64c8bc1edb1084ce4584e",
    "moveit_msgs/CollisionObject": "dbba710596087da521c07564160dfccb",
    "moveit_msgs/Constraints": "cfd22a10c51e0dc2b28d98772d2b55d5",
    "moveit_msgs/ContactInformation": "116228ca08b0c286ec5ca32a50fdc17b",
    "moveit_msgs/CostSource": "abb7e013237dacaaa8b97e704102f908",
    "moveit_msgs/DisplayRobotState": "61c4e677a6fbbc83f0d5d9df2be85e3c",
    "moveit_msgs/DisplayTrajectory": "41936b74e168ba754279ae683ce3f121",
    "moveit_msgs/GenericTrajectory": "d68b5c73072efa2012238a77e49c2c58",
    "moveit_msgs/Grasp": "e26c8fb64f589c33c5d5e54bd7b5e4cb",
    "moveit_msgs/JointLimits": "8ca618c7329ea46142cbc864a2efe856",
    "moveit_msgs/KinematicSolverInfo": "cc048557c0f9795c392dd80f8bb00489",
    "moveit_msgs/PlaceLocation": "7b53f032c68481686026c3e9223d0713",
    "moveit_msgs/PlanningOptions": "3134e041c806c7c2ff59948db4d57835",
    "moveit_msgs/PlanningScene": "acfc50bcfd6c7b978066bfa7c786002c",
    "moveit_msgs/PlanningSceneComponents": "bc993e784476960b918b6e7ad5bb58ce",
    "moveit_msgs/PositionIKRequest": "cb7c3615ee4d29d023dfdc5950af0504",
    "moveit_msgs/RobotState": "968156f4aa4cb4018f1f2293eebcea8f",
    "moveit_msgs/RobotTrajectory": "dfa9556423d709a3729bcef664bddf67",
    "moveit_msgs/TrajectoryConstraints": "a8fd55b45c3918e857080ca125d29e9c",
    # Nearly all others are in this one.
    "moveit_msgs/MoveGroupAction": "33225407c32b189345eec6893a5a0da3",
    "sensor_msgs/MultiDOFJointState": "690f272f0640d2631c305eeb8301e59d",
    "shape_msgs/Mesh": "1ffdae9486cd3316a121c578b47a85cc",
    "shape_msgs/Plane": "2c1b92ed8f31492f8e73f6a4a44ca796",
    "shape_msgs/SolidPrimitive": "d8f8cbc74c5ff283fca29569ccefb45d",
    "std_msgs/ColorRGBA": "a29a96539573343b1310c73607334b00",
}
SERVICES = {
    "moveit_msgs/ApplyPlanningScene": "d4d1599e0b6f71a6a8a10cb34780619c",
    "moveit_msgs/GetPlanningScene": "65cf69d3e7a0342e16374024d4eeef65",
    "moveit_msgs/GetStateValidity": "06ea62db671e4dbf878eaca241db51ad",
    "moveit_msgs/LoadMap": "93a4bc4c60dc17e2a69e3fcaaa25d69d",
    "moveit_msgs/QueryPlannerInterfaces": "5876081117e7cad85cc165e937798753",
    "moveit_msgs/SetPlannerParams": "14bebee5d4d53a2df94b7f146d3eb2ff",
}


@pytest.mark.parametrize(("name", "sum_"), MESSAGES.items())
def test_messages(name: str, sum_: str) -> None:
    assert OWN.message(name).md5sum == sum_


@pytest.mark.parametrize(("name", "sum_"), SERVICES.items())
def test_services(name: str, sum_: str) -> None:
    assert OWN.service(name).md5sum == sum_


def test_everything_is_whole() -> None:
    from yarpy.peers.ros.message.shipped import MESSAGES as ALL
    from yarpy.peers.ros.message.shipped import SERVICES as CALLS

    for name in (name for name in ALL if name.startswith("moveit_msgs/")):
        assert OWN.message(name).struct.fields
    for name in (name for name in CALLS if name.startswith("moveit_msgs/")):
        assert OWN.service(name).md5sum
