"""Publishers over ROS 2: ROS2Publisher, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.publishers import Publisher, Publishers

globals().update(classes(Publishers, "ros2"))

__all__ = ["Publisher", "Publishers", *classes(Publishers, "ros2")]
