"""World: the objects of a simulator. Descriptions: the devices of a robot.

Source: ISimulatedWorld of YARP 3.12.3 and 4.0, IRobotDescription of 3.9, 3.12 and 4.0.
"""

from __future__ import annotations

from typing import ClassVar

from yarpy.kits.devices.network.model import Interface, call
from yarpy.kits.thrift.kind import Nested, i16
from yarpy.kits.thrift.structure import Struct


class Pose(Struct):
    """Metres, and roll, pitch and yaw in radians."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0


class Colour(Struct):
    """Each from 0 to 255."""

    r: i16 = 0
    g: i16 = 0
    b: i16 = 0


class Description(Struct):
    """A device: its name, its type, how it was opened, and more. YARP 3.9 knows the first two."""

    SPOKEN: ClassVar[int] = 2

    device_name: str = ""
    device_type: str = ""
    device_configuration: str = ""
    device_extra_info: str = ""


class World(Interface):
    """A simulator. `frame`: whose coordinates those are; "" is the world."""

    NWS, NWC = "simulatedWorld_nws_yarp", "simulatedWorld_nwc_yarp"
    FAKE = "fakeSimulatedWorld"
    VIEW = "ISimulatedWorld"
    ONLY_4 = True
    RPC = "rpc:i"

    @call("makeSphere", cpp="makeSphere")
    def make_sphere(
        self,
        name: str,
        radius: float,
        pose: Nested[Pose],
        colour: Nested[Colour],
        frame: str = "",
        gravity: bool = False,
        collision: bool = True,
    ) -> None:
        """Make a sphere of this radius."""

    @call("makeBox", cpp="makeBox")
    def make_box(
        self,
        name: str,
        width: float,
        height: float,
        thickness: float,
        pose: Nested[Pose],
        colour: Nested[Colour],
        frame: str = "",
        gravity: bool = False,
        collision: bool = True,
    ) -> None:
        """Make a box of this size."""

    @call("makeCylinder", cpp="makeCylinder")
    def make_cylinder(
        self,
        name: str,
        radius: float,
        length: float,
        pose: Nested[Pose],
        colour: Nested[Colour],
        frame: str = "",
        gravity: bool = False,
        collision: bool = True,
    ) -> None:
        """Make a cylinder of this size."""

    @call("makeFrame", cpp="makeFrame")
    def make_frame(
        self,
        name: str,
        size: float,
        pose: Nested[Pose],
        colour: Nested[Colour],
        frame: str = "",
        gravity: bool = False,
        collision: bool = True,
    ) -> None:
        """Make three axes of this length."""

    @call("makeModel", cpp="makeModel")
    def make_model(
        self,
        name: str,
        file: str,
        pose: Nested[Pose],
        frame: str = "",
        gravity: bool = False,
        collision: bool = True,
    ) -> None:
        """Make what a file of the simulator describes."""

    @call("makeActor", cpp="makeActor")
    def make_actor(self, name: str, skin: str, animation: str, pose: Nested[Pose]) -> None:
        """Make somebody who moves, from files of the simulator."""

    @call("changeColor", cpp="changeColor")
    def paint(self, name: str, colour: Nested[Colour]) -> None:
        """Give an object another colour."""

    @call("setPose", cpp="setPose")
    def place(self, name: str, pose: Nested[Pose], frame: str = "") -> None:
        """Put an object there."""

    @call("getPose", cpp="getPose")
    def pose(self, name: str, frame: str = "") -> Nested[Pose]:
        """Return where an object is."""
        raise NotImplementedError

    @call("enableGravity", cpp="enableGravity")
    def enable_gravity(self, name: str, enable: bool) -> None:
        """Let an object fall, or not."""

    @call("enableCollision", cpp="enableCollision")
    def enable_collision(self, name: str, enable: bool) -> None:
        """Let an object be in the way, or not."""

    @call("deleteObject", cpp="deleteObject")
    def delete(self, name: str) -> None:
        """Remove an object."""

    @call("deleteAll", cpp="deleteAll")
    def clear(self) -> None:
        """Remove all that was made."""

    @call("getList", cpp="getList")
    def objects(self) -> list[str]:
        """Return the names of all that was made."""
        raise NotImplementedError

    @call("attach", cpp="attach")
    def attach(self, name: str, link: str) -> None:
        """Fix an object to a link of a robot."""

    @call("detach", cpp="detach")
    def detach(self, name: str) -> None:
        """Let it go."""

    @call("rename", cpp="rename")
    def rename(self, name: str, new_name: str) -> None:
        """Give an object another name."""


class Descriptions(Interface):
    """The interface of a device that knows which devices a robot has."""

    NWS, NWC = "robotDescription_nws_yarp", "robotDescription_nwc_yarp"
    FAKE = "robotDescriptionStorage"
    VIEW = "IRobotDescription"
    RPC = ""
    WORDS = "list"

    @call("getAllDevicesRPC", cpp="getAllDevices", words="irob get all")
    def devices(self) -> list[Description]:
        """Return all."""
        raise NotImplementedError

    @call("getAllDevicesByTypeRPC", cpp="getAllDevicesByType", words="irob get type")
    def devices_of(self, type: str) -> list[Description]:
        """Return those of a type."""
        raise NotImplementedError

    @call("registerDeviceRPC", cpp="registerDevice", words="irob set dev")
    def register(self, device: Nested[Description]) -> None:
        """Add one."""

    @call("unregisterDeviceRPC", cpp="unregisterDevice", words="irob del dev")
    def unregister(self, name: str) -> None:
        """Remove one."""

    @call("unregisterAllRPC", cpp="unregisterAll")
    def clear(self) -> None:
        """Remove all."""
