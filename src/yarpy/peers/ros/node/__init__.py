"""Nodes of ROS 1 in a program of Python."""
