"""What is known of the joints of the head."""

import pytest

from yarpy.kits.sim.axis import ICUB_HEAD, Axis


def test_head_of_an_icub():
    assert [axis.name for axis in ICUB_HEAD] == [
        *("neck_pitch", "neck_roll", "neck_yaw"),
        *("eyes_tilt", "eyes_version", "eyes_vergence"),
    ]
    assert ICUB_HEAD[1].lowest < -45 and ICUB_HEAD[1].highest > 45
    assert ICUB_HEAD[5].lowest == 0


def test_range_the_wrong_way_round():
    with pytest.raises(ValueError, match="from 2 to 1"):
        Axis("x", 2, 1)
