"""The contract of a device: what the plug-ins `yarpy.devices` are, and may have.

    class Arm:
        def __init__(self, options, *, names=None):
            self.axis_names = ["elbow"]

        def encoders(self): ...

    [project.entry-points."yarpy.devices"]
    myArm = "my_package:Arm"

Rules: a plug-in is called with the parameters of the file as a `Property`, in which `device` is its
type, `id` its name, `robotName` the prefix of the robot's ports; `names` is the name client for its
ports. It returns an object or raises; the reason is told with the place in the file. The object
inherits nothing, and has of the methods below what it supports.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from yarpy.data.bottle import Property
from yarpy.names.base import NameClient


class Plugin(Protocol):
    """Opens devices of one type."""

    def __call__(self, options: Property, *, names: NameClient | None = None) -> object:
        """Return a device. Raises whatever it is that goes wrong."""


class Attaches(Protocol):
    """A device that uses others."""

    def attach(self, devices: Mapping[str, object]) -> None:
        """Begin to use devices, by the names of their networks; `...` for one that has no name.
        Raises ValueError for what it cannot use."""

    def detach(self) -> None:
        """Use them no more."""


class Calibrates(Protocol):
    """A device that moves others to where they begin, and to where they may be switched off."""

    def calibrate(self, target: object) -> None:
        """Calibrate a device; returns when that is done."""

    def park(self, target: object) -> None:
        """Bring a device to its place of rest; returns when it is there."""


class Serves(Protocol):
    """A device whose interface is an object of its own."""

    @property
    def served(self) -> object:
        """The object that others get when they attach this device."""


class Closes(Protocol):
    """A device that holds something."""

    def close(self) -> None:
        """Give it back. Called once, after `detach`, in the reverse order of opening."""
