"""Access to a user's device of any kind, by the rules in the `interface` of each kind.

Rules: one thread at a time, except for calls that may take long. Everything passed to the device
and everything it returns is checked. Whatever a device raises becomes `Refused`, with one line in
the log; NotImplementedError means that the device lacks this member, and is not logged.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final, TypeVar

from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.kind import FLOAT, Kind
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused

T = TypeVar("T")

#: Calls that may take long run concurrently with everything else.
_LONG: Final = frozenset(
    ("calibrate", "calibrate_joint", "home", "park", "quit_calibration", "quit_parking")
)

_MISSING: Final[Any] = object()


class Access:
    """An object with methods and attributes, any of which may be missing, for `count` joints."""

    def __init__(
        self, target: object, count: int, complain: DeviceErrorLog, lock: threading.Lock
    ) -> None:
        self.target = target
        self.count = count
        self._complain = complain
        # Users' classes are not thread-safe, and requests, commands and the publisher come from
        # different threads.
        self._lock = lock

    def has(self, member: str) -> bool:
        """Return whether the device has this method or attribute."""
        # A property of the class counts even if it would fail now; reading it could take long.
        return hasattr(type(self.target), member) or hasattr(self.target, member)

    def offers(self, members: Iterable[str]) -> bool:
        """Return whether the device has at least one of these."""
        return any(self.has(member) for member in members)

    def values(self, member: str, kind: Kind = FLOAT) -> list[Any]:
        """The values of all joints. Raises Refused: missing, failed, or not as promised."""

        def check(found: Any) -> list[Any]:
            values = kind.check_all(found() if callable(found) else found)
            if len(values) != self.count:
                raise ValueError(f"{len(values)} values for {self.count} joints")
            return values

        return self.use(member, check)

    def ask(self, member: str, *arguments: object) -> Any:
        """Return the result of a method, or the value of an attribute. Raises Refused."""
        return self.use(member, lambda found: found(*arguments) if callable(found) else found)

    def use(self, member: str, action: Callable[[Any], T]) -> T:
        """Call `action` with a member; any error becomes Refused."""
        try:
            if member in _LONG:
                return action(self._get(member))
            with self._lock:
                return action(self._get(member))
        except Refused:
            raise
        except (NotImplementedError, LocalProtocolError) as error:
            raise Refused(f"the device has no {member}: {error}") from error
        except Exception as error:
            self._complain(member, error)
            raise Refused(f"{member} failed") from error

    def apply(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None:
        """Call a method for these joints, or change an attribute. Raises Refused."""
        self._check(joints)

        def act(found: Any) -> None:
            if not callable(found):
                self._assign(member, found, joints, values)
            elif values is None:
                found([*joints])
            else:
                found([*joints], [*values])

        self.use(member, act)

    def store(self, member: str, value: object) -> None:
        """Assign to an attribute that the device has. Raises Refused."""
        self.use(member, lambda found: setattr(self.target, member, value))

    def _check(self, joints: Sequence[int]) -> None:
        if not joints:
            raise Refused("no joints are given")
        for joint in joints:
            if not 0 <= joint < self.count:
                raise Refused(f"no joint {joint} (there are 0 to {self.count - 1})")

    def _get(self, member: str) -> Any:
        found = getattr(self.target, member, _MISSING)
        if found is _MISSING:
            raise Refused(f"the device has no {member}")
        return found

    def _assign(
        self, member: str, found: Any, joints: Sequence[int], values: Sequence[Any] | None
    ) -> None:
        if values is None:
            raise Refused(f"{member} is an attribute: it needs values")
        changed = [*found]
        for joint, value in zip(joints, values, strict=True):
            changed[joint] = value
        setattr(self.target, member, changed)
