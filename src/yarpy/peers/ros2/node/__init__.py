"""Nodes of ROS 2 in a program of Python."""
