"""Bags of ROS 1: read, written, and what recordings keep of messages of ROS 1."""
