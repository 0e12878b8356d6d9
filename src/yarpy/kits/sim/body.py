"""Body: joints, and their simulated time.

    with body.present() as joints:      # the joints as they are now; nothing moves in here
        print(joints[0].position)

Rules: a body has no thread. Time passes on demand: `present` first lets the joints catch up with
the clock. The clock is an argument, so tests can set the time. Any thread may call, one at a time.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Final, Generic, TypeVar

from yarpy.clock import now
from yarpy.kits.sim.joint import Joint

J = TypeVar("J", bound=Joint)

STEP: Final = 0.005  # longest step, seconds
MEMORY: Final = 5.0  # most seconds to catch up with

Clock = Callable[[], float]


class Body(Generic[J]):
    """These joints, in the time of `clock`, in seconds."""

    def __init__(self, joints: Sequence[J], clock: Clock = now) -> None:
        self.joints = tuple(joints)
        self._clock = clock
        self.time = clock()  # the time that the joints have reached
        self._lock = threading.RLock()  # board, cameras and sensors have their own threads

    @contextmanager
    def present(self) -> Iterator[tuple[J, ...]]:
        """Hold the body at the present moment."""
        with self._lock:
            now = self._clock()
            ahead = now - self.time
            if ahead >= 1e-4:
                self.elapse(min(ahead, MEMORY))
            if ahead >= 1e-4 or ahead < 0:  # the clock may be set back
                self.time = now
            yield self.joints

    def elapse(self, seconds: float) -> None:
        """Let time pass. Inside `present` only."""
        count = -int(-seconds // STEP)
        for _ in range(count):
            for joint in self.joints:
                joint.step(seconds / count)
