"""The interfaces of Wrapyfi over ROS 1, made by genpy when they are imported."""
