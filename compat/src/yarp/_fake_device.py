"""Devices without hardware, by the names of C++ YARP: fakeFrameGrabber, fakeMotionControl.

Rules: they have the members that `yarpy.devices` describes, and do at once what they are told.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any


class FakeFrameGrabber:
    """A camera that sees a white line, which goes down."""

    description = ("unknown", "fakeFrameGrabber")

    def __init__(self, width: int = 320, height: int = 240) -> None:
        self.resolution = (width, height)
        self.features = {"brightness": 0.5, "gain": 0.5}
        self._begin = time.monotonic()

    def image(self) -> Any:
        """The picture at this time."""
        import numpy as np

        width, height = self.resolution
        picture = np.zeros((height, width, 3), "u1")
        picture[:, :, 2] = 80
        picture[int((time.monotonic() - self._begin) * 30) % height] = 255
        return picture


class FakeMotionControl:
    """Joints that are at once where they are sent."""

    def __init__(self, count: int = 4) -> None:
        self.axis_names = [f"joint{joint}" for joint in range(count)]
        self.axis_types = ["revolute"] * count
        self.reference_speeds = [10.0] * count
        self.reference_accelerations = [10.0] * count
        self.position_limits = [(-180.0, 180.0)] * count
        self.velocity_limits = [(0.0, 100.0)] * count
        self._at = [0.0] * count
        self._modes = ["pos"] * count
        self._stiff = ["stif"] * count

    def encoders(self) -> list[float]:
        return [*self._at]

    def encoder_speeds(self) -> list[float]:
        return [0.0] * len(self._at)

    def control_modes(self) -> list[str]:
        return [*self._modes]

    def interaction_modes(self) -> list[str]:
        return [*self._stiff]

    def motion_done(self) -> list[bool]:
        return [True] * len(self._at)

    def position_move(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        """Be there; not beyond the limits."""
        for joint, position in zip(joints, positions, strict=True):
            lowest, highest = self.position_limits[joint]
            self._at[joint] = min(max(position, lowest), highest)

    position_direct = position_move

    def velocity_move(self, joints: Sequence[int], speeds: Sequence[float]) -> None:
        """Stay: nothing moves by itself here."""

    def stop(self, joints: Sequence[int]) -> None:
        """Nothing moves."""

    def switch_control_modes(self, joints: Sequence[int], modes: Sequence[str]) -> None:
        for joint, mode in zip(joints, modes, strict=True):
            self._modes[joint] = "idl" if mode == "fidl" else mode

    def switch_interaction_modes(self, joints: Sequence[int], modes: Sequence[str]) -> None:
        for joint, mode in zip(joints, modes, strict=True):
            self._stiff[joint] = mode
