"""Clients over ROS 2: ROS2Client, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.clients import Client, Clients

globals().update(classes(Clients, "ros2"))

__all__ = ["Client", "Clients", *classes(Clients, "ros2")]
