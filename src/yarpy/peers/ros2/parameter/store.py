"""The parameters of a node: declared with a value, and changed within what was declared.

Rules: pure but for a lock. A parameter keeps its kind unless it was declared as dynamic. Changes
are made together or not at all; who watches is asked before, and may refuse with a ValueError.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from yarpy.errors import UnknownName
from yarpy.limit import ROS2_PARAMETERS
from yarpy.peers.ros2.parameter.value import DOUBLE, INTEGER, NAMES, NOT_SET, Value, kind_of, plain

Watcher = Callable[[dict[str, Value]], object]


@dataclass(frozen=True, slots=True)
class Descriptor:
    """The values that a parameter may have. `low`, `high`, `step`: of a number; a step of 0
    allows all between them."""

    description: str = ""
    constraints: str = ""
    read_only: bool = False
    dynamic: bool = False
    low: float | None = None
    high: float | None = None
    step: float = 0

    def check(self, name: str, value: Value) -> None:
        """Raise ValueError for a number out of the range."""
        if self.low is None or self.high is None or not isinstance(value, int | float):
            return
        if not self.low <= value <= self.high:
            raise ValueError(f"{name} is from {self.low} to {self.high}, not {value}")
        if self.step and value not in (self.low, self.high):
            steps = (value - self.low) / self.step
            if abs(steps - round(steps)) > 1e-9 * max(1.0, abs(steps)):
                raise ValueError(f"{name} goes from {self.low} in steps of {self.step}")


@dataclass(slots=True)
class _Parameter:
    value: Value
    kind: int
    descriptor: Descriptor


@dataclass(frozen=True, slots=True)
class Change:
    """A change, as others are told of it."""

    new: dict[str, Value] = field(default_factory=dict)
    changed: dict[str, Value] = field(default_factory=dict)
    deleted: dict[str, Value] = field(default_factory=dict)


class Parameters:
    """Of one node. `told` is called with each Change, after it was made. `given`: values that were
    said from outside, in place of those that parameters are declared with."""

    def __init__(
        self,
        told: Callable[[Change], None] = lambda change: None,
        given: Mapping[str, Any] | None = None,
    ) -> None:
        self._told = told
        self.given = dict(given or {})
        self._all: dict[str, _Parameter] = {}
        self._watchers: list[Watcher] = []
        self._lock = threading.RLock()  # a watcher may look at other parameters

    def declare(self, name: str, value: Any, descriptor: Descriptor | None = None) -> Value:
        """Add a parameter; return its value. Raises ValueError for a name that is there already, or
        none; TypeError for a value that can be no parameter."""
        descriptor = descriptor or Descriptor()
        made = plain(value)
        if name in self.given:
            made = _given(name, plain(self.given[name]), made, descriptor)
        descriptor.check(name, made)
        with self._lock:
            if not name or name in self._all:
                raise ValueError(f'"{name[:80]}" cannot be declared: it is there, or no name')
            if len(self._all) >= ROS2_PARAMETERS:
                raise ValueError(f"more than {ROS2_PARAMETERS} parameters")
            self._all[name] = _Parameter(made, kind_of(made), descriptor)
        self._told(Change(new={name: made}))
        return made

    def undeclare(self, name: str) -> None:
        """Take a parameter away. Raises UnknownName; ValueError for one that is read-only."""
        with self._lock:
            found = self._found(name)
            if found.descriptor.read_only:
                raise ValueError(f"{name} is read-only")
            del self._all[name]
        self._told(Change(deleted={name: found.value}))

    def get(self, name: str) -> Value:
        """Return a parameter's value. Raises UnknownName."""
        return self._found(name).value

    def has(self, name: str) -> bool:
        """Return whether there is such a parameter."""
        return name in self._all

    def described(self, name: str) -> tuple[int, Descriptor]:
        """Return the kind and the descriptor of a parameter. Raises UnknownName."""
        found = self._found(name)
        return found.kind, found.descriptor

    def set(self, values: Mapping[str, Any]) -> None:
        """Change parameters, all or none. Raises UnknownName, TypeError (of another kind),
        ValueError (read-only, out of range, or refused)."""
        made: dict[str, Value] = {}
        with self._lock:
            for name, value in values.items():
                made[name] = self._fitting(name, plain(value))
            for watcher in self._watchers:
                watcher(dict(made))
            for name, value in made.items():
                item = self._all[name]
                item.value = value
                item.kind = item.kind if value is None else kind_of(value)
        if made:
            self._told(Change(changed=made))

    def watch(self, watcher: Watcher) -> None:
        """Call `watcher(changes)` before any change; it refuses by raising ValueError."""
        with self._lock:
            self._watchers.append(watcher)

    def names(self, prefixes: Iterable[str] = (), depth: int = 0) -> list[str]:
        """Return the names below some prefixes, all without any; a depth of 0 is any: it counts the
        parts of a name, which have dots between, behind the prefix."""
        wanted = [*prefixes]
        return sorted(name for name in [*self._all] if _is_wanted(name, wanted, depth))

    def __iter__(self) -> Any:
        return iter(self.names())

    def _found(self, name: str) -> _Parameter:
        found = self._all.get(name)
        if found is None:
            raise UnknownName(f'there is no parameter "{name[:80]}"')
        return found

    def _fitting(self, name: str, value: Value) -> Value:
        """The value that a parameter takes, if it may."""
        item = self._found(name)
        if item.descriptor.read_only:
            raise ValueError(f"{name} is read-only")
        kind = kind_of(value)
        if not item.descriptor.dynamic and item.kind != NOT_SET and kind != item.kind:
            if item.kind == DOUBLE and kind == INTEGER:
                raise TypeError(f"{name} is a double: write {value!r}.0")
            raise TypeError(f"{name} is a {NAMES[item.kind]}, not a {NAMES[kind]}")
        item.descriptor.check(name, value)
        return value


def _given(name: str, value: Value, declared: Value, descriptor: Descriptor) -> Value:
    """The value from outside, if it is of the kind that was declared."""
    kind, wanted = kind_of(value), kind_of(declared)
    if kind != wanted and wanted != NOT_SET and not descriptor.dynamic:
        hint = f": write {value!r}.0" if (wanted, kind) == (DOUBLE, INTEGER) else ""
        raise TypeError(f"{name} is a {NAMES[wanted]}, but set to a {NAMES[kind]}{hint}")
    return value


def _is_wanted(name: str, prefixes: list[str], depth: int) -> bool:
    if not prefixes:
        return not depth or name.count(".") < depth
    for prefix in prefixes:
        if name == prefix:
            return True
        if name.startswith(f"{prefix}."):
            return not depth or name[len(prefix) + 1 :].count(".") < depth
    return False
