"""A ROS 1 for the tests of one file."""

from support.ros_graph import graph, graph_apart
from support.wrapping import names, no_settings

__all__ = ["graph", "graph_apart", "names", "no_settings"]
