"""Values of YARP as messages of ROS, and back."""
