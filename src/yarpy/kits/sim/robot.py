"""Robot: devices under their names, served on YARP ports.

    with Robot("/icubSim", icub_head()):             # /icubSim/head/rpc:i, /icubSim/cam/left ...
        ...

Rules: a robot is just its devices: control boards, cameras, sensors, lasers, a base. How their
ports talk to browsers, C++ programs or people is up to the ports.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Protocol

from yarpy.clock import now
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.control_board.interface import Joints
from yarpy.kits.devices.frame_grabber.interface import Camera
from yarpy.kits.sim.board import Board
from yarpy.kits.sim.body import Body, Clock
from yarpy.kits.sim.frame import Framed
from yarpy.kits.sim.head import SIDES
from yarpy.kits.sim.icub import ICUB_BODY, ICUB_HEAD
from yarpy.kits.sim.joint import Joint

if TYPE_CHECKING:
    from yarpy.kits.devices import FrameGrabberServer
    from yarpy.kits.devices.interfaces.place import Odometry, Place
    from yarpy.names.base import NameClient

NAME: Final = "/icubSim"
FPS: Final = 30.0
SIZE: Final = (320, 240)


class Localized(Protocol):
    """A base: how it has moved, and where it is (`Odometry2D`, `Localization2D`)."""

    def odometry(self) -> Odometry: ...

    def position(self) -> Place: ...


@dataclass(frozen=True)
class Parts:
    """The devices of a robot, by the names of their ports without the robot's."""

    boards: Mapping[str, Joints] = field(default_factory=dict)
    cameras: Mapping[str, Camera] = field(default_factory=dict)
    sensors: Mapping[str, object] = field(default_factory=dict)
    lasers: Mapping[str, object] = field(default_factory=dict)
    base: Localized | None = None
    frames: Framed | None = None


def icub_head(size: tuple[int, int] = SIZE, clock: Clock = now) -> Parts:
    """A head like an iCub's in a room: six joints, two eyes, an inertial unit.

    size: width and height of the pictures. clock: returns the time in seconds; by default that of
    the program (`yarpy.clock`).
    """
    from yarpy.kits.sim.eye import Eye, Shutter
    from yarpy.kits.sim.head_frames import HeadFrames
    from yarpy.kits.sim.inertial import Inertial
    from yarpy.kits.sim.render.scene import room

    body = Body([Joint(axis) for axis in ICUB_HEAD], clock)
    shutter, scene = Shutter(body), room()
    left, right = (Eye(shutter, scene, side, *size) for side in SIDES)
    return Parts(
        {"head": Board(body)},
        {"cam/left": left, "cam/right": right},
        {"inertial": Inertial(body)},
        frames=HeadFrames(body),
    )


def icub(size: tuple[int, int] = SIZE, clock: Clock = now) -> Parts:
    """A head as `icub_head` makes it, and the boards of torso, arms and legs. The head does not
    move with the torso: what it sees and feels is its own.
    """
    head = icub_head(size, clock)
    body = {
        part: Board(Body([Joint(axis) for axis in axes], clock)) for part, axes in ICUB_BODY.items()
    }
    return Parts({**head.boards, **body}, head.cameras, head.sensors, frames=head.frames)


class Robot(Closeable):
    """Serves `parts` while it is open; a context manager.

    name: prefix of all ports. fps: pictures per second. names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer.
    """

    def __init__(
        self, name: str, parts: Parts, fps: float = FPS, *, names: NameClient | None = None
    ) -> None:
        from yarpy.kits.devices import (
            ControlBoardServer,
            FrameGrabberServer,
            LaserServer,
            Localization2D,
            MultiSensorServer,
            Odometry2D,
        )

        self.name = name = prefix(name)
        self.parts = parts
        self.ports: list[str] = []  # prefixes
        self.cameras: dict[str, FrameGrabberServer] = {}  # by their parts' names
        with ExitStack() as resources:
            for part, board in parts.boards.items():
                server = ControlBoardServer(f"{name}/{part}", board, names=names)
                self.ports.append(resources.enter_context(server).name)
            for part, camera in parts.cameras.items():
                grabber = FrameGrabberServer(f"{name}/{part}", camera, 1 / fps, names=names)
                self.ports.append(resources.enter_context(grabber).name)
                self.cameras[part] = grabber
            for part, sensors in parts.sensors.items():
                measures = MultiSensorServer(f"{name}/{part}", sensors, names=names)
                self.ports.append(resources.enter_context(measures).name)
            for part, laser in parts.lasers.items():
                scans = LaserServer(f"{name}/{part}", laser, names=names)
                self.ports.append(resources.enter_context(scans).name)
            if parts.base is not None:
                for part, interface in (("odometry", Odometry2D), ("localization", Localization2D)):
                    served = interface.serve(f"{name}/{part}", parts.base, names=names)
                    resources.enter_context(served)
                    self.ports.append(f"{name}/{part}")
            self._resources = resources.pop_all()
