"""Transforms between the frames of a robot: tf and tf2.

pose        a rotation and a translation; pure
buffer      the frames that are known, and where they were when; pure
topic       the topics /tf and /tf_static, of nodes of ROS 1 and 2
"""
