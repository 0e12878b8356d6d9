"""The time of a node: the computer's, or that of a simulation, where `use_sim_time` is set.

Rules: /clock is listened to only while it is wanted, by best effort as rclcpp does.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, Final

from yarpy.peers.ros2.qos import BEST_EFFORT, Qos
from yarpy.peers.ros2.rmw import Held

CLOCK: Final = "/clock"
CLOCK_QOS: Final = Qos(BEST_EFFORT, depth=1)


class NodeTime:
    """`listen(heard)` subscribes to /clock."""

    def __init__(self, listen: Callable[[Callable[[Any], object]], Held]) -> None:
        self._listen = listen
        self._heard: Held | None = None
        self._now = 0.0

    def now(self) -> float:
        """Seconds; of a simulation what was said last."""
        return time.time() if self._heard is None else self._now

    def follow(self, simulated: bool) -> None:
        """Listen to /clock from now on, or no longer."""
        if simulated and self._heard is None:
            self._now = 0.0
            self._heard = self._listen(self._hear)
        elif not simulated and self._heard is not None:
            heard, self._heard = self._heard, None
            heard.close()

    def _hear(self, message: Any) -> None:
        self._now = float(message.clock.sec) + float(message.clock.nanosec) / 1e9
