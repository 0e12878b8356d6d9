"""A camera with everything, as tests need one: 64 by 48 pixels whose first counts the images."""

from __future__ import annotations

from typing import Any

import numpy as np


class FakeCamera:
    """The camera of the recorded sessions, as far as they tell."""

    def __init__(self, width: int = 64, height: int = 48) -> None:
        self.resolution = (width, height)
        self.resolutions = [(128, 128, 60.0, "rgb"), (256, 256, 30.0, "bgr")]
        self.field_of_view = (1.0, 2.0)
        self.intrinsics = {"focalLengthX": 4.0, "distortionModel": "FishEye"}
        self.mirror = False
        self.features: dict[str, Any] = {"brightness": 0.5, "white_balance": (0.25, 0.75)}
        self.feature_modes = {"gain": "auto"}
        self.feature_switches = {"trigger": True}
        self.description = ("usb", "a fake")
        self.pushed: list[str] = []
        self.taken = 0

    def image(self) -> np.ndarray:
        width, height = self.resolution
        pixels = np.zeros((height, width, 3), "uint8")
        pixels[0, 0] = (self.taken % 256, 1, 2)
        pixels[:, -1] = 255
        self.taken += 1
        return pixels

    def one_push(self, feature: str) -> None:
        self.pushed.append(feature)
