"""Listeners over ROS 2: ROS2Listener, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.listeners import Listener, Listeners

globals().update(classes(Listeners, "ros2"))

__all__ = ["Listener", "Listeners", *classes(Listeners, "ros2")]
