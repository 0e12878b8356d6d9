"""Frame: where a part of a robot lies, in the part that it hangs on; and what knows that.

Rules: metres; orientations are unit quaternions x, y, z, w. The frames of a robot are a tree with
one root, each below its parent, and parents come first. The frame of a camera has the name of its
part (`cam/left`): x right, y down, z in viewing direction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from yarpy.kits.sim.rotation import Quaternion, Vector


@dataclass(frozen=True, slots=True)
class Frame:
    """A frame called `name`: its origin in the frame `parent`, and how it is turned there."""

    name: str
    parent: str
    origin: Vector
    orientation: Quaternion


class Framed(Protocol):
    """A robot whose frames are known."""

    def frames(self) -> tuple[float, Sequence[Frame]]:
        """Return the time, in seconds, and the frames as they are then."""
