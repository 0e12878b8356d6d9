"""The functions of a control board of YARP 4: carries them out on a device.

    getEncoderAll()          a Numbers: [ok], and where the joints are
    positionMoveOne(1, 45)   a Status: [ok]
    positionMoveOne(9, 45)   [err5], which is logged with the reason; [err2] for what there is not

Rules: `table` says what each function means, those that mean something of their own are
here. One answer for every request: what cannot be done is a Status, with zeros behind it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any, ClassVar, Final

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.control_board.board import TARGETS, Board
from yarpy.kits.devices.control_board.grammar import Form
from yarpy.kits.devices.control_board.interface import Gains
from yarpy.kits.devices.control_board.yarp4 import table
from yarpy.kits.devices.control_board.yarp4.functions import ControlBoardMsgs
from yarpy.kits.devices.control_board.yarp4.table import Row
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.kind import FLOAT, number
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.status import FAILED, MISSING, OK
from yarpy.kits.thrift.service import YARP_4
from yarpy.log import logger

log = logger("yarpy.devices")

#: what makes a mode selectable
_MODES: Final = {
    "pos": "position_move", "posd": "position_direct", "vel": "velocity_move",
    "veld": "velocity_direct", "torq": "apply_torques", "ipwm": "apply_duty_cycles",
    "icur": "apply_currents",
}  # fmt: skip

Work = Callable[["Functions", Sequence[Any]], Sequence[Any]]
Act = Callable[["Functions", Access, Row, Form, Sequence[Any]], list[Any]]


class Missing(Refused):
    """The device lacks it."""


class Functions(ControlBoardMsgs):
    """Answers the functions with one board. Any thread may call."""

    _only_yarp4: ClassVar[bool] = True
    _yarp: ClassVar[tuple[int, int, int]] = YARP_4

    def __init__(self, board: Board) -> None:
        self._board = board

    def _does(self, name: str, work: Work, arguments: Sequence[Any]) -> Any:
        """The result of a function, whatever happens."""
        fields: Sequence[Any] = ()
        code = OK
        try:
            fields = work(self, arguments)
        except Refused as refusal:
            log.info("%s: %s: %s", self._board.name, name, refusal)
            code = MISSING if isinstance(refusal, Missing) else FAILED
        except Exception:
            log.exception("%s: %s", self._board.name, name)
            code = FAILED
        status = Status(code)
        result: Any = self._methods[f"{name}RPC"].result
        return status if result is Status else result(status, *fields)

    # -- rows of the tables -------------------------------------------------------------------

    def _read(self, part: Access, row: Row, form: Form, arguments: Sequence[Any]) -> list[Any]:
        board = self._board
        if part is board and not (board.has(row.member) or self._stands_in(row.member)):
            raise Missing(f"the device has no {row.member}")
        values = part.values(row.member, row.shape.kind)
        if form is Form.ONE:
            return row.shape.spread(values[self._joint(arguments[0])])
        if form is Form.SOME:
            values = [values[self._joint(joint)] for joint in arguments[0]]
        if row.shape is table.TRUTH:
            return [all(values)]
        columns = [row.shape.spread(value) for value in values]
        return [list(column) for column in zip(*columns, strict=True)]

    def _stands_in(self, member: str) -> bool:
        """Return whether something else is used where the device lacks a member."""
        return member == "axis_types" or self._board.has(TARGETS.get(member, ""))

    def _write(self, part: Access, row: Row, form: Form, arguments: Sequence[Any]) -> list[Any]:
        joints = [*range(self._board.count)]
        rest = arguments
        if form is not Form.ALL:
            joints = [
                int(joint) for joint in (arguments[0] if form is Form.SOME else arguments[:1])
            ]
            rest = arguments[1:]
        if part is self._board and not part.has(row.member) and row.member != "relative_move":
            raise Missing(f"the device has no {row.member}")
        if row.shape is table.NONE:
            part.apply(row.member, joints, None)
            return []
        fields = [rest] if form is Form.ONE else [[each] for each in rest[0]]
        if len(fields) != len(joints):
            raise Refused(f"{len(fields)} values for {len(joints)} joints")
        part.apply(row.member, joints, [row.shape.gather(each) for each in fields])
        return []

    def _joint(self, joint: Any) -> int:
        if not 0 <= joint < self._board.count:
            raise Refused(f"no joint {joint} (there are 0 to {self._board.count - 1})")
        return int(joint)

    def _pid(self, kind: int) -> Access:
        word = str.__str__(Vocab.from_code(kind))
        if not word.endswith("1"):  # the second and third controllers of a kind
            raise Missing(f"the device has no {word} controllers")
        return self._board.pid(word[:-1])

    # -- what has a form of its own -----------------------------------------------------------

    def _interfaces(self) -> dict[str, bool]:
        board = self._board
        return {name: board.offers(members) for name, members in table.INTERFACES.items()}

    def _timed(self, member: str, times: bool) -> tuple[list[float], list[float]]:
        values = self._board.values(member, FLOAT)
        stamps = self._board.timestamps() if times else [clock.now()] * len(values)
        return values, stamps

    def _motors(self, members: Iterable[str]) -> list[Any]:
        if not self._board.offers(members):
            raise Missing("the device has no data about its motors")
        return [self._board.count]

    def _modes(self, joint: int) -> list[Any]:
        self._joint(joint)
        words = [word for word, member in _MODES.items() if self._board.has(member)]
        if self._board.has("switch_control_modes"):
            words += ("idl", "fidl")
        return [[Vocab(word).code for word in words]]

    def _pids(self, joint: int) -> list[Any]:
        self._joint(joint)
        found = self._board.use("pids", lambda found: [f"{kind}1" for kind in found])
        return [[Vocab(word).code for word in found]]

    def _gain(self, kind: int, joint: int, name: str) -> list[Any]:
        gains = self._pid(kind).values("gains", table.GAINS_.kind)[self._joint(joint)]
        return [getattr(Gains(*gains), name)]

    def _set_gain(self, kind: int, joint: int, name: str, value: float) -> list[Any]:
        part = self._pid(kind)
        gains = Gains(*part.values("gains", table.GAINS_.kind)[self._joint(joint)])
        part.apply("gains", [joint], [gains._replace(**{name: number(value)})])
        return []

    def _enable(self, kind: int, joint: int, enabled: bool) -> list[Any]:
        self._pid(kind).apply("enabled", [self._joint(joint)], [enabled])
        return []

    def _preset(self, member: str, joints: Sequence[int]) -> list[Any]:
        self._board.apply(member, [*joints], [0.0] * len(joints))
        return []

    def _calibrate(self, name: str, arguments: Sequence[Any]) -> list[Any]:
        member, form = table.CALIBRATOR[name]
        if not self._board.has(member):
            raise Missing(f"the device has no {member}")
        joints = [*range(self._board.count)]
        if form is Form.ONE:
            joints = [self._joint(arguments[0])]
        self._board.apply(member, joints, None)
        return []

    def _calibrate_joint(self, joint: int, kind: int, *parameters: float) -> list[Any]:
        self._board.ask("calibrate_joint", self._joint(joint), kind, [*map(number, parameters)])
        return []

    def _calibration_done(self, joint: int) -> list[Any]:
        if not self._board.ask("calibration_done", self._joint(joint)):
            raise Refused(f"joint {joint} is not calibrated yet")
        return []

    def _variable(self, key: str) -> list[Any]:
        value = self._board.use("variables", lambda found: _known(found, key)[key])
        return [Bottle(value if isinstance(value, (list, tuple)) else [value])]

    def _set_variable(self, key: str, value: Any) -> list[Any]:
        self._board.use("variables", lambda found: _known(found, key).__setitem__(key, [*value]))
        return []

    def _variable_names(self) -> list[Any]:
        return [self._board.use("variables", lambda found: [Bottle([str(key)]) for key in found])]


def _known(found: Any, key: str) -> Any:
    if key not in found:
        raise Refused(f"no variable is called {key[:60]!r}")
    return found


def _works() -> dict[str, Work]:
    """Return what each function does, by its name."""
    works: dict[str, Work] = {}
    for rows, act in ((table.READ, Functions._read), (table.WRITE, Functions._write)):
        for row in rows:
            for name, form in row.words().items():
                works[name] = partial(_on_joints, act, row, form)
    for rows, act in ((table.PID_READ, Functions._read), (table.PID_WRITE, Functions._write)):
        for row in rows:
            for name, form in row.words().items():
                works[name] = partial(_on_controllers, act, row, form)
    for name in table.CALIBRATOR:
        works[name] = partial(_calibration, name)
    for name, member in table.QUITTING.items():
        works[name] = partial(_quitting, member)
    return works | _OWN


def _on_joints(act: Act, row: Row, form: Form, self: Functions, given: Sequence[Any]) -> list[Any]:
    return act(self, self._board, row, form, given)


def _on_controllers(
    act: Act, row: Row, form: Form, self: Functions, given: Sequence[Any]
) -> list[Any]:
    return act(self, self._pid(given[0]), row, form, given[1:])


def _calibration(name: str, self: Functions, given: Sequence[Any]) -> list[Any]:
    return self._calibrate(name, given)


def _quitting(member: str, self: Functions, given: Sequence[Any]) -> list[Any]:
    self._board.ask(member)
    return []


def _all(self: Functions) -> range:
    return range(self._board.count)


_OWN: Final[dict[str, Work]] = {
    "getAxes": lambda self, given: [self._board.count],
    "getDeviceInterfaces": lambda self, given: [self._interfaces()],
    "getNumberOfMotors": lambda self, given: self._motors(table.INTERFACES["iMotor"]),
    "getNumberOfMotorEncoders": (
        lambda self, given: self._motors(table.INTERFACES["iMotorEncoders"])
    ),
    "getEncoderTimedOne": lambda self, given: [
        column[self._joint(given[0])] for column in self._timed("encoders", True)
    ],
    "getEncoderTimedAll": lambda self, given: self._timed("encoders", True),
    "getMotorEncoderTimedOne": lambda self, given: [
        column[self._joint(given[0])] for column in self._timed("motor_encoders", False)
    ],
    "getMotorEncodersTimedAll": lambda self, given: self._timed("motor_encoders", False),
    "getAvailableControlModes": lambda self, given: self._modes(given[0]),
    "getAvailablePids": lambda self, given: self._pids(given[0]),
    "getPidOffset": lambda self, given: self._gain(given[0], given[1], "offset"),
    "getPidFeedforward": lambda self, given: self._gain(given[0], given[1], "feed_forward"),
    "setPidFeedforwardOne": (
        lambda self, given: self._set_gain(given[0], given[1], "feed_forward", given[2])
    ),
    "enablePid": lambda self, given: self._enable(given[0], given[1], True),
    "disablePid": lambda self, given: self._enable(given[0], given[1], False),
    "resetEncoderOne": lambda self, given: self._preset("preset_encoders", given),
    "resetEncoderAll": lambda self, given: self._preset("preset_encoders", _all(self)),
    "resetMotorEncoder": lambda self, given: self._preset("preset_motor_encoders", given),
    "resetMotorEncoders": lambda self, given: self._preset("preset_motor_encoders", _all(self)),
    "isCalibratorDevicePresent": lambda self, given: [self._board.has("calibrate")],
    "calibrateAxisWithParams": lambda self, given: self._calibrate_joint(*given),
    "calibrationDone": lambda self, given: self._calibration_done(given[0]),
    "getRemoteVariable": lambda self, given: self._variable(given[0]),
    "setRemoteVariable": lambda self, given: self._set_variable(*given),
    "getRemoteVariablesList": lambda self, given: self._variable_names(),
}


def _missing(self: Functions, given: Sequence[Any]) -> Sequence[Any]:
    raise Missing("no device here has this")


def _function(name: str, work: Work) -> Callable[..., Any]:
    def function(self: Functions, *arguments: Any) -> Any:
        return self._does(name, work, arguments)

    return function


def _complete() -> None:
    """Give Functions its functions."""
    works = _works()
    for name in ControlBoardMsgs._methods:
        work = works.get(name.removesuffix("RPC"), _missing)
        setattr(Functions, name, _function(name.removesuffix("RPC"), work))


_complete()
