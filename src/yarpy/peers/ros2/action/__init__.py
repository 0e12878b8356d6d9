"""Actions of ROS 2: goals that take a while, with feedback, that can be canceled.

status     what becomes of a goal, and the names of an action's services and topics
server     takes goals and carries them out
client     sends goals, and hears of them
"""
