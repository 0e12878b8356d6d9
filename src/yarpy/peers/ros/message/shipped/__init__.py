"""Definitions of the packages that programs of ROS use most, for computers without any ROS.

    geometry                 points, poses, twists; transforms (tf, tf2); maps, paths, odometry
    control                  trajectories of joints, grippers, diagnostics, the clock and the log
    moveit                   planning of motions, and the shapes and scenes that it speaks of
    action                   goals of actionlib, and the seven messages of an action

Rules: declarations alone, as in `standard.py`: the checksums are those of ROS. A definition is one
line with `;` between declarations, a service has `---` in it, an action twice.
"""

from __future__ import annotations

from typing import Final

from yarpy.peers.ros.message.shipped import control, geometry, moveit
from yarpy.peers.ros.message.shipped.action import messages_of, spelled

_ACTIONS: Final = {**geometry.ACTIONS, **control.ACTIONS, **moveit.ACTIONS}

MESSAGES: Final = {
    **{
        name: spelled(text)
        for part in (geometry.MESSAGES, control.MESSAGES, moveit.MESSAGES)
        for name, text in part.items()
    },
    **{
        name: text
        for action, parts in _ACTIONS.items()
        for name, text in messages_of(action, spelled(parts)).items()
    },
}

SERVICES: Final = {
    name: spelled(text)
    for part in (geometry.SERVICES, control.SERVICES, moveit.SERVICES)
    for name, text in part.items()
}
