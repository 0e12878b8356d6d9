"""Members of a remote control board that came with YARP 4: brakes, and velocities at once.

    with ControlBoard("/robot/arm") as arm:
        arm.apply_brakes("elbow", True)
        print(arm.braked())

Rules: the words of YARP 3 have none of it. A board that is asked in those is asked for this in the
functions of YARP 4 beside them, over a connection of its own, made when it is first needed; one
that has no such functions does not have these members either, which is a LocalProtocolError.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from typing import TypeAlias

from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.control_board.remote_parts import Asks
from yarpy.names.base import NameClient

#: One joint or several, by index or by name.
Which: TypeAlias = int | str | Sequence[int | str]
Values: TypeAlias = float | Sequence[float]
Flags: TypeAlias = bool | Sequence[bool]


class Second(Closeable):
    """Asks a board of YARP 3's words in the functions of YARP 4, if it has these too."""

    def __init__(self, first: Asks, remote: str, local: str, names: NameClient | None) -> None:
        self._first = first
        self._remote = remote
        self._local = local
        self._names = names
        self._lock = threading.Lock()
        self._made: Asks | None = None
        self._resources = ExitStack()

    def asks(self) -> Asks:
        """Return what asks. Raises LocalProtocolError if nothing can, LinkClosed."""
        if self._first.newer:
            return self._first
        with self._lock:  # two threads may be the first to need it
            if self._made is None:
                self._made = self._opened()
            return self._made

    def _opened(self) -> Asks:
        from yarpy.kits.devices.control_board.yarp4.requests import FunctionRequests

        try:
            made = FunctionRequests(self._remote, f"{self._local}/nwc/rpc:o", self._names)
        except UnknownName:
            raise LocalProtocolError(
                f'"{self._remote}" is a board of YARP 3: brakes and velocity_direct came with 4.0'
            ) from None
        self._resources.callback(made.close)
        made.axes = self._first.axes
        return made


class NewerMembers(Closeable):
    """Members of `ControlBoard`; it says which joints are meant, and streams commands."""

    axes: int
    _second: Second

    def braked(self) -> list[bool]:
        """Return for each joint whether its brake holds it."""
        return self._second.asks().read("braked")

    def apply_brakes(self, joints: Which, active: Flags) -> None:
        """Brake these joints, or release them."""
        numbers = self._joints(joints)
        flags = [active] * len(numbers) if isinstance(active, bool) else [*active]
        if len(flags) != len(numbers):
            raise ValueError(f"{len(flags)} values for {len(numbers)} joints")
        self._second.asks().write("apply_brakes", numbers, flags)

    @property
    def automatic_brakes(self) -> tuple[bool, ...]:
        """Return for each joint whether the robot brakes it by itself."""
        return tuple(self._second.asks().read("automatic_brakes"))

    @automatic_brakes.setter
    def automatic_brakes(self, enabled: Iterable[bool]) -> None:
        flags = [*enabled]
        if len(flags) != self.axes:
            raise ValueError(f"automatic_brakes: {len(flags)} values for {self.axes} joints")
        self._second.asks().write("automatic_brakes", [*range(self.axes)], flags)

    def velocity_direct(self, joints: Which, speeds: Values) -> None:
        """Move at these speeds at once, deg/s. The joints must be in mode `veld`."""
        self._second.asks()  # what a board of YARP 3 does not understand, it does not refuse
        self._stream("velocity_direct", joints, speeds)

    def direct_velocity_targets(self) -> list[float]:
        """The last `velocity_direct`, deg/s."""
        return self._second.asks().read("direct_velocity_targets")

    def _joints(self, which: Which | None) -> list[int]:
        raise NotImplementedError

    def _stream(self, method: str, which: Which, values: Values) -> None:
        raise NotImplementedError
