"""Body: joints and the time that passes for them.

    with body.present() as joints:      # the joints as they are now; nothing moves in here
        print(joints[0].position)

Rules: a body has no thread. Time passes when somebody looks: `present` lets the joints catch up
with the clock first. The clock is given, so a test decides what time it is. Any thread may look,
one at a time.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Final

from yarpy.services.sim.axis import Axis
from yarpy.services.sim.joint import Joint

STEP: Final = 0.005  # seconds that pass at once, at most
MEMORY: Final = 5.0  # what happened in a longer time that nobody looked is not worked out

Clock = Callable[[], float]


class Body:
    """Joints with these axes, each at `positions[i]` or as near to 0 as it can be."""

    def __init__(
        self, axes: Sequence[Axis], clock: Clock = time.time, positions: Sequence[float] = ()
    ) -> None:
        starts = [*positions] or [0.0] * len(axes)
        self.joints = tuple(Joint(axis, start) for axis, start in zip(axes, starts, strict=True))
        self._clock = clock
        self.time = clock()  # until which the joints have come
        self._lock = threading.RLock()  # board, cameras and sensors look from threads of their own

    @contextmanager
    def present(self) -> Iterator[tuple[Joint, ...]]:
        """Hold the body at the present moment."""
        with self._lock:
            self._catch_up()
            yield self.joints

    def _catch_up(self) -> None:
        now = self._clock()
        ahead = min(now - self.time, MEMORY)
        if ahead >= 1e-4:
            count = -int(-ahead // STEP)
            for _ in range(count):
                self.step(ahead / count)
            self.time = now
        elif ahead < 0:
            self.time = now  # the clock was set back

    def step(self, dt: float) -> None:
        """Let `dt` seconds pass. Inside `present` only."""
        for joint in self.joints:
            joint.step(dt)
