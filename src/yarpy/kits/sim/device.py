"""The simulated head as devices of a robot's file: joints, and the eyes and the sensor that move
with them.

    simulatedHead        joints, for controlBoard_nws_yarp
    simulatedEye         attaches a head; `side` left or right, `width` and `height` in pixels;
                         for frameGrabber_nws_yarp
    simulatedInertial    attaches a head; for multipleanalogsensorsserver
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from yarpy.data.bottle import Property
from yarpy.kits.sim.board import Board
from yarpy.kits.sim.body import Body
from yarpy.kits.sim.head import SIDES
from yarpy.kits.sim.icub import ICUB_HEAD
from yarpy.kits.sim.inertial import Inertial
from yarpy.kits.sim.joint import Joint
from yarpy.names.base import NameClient

if TYPE_CHECKING:
    from yarpy.kits.sim.eye import Shutter


class HeadBoard(Board[Joint]):
    """The joints of a head; what moves with them asks `body`."""

    def __init__(self, body: Body[Joint]) -> None:
        super().__init__(body)
        self.body = body
        self._shutter: Shutter | None = None

    @property
    def shutter(self) -> Shutter:
        """The shutter that both eyes share."""
        if self._shutter is None:
            from yarpy.kits.sim.eye import Shutter

            self._shutter = Shutter(self.body)
        return self._shutter


def simulated_head(options: Property, *, names: NameClient | None = None) -> HeadBoard:
    """Return a head like an iCub's: six joints."""
    return HeadBoard(Body([Joint(axis) for axis in ICUB_HEAD]))


class _Moved:
    """Something that moves with a head; `served` once that is attached."""

    def __init__(self) -> None:
        self._served: object = None

    @property
    def served(self) -> object:
        """The device for others. Raises ValueError before a head is attached."""
        if self._served is None:
            raise ValueError("it has no head yet: attach simulatedHead to it at a lower level")
        return self._served

    def attach(self, devices: Mapping[str, object]) -> None:
        """Move with a head. Raises ValueError for anything else."""
        [head, *more] = devices.values() or [None]
        if more or not isinstance(head, HeadBoard):
            raise ValueError("it attaches one device, of type simulatedHead")
        self._served = self._on(head)

    def detach(self) -> None:
        """Belong to no head."""
        self._served = None

    def _on(self, head: HeadBoard) -> object:
        raise NotImplementedError


class SimulatedEye(_Moved):
    """An eye. Raises ValueError for a side that is none, or a size that is too large."""

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        super().__init__()
        self._side = options.find("side", "left")
        if self._side not in SIDES:
            raise ValueError(f'the side is left or right, not "{self._side}"')
        self._size = options.find("width", 320), options.find("height", 240)
        if not all(isinstance(one, int) and 16 <= one <= 2048 for one in self._size):
            raise ValueError(f"{self._size[0]} x {self._size[1]}: each side must be 16 to 2048")

    def _on(self, head: HeadBoard) -> object:
        from yarpy.kits.sim.eye import Eye
        from yarpy.kits.sim.render.scene import room

        return Eye(head.shutter, room(), self._side, *self._size)


class SimulatedInertial(_Moved):
    """The inertial unit of a head."""

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        super().__init__()

    def _on(self, head: HeadBoard) -> object:
        return Inertial(head.body)
