"""Actions of ROS 1: goals that take a while, with feedback, that can be canceled (actionlib).

status     what becomes of a goal, the types and the topics of an action
server     takes goals and carries them out
client     sends goals, and hears of them
"""
