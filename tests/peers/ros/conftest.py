"""A ROS 1 for the tests of one file."""

from collections.abc import Iterator

import pytest
from support.peer import brings
from support.ros_graph import RosGraph, ros_graph
from support.wrapping import names, no_settings

__all__ = ["graph", "names", "no_settings"]


@pytest.fixture(scope="module")
@brings("ros", "rosmaster")
def graph(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A master; this process finds it by ROS_MASTER_URI, and no YARP server."""
    with (
        ros_graph(tmp_path_factory.mktemp("ros")) as found,
        pytest.MonkeyPatch.context() as patch,
    ):
        patch.delenv("YARPY_SERVER", raising=False)
        patch.setenv("YARP_CONFIG_HOME", str(found.home))
        patch.setenv("ROS_MASTER_URI", found.uri)
        patch.setenv("ROS_IP", "127.0.0.1")
        yield found
