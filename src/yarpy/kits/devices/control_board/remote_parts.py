"""Parts of a remote control board: its controllers, its variables.

Rules: whoever asks the board is handed in, in the words of YARP 3 or the functions of YARP 4.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from typing import Any, Protocol

from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.adjustable import Adjustable
from yarpy.kits.devices.control_board.interface import Gains


class Asks(Protocol):
    """The questions that a client asks a board."""

    newer: bool  # it is of YARP 4
    axes: int

    def read(self, member: str) -> list[Any]: ...
    def write(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None: ...
    def read_pid(self, kind: str, member: str) -> list[Any]: ...
    def write_pid(
        self, kind: str, member: str, joints: Sequence[int], values: Sequence[Any] | None
    ) -> None: ...
    def version(self) -> tuple[int, ...]: ...
    def count_axes(self) -> int: ...
    def all_done(self) -> bool: ...
    def calibrate_joint(self, joint: int, kind: int, parameters: Sequence[float]) -> None: ...
    def calibration_done(self, joint: int) -> bool: ...
    def calibrator(self, member: str, joints: Sequence[int]) -> None: ...
    def variable(self, name: str) -> Any: ...
    def store_variable(self, name: str, values: Sequence[Any]) -> None: ...
    def variable_names(self) -> list[str]: ...
    def close(self) -> None: ...


class _PidRequests:
    """`Requests` for one kind of controllers."""

    def __init__(self, requests: Asks, kind: str) -> None:
        self.axes = requests.axes
        self._requests = requests
        self._kind = kind

    def read(self, member: str) -> list[Any]:
        return self._requests.read_pid(self._kind, member)

    def write(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None:
        self._requests.write_pid(self._kind, member, joints, values)


class RemotePids:
    """The controllers of one kind at a remote board, see `control_board.PidController`."""

    gains = Adjustable[Gains]("`Gains`", Gains._make)
    targets = Adjustable[float]("The targets of the controllers.")
    error_limits = Adjustable[float]("Beyond these errors the controllers stop.")
    enabled = Adjustable[bool]("Whether the controllers are active.")

    def __init__(self, requests: Asks, kind: str) -> None:
        self._ask = _PidRequests(requests, kind)

    def errors(self) -> list[float]:
        """Target minus measurement."""
        return self._ask.read("errors")

    def outputs(self) -> list[float]:
        """The present outputs of the controllers."""
        return self._ask.read("outputs")

    def reset(self, joints: Sequence[int]) -> None:
        """Reset the integral."""
        self._ask.write("reset", joints, None)

    @property
    def details(self) -> Sequence[Mapping[str, str]]:
        """Descriptions of the controllers; boards of YARP 4 alone tell."""
        return self._ask.read("details")

    @property
    def offsets(self) -> tuple[float, ...]:
        """Added to the outputs. The protocol sets them separately but reads them with the gains."""
        return tuple(gains.offset for gains in self.gains)

    @offsets.setter
    def offsets(self, values: Sequence[float]) -> None:
        self._ask.write("offsets", [*range(self._ask.axes)], [*values])


class RemoteVariables(MutableMapping[str, Any]):
    """Variables of a remote board. A value is the list of the elements after the name."""

    def __init__(self, requests: Asks) -> None:
        self._ask = requests

    def __getitem__(self, key: str) -> Any:
        try:
            found = self._ask.variable(key)
        except LocalProtocolError as error:
            raise KeyError(key) from error
        return found

    def __setitem__(self, key: str, value: Any) -> None:
        self._ask.store_variable(key, value if isinstance(value, (list, tuple)) else [value])

    def __delitem__(self, key: str) -> None:
        raise TypeError("variables of a robot cannot be deleted")

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def _names(self) -> list[str]:
        return self._ask.variable_names()
