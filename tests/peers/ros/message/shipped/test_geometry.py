"""Transforms, of packages that Debian has not; the others are compared in `test_standard.py`."""

import pytest

from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.source import Standard

OWN = Catalogue([Standard()])


def test_transforms_of_the_first_tf() -> None:
    assert OWN.message("tf/tfMessage").md5sum == "94810edda583a504dfda3829e70d7eec"
    assert OWN.service("tf/FrameGraph").md5sum == "c4af9ac907e58e906eb0b6e3c58478c0"


def test_transforms_need_no_installed_ros() -> None:
    used = [item.name for item in OWN.message("tf2_msgs/TFMessage").all_used()]
    assert used[0] == "geometry_msgs/TransformStamped"
    with pytest.raises(LookupError):
        OWN.message("tf2_msgs/Nothing")
