"""Parameters of nodes of ROS 2: what a node has, who may change it, and who is told.

value      Python's values and those of ROS 2; pure
store      the parameters of a node; pure
server     the services by which others ask for them, and the topic that tells of changes
client     the parameters of another node
"""
