"""Files of robots as yarprobotinterface reads them: XML of version 3.

Rules: pure but for reading the files. What C++ passes over in silence, or complains of without a
place, is a problem with one: attributes that it ignores, phases that never come, parameters that
are there twice. A file without a document type is read, with a warning, since C++ refuses it.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Final

from yarpy.data.bottle import Bottle, Property
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.element import BadFile, Element
from yarpy.kits.launch.document.problem import Problem, Where
from yarpy.kits.launch.robot.description import (
    KINDS,
    PHASES,
    Action,
    Description,
    Device,
    Parameter,
    networks,
    options,
)
from yarpy.kits.launch.robot.merged import Merge

DOCTYPE: Final = (
    '<!DOCTYPE robot PUBLIC "-//YARP//DTD yarprobotinterface 3.0//EN" '
    '"http://www.yarp.it/DTD/yarprobotinterfaceV3.0.dtd">'
)
_VERSION: Final = re.compile(r"\Ahttp://www\.yarp\.it/DTD/yarprobotinterfaceV(\d+)\.\d+\.dtd\Z")
_PARAMETERS: Final = ("param", "group", "paramlist", "params", "subdevice")
_INSIDE: Final[dict[str, tuple[str, ...]]] = {
    "robot": (*_PARAMETERS, "device", "devices"),
    "devices": (*_PARAMETERS, "device", "devices"),
    "device": (*_PARAMETERS, "action", "actions"),
    "params": _PARAMETERS,
    "group": _PARAMETERS,
    "subdevice": _PARAMETERS,
    "paramlist": ("elem",),
    "actions": ("action", "actions"),
    "action": _PARAMETERS,
    "param": (),
    "elem": (),
}
# Of roots of included files, where most robots have them, without any effect.
_FILE: Final = ("robot", "build", "name", "portprefix", "xmlns:xi")
_ATTRIBUTES: Final[dict[str, tuple[str, ...]]] = {
    "robot": ("name", "build", "portprefix", "reverse-shutdown-action-order", "xmlns:xi"),
    "devices": _FILE,
    "device": ("name", "type", "xmlns:xi"),
    "params": _FILE,
    "param": ("name", "extern-name"),
    "group": ("name", "xmlns:xi"),
    "paramlist": ("name", "xmlns:xi"),
    "elem": ("name",),
    "subdevice": ("type", "xmlns:xi"),
    "actions": _FILE,
    "action": ("phase", "type", "level", "xmlns:xi"),
}


def load(
    path: Path | str,
    *,
    given: Property | None = None,
    portprefix: str | None = None,
    enabled: Collection[str] = (),
    disabled: Collection[str] = (),
) -> Description:
    """Return the robot of a file, with what is odd in it.

    given: options of the command line, which replace parameters with an `extern-name`.
    portprefix: instead of that of the file. enabled, disabled: tags of includes.
    Raises BadFile for a file that is none.
    """
    merge = Merge(enabled, disabled)
    root = merge.tree(Path(path))
    if root.tag != "robot":
        program = f": `yarpy up {path}` starts its programs" if root.tag == "application" else ""
        more = program or advice(root.tag, ["robot"])
        raise BadFile(root.where, f"the root is <{root.tag}>, not <robot>{more}")
    reading = _Reading(given if given is not None else Property(), portprefix)
    found = reading.robot(root)
    found.problems = [*dict.fromkeys([*merge.problems, *found.problems, *found.missing()])]
    found.files = merge.files
    return found


class _Reading:
    def __init__(self, given: Property, portprefix: str | None) -> None:
        self._given = given
        self._forced = portprefix
        self._found = Description()

    def robot(self, root: Element) -> Description:
        found = self._found
        self._doctype(root)
        self._known(root)
        found.name = self._needed(root, "name")
        own = root.attributes.get("portprefix", found.name)
        found.portprefix = own if self._forced is None else self._forced
        found.reverse = self._flag(root, "reverse-shutdown-action-order")
        found.parameters = self._merged([*self._parameters(root)])
        seen: dict[str, Where] = {}
        for device in self._below(root, []):
            if device.name in seen:
                text = f'a device is called "{device.name}" already, at {seen[device.name]}'
                self._warn(device.where, text, True)
            seen.setdefault(device.name, device.where)
            found.devices.append(device)
        return found

    def _doctype(self, root: Element) -> None:
        found = root.doctype
        if found is None:
            self._warn(root.where, f"C++ YARP refuses a file without this line: {DOCTYPE}")
            return
        if found.tag != root.tag:
            self._warn(found.where, f"the document type is for <{found.tag}>, not for <{root.tag}>")
        version = _VERSION.match(found.system)
        if version is None:
            text = f'C++ YARP does not know the document type "{found.system}": write {DOCTYPE}'
            self._warn(found.where, text)
        elif version[1] != "3":
            text = f"files of version {version[1]} are not read: turn it into 3.0, {DOCTYPE}"
            self._warn(found.where, text, True)

    def _below(self, element: Element, common: Sequence[Parameter]) -> Iterator[Device]:
        """Yield the devices in an element, with the parameters that they share."""
        for child in element.children:
            if child.tag == "devices":
                self._known(child)
                yield from self._below(child, [*common, *self._parameters(child)])
            elif child.tag == "device":
                self._known(child)
                name, kind = self._needed(child, "name"), self._needed(child, "type")
                parameters = self._merged([*common, *self._parameters(child)], True)
                actions = tuple(self._actions(child, name))
                if name and kind:
                    yield Device(name, kind, parameters, actions, child.where)

    def _actions(self, element: Element, device: str) -> Iterator[Action]:
        for child in element.children:
            if child.tag == "actions":
                self._known(child)
                yield from self._actions(child, device)
            elif child.tag == "action":
                self._known(child)
                action = self._action(child, device)
                if action is not None:
                    yield action

    def _action(self, element: Element, device: str) -> Action | None:
        words = [self._needed(element, name) for name in ("phase", "type", "level")]
        parameters = options(self._merged([*self._parameters(element)]))
        if not all(words):
            return None
        phase, kind, level = words
        if phase == "run":
            self._warn(element.where, 'an action of phase "run" is never done, in C++ YARP neither')
            return None
        if phase not in PHASES:
            more = advice(phase, PHASES) or f": phases are {', '.join(PHASES)}"
            self._warn(element.where, f'there is no phase "{phase}"{more}', True)
            return None
        if kind not in KINDS:
            more = advice(kind, KINDS) or f": types are {', '.join(KINDS)}"
            self._warn(element.where, f'there is no action "{kind}"{more}', True)
            return None
        if not re.fullmatch(r"\d{1,9}", level, re.ASCII):
            self._warn(element.where, f'the level "{level}" is no number from 0 on', True)
            return None
        found = Action(phase, int(level), kind, device, parameters, element.where)
        self._targets(found)
        return found

    def _targets(self, action: Action) -> None:
        """Say what is missing in the parameters of an action."""
        known = action.parameters
        if action.kind in ("calibrate", "park") and not known.check("target"):
            text = f'{action.kind} needs <param name="target">DEVICE</param>'
            self._warn(action.where, text, True)
        if action.kind != "attach":
            return
        ways = [word for word in ("device", "all", "networks") if known.check(word)]
        if len(ways) != 1:
            said = f"not {' and '.join(ways)}" if ways else "and has none"
            text = f"attach needs one parameter of device, networks and all, {said}"
            self._warn(action.where, text, True)
        elif ways == ["networks"]:
            for name in networks(known):
                if not known.check(name):
                    text = f'attach: no parameter "{name}" says the device of that network'
                    self._warn(action.where, text, True)

    def _parameters(self, element: Element) -> Iterator[Parameter]:
        for child in element.children:
            if child.tag == "param":
                self._known(child)
                if (found := self._parameter(child)) is not None:
                    yield found
            elif child.tag == "group":
                self._known(child)
                name = self._needed(child, "name")
                members = self._merged([*self._parameters(child)])
                if not members:
                    self._warn(child.where, f'the group "{name}" is empty', True)
                elif name:
                    yield Parameter(name, "", child.where, members)
            elif child.tag == "paramlist":
                self._known(child)
                yield from self._list(child)
            elif child.tag == "params":
                self._known(child)
                yield from self._parameters(child)
            elif child.tag == "subdevice":
                self._known(child)
                if kind := self._needed(child, "type"):
                    yield Parameter("subdevice", kind, child.where)
                yield from self._parameters(child)

    def _parameter(self, element: Element) -> Parameter | None:
        name = self._needed(element, "name")
        if not name:
            return None
        if not element.text:
            self._warn(element.where, f'the parameter "{name}" has no value', True)
            return None
        external = element.attributes.get("extern-name", "")
        text, option = self._replaced(element.text), ""
        if external and self._given.check(external):
            group = self._given.group(external) or [external]
            text = Bottle(group[1:]).to_text()
            option = f"--{external}"
            self._found.taken.add(external)
        if text.count("(") != text.count(")"):
            self._warn(element.where, f'the brackets of the parameter "{name}" do not match')
        return Parameter(name, text, element.where, given=option)

    def _list(self, element: Element) -> Iterator[Parameter]:
        name = self._needed(element, "name")
        names = []
        for child in element.children:
            if child.tag == "elem":
                self._known(child)
                key = self._needed(child, "name")
                if key and not child.text:
                    self._warn(child.where, f'the element "{key}" has no value', True)
                elif key:
                    names.append(key)
                    yield Parameter(key, child.text, child.where)
        if not names:
            self._warn(element.where, f'the list "{name}" is empty', True)
        elif name:
            yield Parameter(name, f"({' '.join(names)})", element.where)

    def _merged(self, found: Sequence[Parameter], fatal: bool = False) -> tuple[Parameter, ...]:
        """Return parameters, groups of one name joined; of two others of one name, the first one
        counts, and that is `fatal` or not."""
        known: dict[str, Parameter] = {}
        for one in found:
            first = known.setdefault(one.name, one)
            if first is one:
                continue
            if first.members and one.members:
                members = self._merged([*first.members, *one.members])
                known[one.name] = Parameter(one.name, "", first.where, members)
            else:
                text = f'the parameter "{one.name}" is there already, at {first.where}'
                self._warn(one.where, text if fatal else f"{text}, which counts", fatal)
        return tuple(known.values())

    def _replaced(self, text: str) -> str:
        found = self._found
        values = {
            "portprefix": found.portprefix,
            "portprefixnoslash": found.portprefix.lstrip("/"),
            "robotname": found.name,
        }
        return re.sub(r"\$\{(\w{1,40})\}", lambda one: values.get(one[1], one[0]), text)

    def _known(self, element: Element) -> None:
        """Say which of its children and attributes are ignored."""
        tags, names = _INSIDE[element.tag], _ATTRIBUTES[element.tag]
        for child in element.children:
            if child.tag not in tags:
                more = advice(child.tag, tags)
                self._warn(child.where, f"no <{child.tag}> may be in <{element.tag}>{more}", True)
        for name in element.attributes:
            if name not in names:
                text = f'the attribute "{name}" of <{element.tag}> is ignored{advice(name, names)}'
                self._warn(element.where, text)
        if element.text and element.tag not in ("param", "elem"):
            text = f'the text "{element.text[:30]}" in <{element.tag}> is ignored'
            self._warn(element.where, text)

    def _needed(self, element: Element, name: str) -> str:
        value = element.attributes.get(name, "").strip()
        if not value:
            self._warn(element.where, f'<{element.tag}> has no attribute "{name}"', True)
        return value

    def _flag(self, element: Element, name: str) -> bool:
        value = element.attributes.get(name, "false").strip().lower()
        if value not in ("true", "false", "1", "0"):
            self._warn(element.where, f'{name}="{value}" is neither true nor false', True)
        return value in ("true", "1")

    def _warn(self, where: Where, text: str, fatal: bool = False) -> None:
        self._found.problems.append(Problem(where, text, fatal))
