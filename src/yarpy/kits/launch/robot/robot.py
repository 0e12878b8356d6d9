"""A robot that runs: its devices opened, its actions done level by level, all closed in reverse.

Rules: devices are opened in the order of the file; if one fails, the others are tried so that all
reasons are told, and then all are closed, unless `keep_going` lets the rest run. An action that
fails stops no other, but the startup as a whole has failed then. Calibrating and parking run side
by side, and end with their level. What is not open is never asked for anything.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.problem import Where
from yarpy.kits.launch.robot.contract import Plugin
from yarpy.kits.launch.robot.description import Action, Description, Device
from yarpy.names.base import NameClient


class Slot:
    """A device of the file and how it is doing: `closed`, `open` or `failed`, and why."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.state = "closed"
        self.detail = ""
        self.object: Any = None


class Robot:
    """Runs a robot from `start` to `stop`.

    plugins: returns what opens devices of a type; raises a YarpError if there is none. external:
    devices that are handed in, by name; they can be attached, and are not closed here. names: the
    name client for all ports. news: gets lines for people.
    """

    def __init__(
        self,
        description: Description,
        plugins: Callable[[str], Plugin],
        *,
        external: Mapping[str, object] | None = None,
        keep_going: bool = False,
        names: NameClient | None = None,
        news: Callable[[str], None] = lambda line: None,
    ) -> None:
        self.description = description
        self.phase = "unknown"
        self.level = 0
        self.slots = {device.name: Slot(device) for device in description.devices}
        self._plugins = plugins
        self._external = dict(external or {})
        self._keep_going = keep_going
        self._names = names
        self._news = news
        self._opened: list[Slot] = []
        self._undone: list[Action] = []
        self._lock = threading.Lock()  # of what is opened: `retry` may come while it ends
        self._over = False

    @property
    def ready(self) -> bool:
        """Return whether it runs: it has started, and does not end."""
        return self.phase == "run"

    def start(self) -> bool:
        """Open the devices and do the actions of the startup; return whether all went well."""
        self.phase = "startup"
        opened = [self._open(slot) for slot in self.slots.values()]
        well = all(opened)
        if not well and not self._keep_going:
            self.close()
            return False
        if not self.do("startup") and not self._keep_going:
            return False
        self.phase = "run"
        return True

    def do(self, phase: str) -> bool:
        """Do the actions of a phase; return whether all of them went well."""
        self.phase = phase
        well = True
        for level, actions in self.description.levels(phase):
            self.level = level
            well = self._do_all(actions) and well
        self.level = 0
        return well

    def stop(self) -> bool:
        """Do the actions of the first interrupt and of the shutdown, and close all devices."""
        if not self._opened:
            return True
        well = self.do("interrupt1")
        well = self.do("shutdown") and well
        self.close()
        return well

    def close(self) -> None:
        """Close all devices, the last one first."""
        with self._lock:
            self._over = True
            opened, self._opened = self._opened, []
        for slot in reversed(opened):
            try:
                if (close := getattr(slot.object, "close", None)) is not None:
                    close()
            except Exception as error:
                self._tell(slot.device.where, f'"{slot.device.name}" does not close: {_why(error)}')
            slot.state, slot.detail, slot.object = "closed", "", None

    def retry(self, name: str) -> bool:
        """Open a device that has failed, and do the actions of the startup that could not be done
        without it; return whether it is open. Raises UnknownName, LocalProtocolError."""
        if name not in self.slots:
            raise UnknownName(f'no device is called "{name}"{advice(name, [*self.slots])}')
        slot = self.slots[name]
        if not self.ready:
            raise LocalProtocolError(f"the robot is in phase {self.phase}: wait until it runs")
        with self._lock:
            if self._over or slot.state == "open" or not self._open(slot):
                return slot.state == "open"
            undone, self._undone = self._undone, []
            for action in undone:
                self._do_all([action])
        return True

    def _open(self, slot: Slot) -> bool:
        device = slot.device
        try:
            plugin = self._plugins(device.type)
            slot.object = plugin(self.description.options(device), names=self._names)
        except Exception as error:
            slot.state, slot.detail = "failed", _why(error)
            self._tell(
                device.where, f'"{device.name}" ({device.type}) does not open: {_why(error)}'
            )
            return False
        slot.state, slot.detail = "open", ""
        self._opened.append(slot)
        return True

    def _do_all(self, actions: list[Action]) -> bool:
        """Do the actions of one level, in order; those that take long side by side."""
        failed: list[Action] = []
        threads = []
        for action in actions:
            if action.kind in ("calibrate", "park"):
                thread = threading.Thread(
                    target=self._do, args=(action, failed), name=f"yarpy {action.kind}", daemon=True
                )
                thread.start()
                threads.append(thread)
            else:
                self._do(action, failed)
        for thread in threads:
            thread.join()
        if self.phase in ("startup", "run"):
            self._undone += [action for action in actions if action in failed]
        return not failed

    def _do(self, action: Action, failed: list[Action]) -> None:
        try:
            self._act(action)
        except Exception as error:
            failed.append(action)
            self._tell(
                action.where, f'{action.kind} of "{action.device}" has failed: {_why(error)}'
            )

    def _act(self, action: Action) -> None:
        own = self._object(action.device)
        if action.kind == "attach":
            method = _method(own, "attach")
            named = action.targets
            if named is None:
                method({name: self._served(name) for name in self._all(action.device)})
            else:
                method({network: self._served(name) for network, name in named.items()})
        elif action.kind == "detach":
            _method(own, "detach")()
        elif action.kind in ("calibrate", "park"):
            for name in (action.targets or {}).values():
                _method(own, action.kind)(self._served(name))

    def _all(self, but: str) -> list[str]:
        opened = [name for name, slot in self.slots.items() if slot.state == "open" and name != but]
        return [*opened, *self._external]

    def _served(self, name: str) -> object:
        found = self._object(name)
        return getattr(found, "served", found)

    def _object(self, name: str) -> object:
        if name in self._external:
            return self._external[name]
        if name not in self.slots:
            raise LocalProtocolError(f'no device is called "{name}"{advice(name, [*self.slots])}')
        if self.slots[name].state != "open":
            raise LocalProtocolError(f'"{name}" is not open')
        return self.slots[name].object

    def _tell(self, where: Where, text: str) -> None:
        self._news(f"{where}: {text}")


def _method(device: object, name: str) -> Callable[..., object]:
    """Return a method of a device. Raises LocalProtocolError if it has none."""
    found = getattr(device, name, None)
    if not callable(found):
        raise LocalProtocolError(f"devices of its type have no {name}()")
    method: Callable[..., object] = found
    return method


def _why(error: Exception) -> str:
    return str(error) or type(error).__name__
