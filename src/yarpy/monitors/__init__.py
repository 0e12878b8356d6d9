"""Monitors look at, change, delay or refuse the messages of a connection or port."""

from yarpy.monitors.base import DROP, Group, Place

__all__ = ["DROP", "Group", "Place"]
