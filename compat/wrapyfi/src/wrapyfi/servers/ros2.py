"""Servers over ROS 2: ROS2Server, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.servers import Server, Servers

globals().update(classes(Servers, "ros2"))

__all__ = ["Server", "Servers", *classes(Servers, "ros2")]
