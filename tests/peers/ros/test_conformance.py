"""The suites that ship, on what ROS 1 brings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from support.ros_graph import RosGraph

from yarpy.names.base import NameClient
from yarpy.peers.ros.master import RosMaster
from yarpy.peers.ros.names import RosNames
from yarpy.testing import NamesConformance


@pytest.fixture(autouse=True)
def _graph(graph: RosGraph) -> None:
    TestRosNames.uri = graph.uri


class TestRosNames(NamesConformance):
    uri = ""
    properties = False
    listed = False  # without addresses, one by one

    @contextmanager
    def opened(self) -> Iterator[NameClient]:
        names = RosNames(RosMaster(self.uri))
        try:
            yield names
        finally:
            names.close()
