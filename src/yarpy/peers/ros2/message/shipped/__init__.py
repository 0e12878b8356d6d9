"""Definitions of the packages that programs of ROS 2 use most beside its own, for computers without
any ROS: those of Jazzy.

    control                  controllers of joints, grippers and wheels; the turtle of the tutorials
    moveit                   planning of motions, and the scenes that it speaks of
    navigation               goals, paths and maps of Nav2

Rules: declarations alone, as in `standard.py`: the hashes are those of ROS. A definition is one
line with `;` between declarations, a service has `---` in it, an action twice. The messages of ROS
itself, of which they are made, are those of the distribution at hand.
"""

from __future__ import annotations

from typing import Final

from yarpy.peers.ros.message.shipped.action import spelled
from yarpy.peers.ros2.message.shipped import control, moveit, navigation

_PARTS: Final = (control, moveit, navigation)

MESSAGES: Final = {name: spelled(text) for part in _PARTS for name, text in part.MESSAGES.items()}
SERVICES: Final = {name: spelled(text) for part in _PARTS for name, text in part.SERVICES.items()}
ACTIONS: Final = {name: spelled(text) for part in _PARTS for name, text in part.ACTIONS.items()}
