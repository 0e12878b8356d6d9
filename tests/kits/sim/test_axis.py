"""What is known of a joint."""

import pytest

from yarpy.kits.sim.axis import Axis


def test_range_the_wrong_way_round():
    with pytest.raises(ValueError, match="from 2 to 1"):
        Axis("x", 2, 1)
