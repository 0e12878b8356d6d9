"""SimulatedWorld: objects that stay where they were put; DescriptionStorage: a list of devices.
fakeSimulatedWorld and robotDescriptionStorage in C++.

Rules: anybody can make something, so there is a limit.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from yarpy.kits.devices.interfaces.world import Colour, Description, Pose
from yarpy.kits.devices.refusal import Refused
from yarpy.limit import WORLD_OBJECTS


@dataclass
class Thing:
    """An object: its kind, where it is, and `link`, what it is fixed to."""

    kind: str
    pose: Pose
    size: tuple[float, ...] = ()
    colour: Colour = field(default_factory=Colour)
    frame: str = ""
    gravity: bool = False
    collision: bool = True
    link: str = ""


class SimulatedWorld:
    """Every member of `interfaces.world.World`. `things`: the objects by name."""

    def __init__(self) -> None:
        self.things: dict[str, Thing] = {}

    def make_sphere(self, name: str, radius: float, pose: Pose, colour: Colour, *more: Any) -> None:
        """Make a sphere."""
        self._add(name, Thing("sphere", pose, (radius,), colour, *more))

    def make_box(
        self,
        name: str,
        width: float,
        height: float,
        thickness: float,
        pose: Pose,
        colour: Colour,
        *more: Any,
    ) -> None:
        """Make a box."""
        self._add(name, Thing("box", pose, (width, height, thickness), colour, *more))

    def make_cylinder(
        self, name: str, radius: float, length: float, pose: Pose, colour: Colour, *more: Any
    ) -> None:
        """Make a cylinder."""
        self._add(name, Thing("cylinder", pose, (radius, length), colour, *more))

    def make_frame(self, name: str, size: float, pose: Pose, colour: Colour, *more: Any) -> None:
        """Make three axes."""
        self._add(name, Thing("frame", pose, (size,), colour, *more))

    def make_model(self, name: str, file: str, pose: Pose, *more: Any) -> None:
        """Make something without a look: the file is not read."""
        self._add(name, Thing("model", pose, (), Colour(), *more))

    def make_actor(self, name: str, skin: str, animation: str, pose: Pose) -> None:
        """Make somebody who does not move."""
        self._add(name, Thing("actor", pose))

    def paint(self, name: str, colour: Colour) -> None:
        """Give an object another colour."""
        self._thing(name).colour = colour

    def place(self, name: str, pose: Pose, frame: str = "") -> None:
        """Put an object there."""
        found = self._thing(name)
        found.pose, found.frame = pose, frame

    def pose(self, name: str, frame: str = "") -> Pose:
        """Return where it was put. Refused in the coordinates of another frame."""
        found = self._thing(name)
        if frame != found.frame:
            raise Refused(f"{name[:60]!r} was placed in the frame {found.frame!r}")
        return found.pose

    def enable_gravity(self, name: str, enable: bool) -> None:
        """Keep the value: nothing falls here."""
        self._thing(name).gravity = enable

    def enable_collision(self, name: str, enable: bool) -> None:
        """Keep the value: nothing collides here."""
        self._thing(name).collision = enable

    def delete(self, name: str) -> None:
        """Remove an object."""
        self._thing(name)
        self.things.pop(name, None)

    def clear(self) -> None:
        """Remove all."""
        self.things.clear()

    def objects(self) -> list[str]:
        """Return the names of all."""
        return [*self.things]

    def attach(self, name: str, link: str) -> None:
        """Fix an object to a link."""
        self._thing(name).link = link

    def detach(self, name: str) -> None:
        """Let it go."""
        self._thing(name).link = ""

    def rename(self, name: str, new_name: str) -> None:
        """Give an object another name."""
        found = self._thing(name)
        self._add(new_name, found)
        del self.things[name]

    def _thing(self, name: str) -> Thing:
        found = self.things.get(name)
        if found is None:
            raise Refused(f"there is no {name[:60]!r}")
        return found

    def _add(self, name: str, thing: Thing) -> None:
        if name in self.things:
            raise Refused(f"there is a {name[:60]!r}")
        if len(self.things) >= WORLD_OBJECTS:
            raise Refused(f"{WORLD_OBJECTS} objects are there, no more")
        self.things[name] = thing


class DescriptionStorage:
    """Every member of `interfaces.world.Descriptions`."""

    def __init__(self) -> None:
        self._known: dict[str, Description] = {}

    def devices(self) -> list[Description]:
        """Return all."""
        return [*self._known.values()]

    def devices_of(self, type: str) -> list[Description]:
        """Return those of a type."""
        return [each for each in self.devices() if each.device_type == type]

    def register(self, device: Description) -> None:
        """Add one. Refused if there is one of this name."""
        if device.device_name in self._known:
            raise Refused(f"there is a device {device.device_name[:60]!r}")
        if len(self._known) >= WORLD_OBJECTS:
            raise Refused(f"{WORLD_OBJECTS} devices are there, no more")
        self._known[device.device_name] = device

    def unregister(self, name: str) -> None:
        """Remove one."""
        if self._known.pop(name, None) is None:
            raise Refused(f"there is no device {name[:60]!r}")

    def clear(self) -> None:
        """Remove all."""
        self._known.clear()
