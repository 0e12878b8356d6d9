"""Services of ROS 1: their carrier, methods as services, and calls of a node."""
