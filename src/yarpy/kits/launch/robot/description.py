"""A robot as its files describe it: devices with their parameters, and actions by phase and level.

Rules: pure values. Includes are part of what has them, parameters that a block of devices shares
are among those of each, groups of one name are one. Each parameter remembers where it is written,
or that the command line has given it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from yarpy.data.bottle import Bottle, Property
from yarpy.kits.launch.document.problem import Problem, Where

PHASES: Final = ("startup", "interrupt1", "interrupt2", "interrupt3", "shutdown")
# The last three do nothing, in C++ neither.
KINDS: Final = ("attach", "detach", "calibrate", "park", "configure", "abort", "custom")
ALONE: Final = "..."  # the network of an `attach` that names none
_DOWN: Final = ("shutdown", "interrupt1", "interrupt2", "interrupt3")


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter, whose values are those of `text`; a group has `members` instead. `given`: the
    option of the command line that replaced the text of the file, "" for none."""

    name: str
    text: str
    where: Where
    members: tuple[Parameter, ...] = ()
    given: str = ""

    @property
    def bottle(self) -> Bottle:
        """The list `(name value ...)`."""
        if self.members:
            return Bottle([self.name, *(one.bottle for one in self.members)])
        return Bottle([self.name, *Bottle.from_text(self.text)])


def options(parameters: Sequence[Parameter]) -> Property:
    """Return parameters as a device gets them."""
    return Property.from_bottle(one.bottle for one in parameters)


@dataclass(frozen=True, slots=True)
class Action:
    """Something that a device does in a phase; actions of lower levels come first."""

    phase: str
    level: int
    kind: str
    device: str
    parameters: Property
    where: Where

    @property
    def targets(self) -> dict[str, str] | None:
        """The devices that are attached, calibrated or parked, by the name of their network; None
        for all that there are."""
        if self.kind in ("calibrate", "park"):
            return {ALONE: str(self.parameters.find("target", ""))}
        if self.kind != "attach":
            return {}
        if self.parameters.check("all"):
            return None
        if self.parameters.check("device"):
            network = str(self.parameters.find("network", ALONE))
            return {network: str(self.parameters.find("device", ""))}
        return {name: str(self.parameters.find(name, "")) for name in networks(self.parameters)}


def networks(parameters: Property) -> list[str]:
    """Return the names in the parameter `networks`, as a list or one after the other."""
    group = parameters.group("networks") or Bottle(["networks"])
    words = group[1] if len(group) == 2 and isinstance(group[1], list) else group[1:]
    return [str(word) for word in words]


@dataclass(frozen=True, slots=True)
class Device:
    """A device of a type, with its parameters and its actions, in the order of the file."""

    name: str
    type: str
    parameters: tuple[Parameter, ...]
    actions: tuple[Action, ...]
    where: Where


@dataclass(slots=True)
class Description:
    """All of it, with what is odd in its files; `taken` are the options of the command line that
    parameters were replaced by."""

    name: str = ""
    portprefix: str = ""
    reverse: bool = False
    parameters: tuple[Parameter, ...] = ()
    devices: list[Device] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    files: list[str] = field(default_factory=list)
    taken: set[str] = field(default_factory=set)

    @property
    def fatal(self) -> bool:
        """Return whether it cannot run as it is written."""
        return any(problem.fatal for problem in self.problems)

    @property
    def summary(self) -> str:
        """Its name, and how many devices it has."""
        many = len(self.devices)
        return f"{self.name}: {many} device{'' if many == 1 else 's'}"

    def options(self, device: Device) -> Property:
        """Return what a device is opened with: its parameters, its type, its name, the prefix."""
        found = Property(device=device.type, id=device.name, robotName=self.portprefix)
        found.update(options(device.parameters))
        return found

    def levels(self, phase: str) -> Iterator[tuple[int, list[Action]]]:
        """Yield the levels of a phase in their order, each with its actions in that of the file."""
        actions = [one for device in self.devices for one in device.actions if one.phase == phase]
        order = sorted({one.level for one in actions}, reverse=self.reverse and phase in _DOWN)
        for level in order:
            yield level, [one for one in actions if one.level == level]

    def missing(self, external: Sequence[str] = ()) -> list[Problem]:
        """Return the targets of actions that are neither devices here nor in `external`."""
        known = {*external, *(device.name for device in self.devices)}
        found = []
        for device in self.devices:
            for action in device.actions:
                for target in (action.targets or {}).values():
                    if target and target not in known:
                        text = f'{action.kind}: no device here is called "{target}"'
                        found.append(Problem(action.where, text))
        return found
