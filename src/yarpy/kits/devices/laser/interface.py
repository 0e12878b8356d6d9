"""The interface of a laser scanner.

    class Laser:
        angles = (-90.0, 90.0)
        distances = (0.1, 8.0)

        def ranges(self):                             # needed, metres
            return self.scanner.read()                # infinite where nothing was hit

    LaserServer("/robot/laser", Laser())

Rules: as for control boards (`devices.control_board.interface`): your class inherits nothing
and defines only what it supports. Settings are attributes, to which the server assigns.

Source: interfaces of YARP 3.x behind rangefinder2D_nws_yarp.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: What a scanner is doing; the index here is the number in the protocol.
CONDITIONS: Final = ("standby", "in use", "error", "timeout")


class Scan(NamedTuple):
    """A turn of a laser: `ranges` in metres, at even steps between two angles in degrees."""

    angles: tuple[float, float]
    distances: tuple[float, float]  # what it can measure, metres
    ranges: NDArray[Any]
    condition: str = "in use"
    time: float = 0.0


class LaserLike(Protocol):
    """Everything a laser can have. For reading; classes need not inherit it."""

    angles: tuple[float, float]  # of the first and the last range, degrees; default: 0, 360
    distances: tuple[float, float]  # nearest and farthest, metres; default: 0, 100
    step: float  # degrees; default: what the number of ranges makes of the angles
    rate: float  # turns per second
    info: str  # what it is, for people

    def ranges(self) -> Sequence[float]:
        """Metres; infinite where nothing was hit."""

    def condition(self) -> str:
        """One of `CONDITIONS`; default: `in use`."""
