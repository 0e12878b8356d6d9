"""The client side of a control board of YARP 4: `table` used to call functions.

Rules: as `requests`, whose methods it has: the fewest possible calls, for all joints where there is
a function for that, else for several, else one joint at a time. What is not done is a
LocalProtocolError that says which function was refused, and how.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.control_board.grammar import Form
from yarpy.kits.devices.control_board.yarp4 import table
from yarpy.kits.devices.control_board.yarp4.functions import ControlBoardMsgs
from yarpy.kits.devices.control_board.yarp4.table import Row
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.status import reason
from yarpy.names.base import NameClient

#: Seconds to wait for an answer.
TIMEOUT: Final = 10.0

_READ: Final = {row.member: row for row in reversed(table.READ)}
_WRITE: Final = {row.member: row for row in table.WRITE}
_PID_READ: Final = {row.member: row for row in table.PID_READ}
_PID_WRITE: Final = {row.member: row for row in table.PID_WRITE}


class FunctionRequests(Closeable):
    """Calls functions of the board at `remote`."""

    newer = True

    def __init__(self, remote: str, local: str, names: NameClient | None) -> None:
        self.remote = remote
        self.axes = 0
        self._resources = ExitStack()
        self._client = self._resources.enter_context(
            ControlBoardMsgs.connect(
                f"{remote}/nws/rpc:i", timeout=TIMEOUT, name=local, names=names
            )
        )

    # -- members of the interface -------------------------------------------------------------

    def read(self, member: str) -> list[Any]:
        """The values of all joints."""
        if member not in _READ:
            raise LocalProtocolError(f'"{self.remote}" of YARP 4 does not tell {member}')
        return self._read(_READ[member], ())

    def write(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None:
        """Act on these joints, or change a setting of theirs."""
        if member not in _WRITE:
            raise AttributeError(f"{member} can only be read")
        self._write(_WRITE[member], (), joints, values)

    def read_pid(self, kind: str, member: str) -> list[Any]:
        """The same of the controllers of one kind."""
        return self._read(_PID_READ[member], (_pid(kind),))

    def write_pid(
        self, kind: str, member: str, joints: Sequence[int], values: Sequence[Any] | None
    ) -> None:
        """The same of the controllers of one kind."""
        if member == "enabled" and values is not None:
            for joint, value in zip(joints, values, strict=True):
                self.ask("enablePid" if value else "disablePid", _pid(kind), joint)
            return
        if member not in _PID_WRITE:
            raise AttributeError(f"{member} can only be read")
        self._write(_PID_WRITE[member], (_pid(kind),), joints, values)

    def _read(self, row: Row, first: Sequence[Any]) -> list[Any]:
        shape = row.shape
        try:
            if row.all and shape is not table.TRUTH:
                columns = [list(map(_plain, found)) for found in self.ask(row.all, *first)]
                values = [shape.gather(fields) for fields in zip(*columns, strict=True)]
                if len(values) != self.axes:
                    raise ValueError(f"{len(values)} values for {self.axes} joints")
                return values
            asked = (self.ask(row.one, *first, joint) for joint in range(self.axes))
            return [shape.gather(fields) for fields in asked]
        except (TypeError, ValueError, LookupError, Refused) as error:
            raise RemoteProtocolError(
                f'"{self.remote}" returns no {row.member.replace("_", " ")}: {error}'
            ) from error

    def _write(
        self, row: Row, first: Sequence[Any], joints: Sequence[int], values: Sequence[Any] | None
    ) -> None:
        spread = [[]] * len(joints) if values is None else [*map(row.shape.spread, values)]
        lists = [] if values is None else [list(column) for column in zip(*spread, strict=True)]
        if row.all and [*joints] == [*range(self.axes)]:
            self.ask(row.all, *first, *lists)
        elif row.some and len(joints) > 1:
            self.ask(row.some, *first, [*joints], *lists)
        else:
            for joint, fields in zip(joints, spread, strict=True):
                if row.one == "setEncoderOne" and fields[0] != int(fields[0]):
                    raise LocalProtocolError(
                        f'"{self.remote}" of YARP 4 takes whole degrees for one encoder, not '
                        f"{fields[0]}: set all of them"
                    )
                given = map(int, fields) if row.one == "setEncoderOne" else fields
                self.ask(row.one, *first, joint, *given)

    # -- functions with a form of their own ---------------------------------------------------

    def version(self) -> tuple[int, ...]:
        """The version of the interface and of YARP."""
        return self._client.remote_version() or ()  # type: ignore[attr-defined]

    def count_axes(self) -> int:
        """The number of joints."""
        (found,) = self.ask("getAxes")
        if found < 1:
            raise RemoteProtocolError(f'"{self.remote}" does not say how many joints it has')
        self.axes = int(found)
        return self.axes

    def all_done(self) -> bool:
        """Return whether all joints have arrived."""
        return bool(self.ask("checkMotionDoneAll")[0])

    def calibrate_joint(self, joint: int, kind: int, parameters: Sequence[float]) -> None:
        """See ControlBoard."""
        if len(parameters) != 3:
            raise ValueError(f"in YARP 4 a calibration has 3 parameters, not {len(parameters)}")
        self.ask("calibrateAxisWithParams", joint, kind, *map(float, parameters))

    def calibration_done(self, joint: int) -> bool:
        """See ControlBoard."""
        try:
            self.ask("calibrationDone", joint)
        except LocalProtocolError:
            return False
        return True

    def calibrator(self, member: str, joints: Sequence[int]) -> None:
        """Calibrate, home, park, or abort doing so."""
        if not joints:
            self.ask(next(name for name, found in table.QUITTING.items() if found == member))
            return
        form = Form.ALL if [*joints] == [*range(self.axes)] else Form.ONE
        name = next(n for n, found in table.CALIBRATOR.items() if found == (member, form))
        for arguments in [[]] if form is Form.ALL else [[joint] for joint in joints]:
            waits = [True] if name == "parkSingleJoint" else []
            self.ask(name, *arguments, *waits, timeout=None)

    def variable(self, name: str) -> Any:
        """The value of a variable, as a list."""
        return self.ask("getRemoteVariable", name)[0]

    def store_variable(self, name: str, values: Sequence[Any]) -> None:
        """Set it."""
        self.ask("setRemoteVariable", name, Bottle(values))

    def variable_names(self) -> list[str]:
        """Return the names of the variables."""
        return [str(item) for found in self.ask("getRemoteVariablesList")[0] for item in found]

    def ask(self, name: str, *arguments: Any, timeout: float | None = TIMEOUT) -> list[Any]:
        """Call a function; what is behind the status of its result."""
        self._client.timeout = timeout  # type: ignore[attr-defined]
        try:
            found = getattr(self._client, f"{name}RPC")(*arguments)
        except Timeout as error:
            raise Timeout(f'"{self.remote}": {error}') from error
        status = found if isinstance(found, Status) else found.status
        code = str(status.code)
        if code != "ok":
            shown = ", ".join(map(str, arguments))
            raise LocalProtocolError(
                f'"{self.remote}" refuses {name}({shown[:80]}): {reason(code)}'
            )
        return [getattr(found, field) for field in found._attributes if found is not status][1:]


def _plain(number: Any) -> Any:
    """An element of an array as a number of Python."""
    return number.item() if hasattr(number, "dtype") else number


def _pid(kind: str) -> int:
    """The number of a kind of controllers."""
    return Vocab(f"{kind}1").code
