import numpy as np

from yarpy.kits.devices.laser.client import Laser
from yarpy.kits.devices.laser.interface import CONDITIONS, LaserLike, Scan


def test_a_client_is_a_whole_laser() -> None:
    members = {name for name in [*vars(LaserLike), *LaserLike.__annotations__] if name[0] != "_"}
    assert members == {
        *("angles", "distances", "step", "rate", "info", "ranges", "condition"),
    }
    assert all(hasattr(Laser, name) for name in members)
    assert Scan((0.0, 1.0), (0.0, 1.0), np.zeros(3)).condition == CONDITIONS[1]
