"""The joints of an iCub, in the order that the boards of the real one have.

Angles in degrees. Where a range does not hold zero, the joint begins at its end that is nearest.
The ranges of torso, arms and legs are those of the models that the iCub's makers publish.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from yarpy.kits.sim.axis import Axis

#: Three joints of the neck, three of the eyes.
ICUB_HEAD: Final = (
    Axis("neck_pitch", -40.0, 30.0),
    Axis("neck_roll", -70.0, 60.0),
    Axis("neck_yaw", -55.0, 55.0),
    Axis("eyes_tilt", -35.0, 30.0, speed=150.0, acceleration=3000.0, top_speed=500.0),
    Axis("eyes_version", -50.0, 50.0, speed=150.0, acceleration=3000.0, top_speed=500.0),
    Axis("eyes_vergence", 0.0, 50.0, speed=150.0, acceleration=3000.0, top_speed=500.0),
)

ICUB_TORSO: Final = (
    Axis("torso_yaw", -50.0, 50.0),
    Axis("torso_roll", -30.0, 30.0),
    Axis("torso_pitch", -20.0, 70.0),
)


def _arm(side: str) -> tuple[Axis, ...]:
    """Return the joints of an arm: seven of it, nine of its hand."""
    ranges = {
        "shoulder_pitch": (-95.5, 10.0),
        "shoulder_roll": (0.0, 160.8),
        "shoulder_yaw": (-37.0, 80.0),
        "elbow": (15.0, 106.0),
        "wrist_prosup": (-60.0, 60.0),
        "wrist_pitch": (-80.0, 25.0),
        "wrist_yaw": (-20.0, 25.0),
        "hand_finger": (0.0, 60.0),
        "thumb_oppose": (10.0, 90.0),
        "thumb_proximal": (0.0, 90.0),
        "thumb_distal": (0.0, 180.0),
        "index_proximal": (0.0, 90.0),
        "index_distal": (0.0, 180.0),
        "middle_proximal": (0.0, 90.0),
        "middle_distal": (0.0, 180.0),
        "pinky": (0.0, 270.0),
    }
    return tuple(Axis(f"{side}_{name}", *ends) for name, ends in ranges.items())


def _leg(side: str) -> tuple[Axis, ...]:
    ranges = {
        "hip_pitch": (-45.0, 134.0),
        "hip_roll": (-20.0, 120.0),
        "hip_yaw": (-80.0, 80.0),
        "knee": (-124.0, 4.0),
        "ankle_pitch": (-35.0, 35.0),
        "ankle_roll": (-25.0, 25.0),
    }
    return tuple(Axis(f"{side}_{name}", *ends) for name, ends in ranges.items())


#: What an iCub has besides its head, by the names of its control boards.
ICUB_BODY: Final[Mapping[str, tuple[Axis, ...]]] = {
    "torso": ICUB_TORSO,
    "left_arm": _arm("l"),
    "right_arm": _arm("r"),
    "left_leg": _leg("l"),
    "right_leg": _leg("r"),
}
