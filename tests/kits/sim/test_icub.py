"""The joints of an iCub."""

from yarpy.kits.sim.icub import ICUB_BODY, ICUB_HEAD
from yarpy.kits.sim.joint import Joint


def test_head_of_an_icub():
    assert [axis.name for axis in ICUB_HEAD] == [
        *("neck_pitch", "neck_roll", "neck_yaw"),
        *("eyes_tilt", "eyes_version", "eyes_vergence"),
    ]
    assert ICUB_HEAD[1].lowest < -45 and ICUB_HEAD[1].highest > 45
    assert ICUB_HEAD[5].lowest == 0


def test_boards_of_its_body():
    assert {part: len(axes) for part, axes in ICUB_BODY.items()} == {
        "torso": 3,
        "left_arm": 16,
        "right_arm": 16,
        "left_leg": 6,
        "right_leg": 6,
    }
    assert [axis.name for axis in ICUB_BODY["torso"]] == ["torso_yaw", "torso_roll", "torso_pitch"]
    names = [axis.name for axes in ICUB_BODY.values() for axis in axes]
    assert len(set(names)) == 47 and "r_elbow" in names and "l_knee" in names


def test_a_joint_begins_where_it_may_be():
    elbow = next(axis for axis in ICUB_BODY["left_arm"] if axis.name == "l_elbow")
    assert Joint(elbow).position == elbow.lowest == 15
