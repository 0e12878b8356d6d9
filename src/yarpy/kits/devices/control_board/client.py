"""ControlBoard: a remote control board, C++ or Python, used like a local one.

    with ControlBoard("/icub/head") as head:
        head.switch_control_modes(head.axis_names, "pos")
        head.position_move("neck_pitch", 10.0)
        head.wait_motion_done(timeout=5.0)
        print(head.encoders())

Rules: it has every member listed in `devices.control_board.interface`, so it is itself a
device and can be served again. Measurements come from the board's stateExt:o, streamed commands go
to its command:i, everything else is a request. Joints are given by index or name, one or several; a
single value applies to all of them.

A board of YARP 4 is asked at nws/rpc:i, in its functions, and is told commands in its words.

Source: remote_controlboard of YARP 3.x, protocol 1.9.0; controlBoard_nwc_yarp of 4.0.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import ExitStack, closing
from operator import index
from typing import Any, Final, TypeAlias

from yarpy.data.bottle import Bottle
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    RemoteProtocolError,
    Timeout,
)
from yarpy.kits.devices.adjustable import Adjustable
from yarpy.kits.devices.closeable import local_prefix, prefix
from yarpy.kits.devices.control_board import command, grammar
from yarpy.kits.devices.control_board.interface import MotorTorqueParameters
from yarpy.kits.devices.control_board.newer import NewerMembers, Second, Values, Which
from yarpy.kits.devices.control_board.remote_parts import Asks, RemotePids, RemoteVariables
from yarpy.kits.devices.control_board.requests import asks_of
from yarpy.kits.devices.control_board.state import State
from yarpy.kits.devices.latest_message import LatestMessage
from yarpy.names.base import NameClient
from yarpy.port.port import Port
from yarpy.wire.message import Encoded

Words: TypeAlias = str | Sequence[str]

_POLL: Final = 0.02


class ControlBoard(NewerMembers):
    """The control board whose ports begin with `remote`.

    local: prefix of the client's own ports; generated if empty.
    carrier: for commands and measurements, for example "udp", which C++ uses.
    timeout: measurements older than this many seconds are ignored.
    names: a name client, None for the default.
    Raises UnknownName, LinkClosed; RemoteProtocolError for another version of the protocol. Later,
    LocalProtocolError means that the board refuses a request, Timeout that it is silent.
    """

    def __init__(
        self,
        remote: str,
        local: str = "",
        *,
        carrier: str = "tcp",
        timeout: float = 0.5,
        names: NameClient | None = None,
    ) -> None:
        self.remote = remote = prefix(remote)
        local = local_prefix(local, remote)
        self._carrier = carrier
        with ExitStack() as resources:
            self._ask: Asks = resources.enter_context(closing(asks_of(remote, local, names)))
            self._command = resources.enter_context(
                Port(f"{local}/command:o", names=names, callback=lambda message: None)
            )
            self._command.connect(f"{remote}/command:i", carrier)
            self._latest = resources.enter_context(
                LatestMessage(
                    f"{remote}/stateExt:o",
                    f"{local}/stateExt:i",
                    carrier,
                    timeout,
                    names,
                    lambda message: State.from_bottle(message.as_(Bottle)),
                )
            )
            self._check_version()
            self._second = resources.enter_context(Second(self._ask, remote, local, names))
            self.axes = self._ask.count_axes()
            self._axis_names: list[str] = []
            self._resources = resources.pop_all()

    def _check_version(self) -> None:
        if self._ask.newer:
            return  # its functions are those of one version
        version = self._ask.version()
        if version[:2] != grammar.VERSION[:2]:
            spoken = ".".join(map(str, version)) or "none"
            wanted = ".".join(map(str, grammar.VERSION))
            raise RemoteProtocolError(
                f'"{self.remote}" speaks version {spoken} of the control board protocol, not '
                f"{wanted}: the other end must be YARP 2.3.70 to 3.12"
            )

    def __repr__(self) -> str:
        return f"<ControlBoard {self.remote}, {self.axes} joints>"

    # -- what is measured ---------------------------------------------------------------------

    def encoders(self) -> list[float]:
        """Return the positions of the joints, degrees."""
        return self._measured("encoders")

    def timestamps(self) -> list[float]:
        """Return the times when the encoders were read, seconds (of the board's clock)."""
        return [self._latest.time()] * self.axes

    def encoder_speeds(self) -> list[float]:
        """Return the speeds of the joints, deg/s."""
        return self._measured("encoder_speeds")

    def encoder_accelerations(self) -> list[float]:
        """Return the accelerations of the joints, deg/s^2."""
        return self._measured("encoder_accelerations")

    def motor_encoders(self) -> list[float]:
        """Return the positions of the motors, degrees."""
        return self._measured("motor_encoders")

    def motor_speeds(self) -> list[float]:
        """Return the speeds of the motors, deg/s."""
        return self._measured("motor_speeds")

    def motor_accelerations(self) -> list[float]:
        """Return the accelerations of the motors, deg/s^2."""
        return self._measured("motor_accelerations")

    def torques(self) -> list[float]:
        """Torque of each joint, Nm."""
        return self._measured("torques")

    def currents(self) -> list[float]:
        """Current of each motor, A."""
        return self._measured("currents")

    def duty_cycles(self) -> list[float]:
        """PWM of each motor, percent."""
        return self._measured("duty_cycles")

    def control_modes(self) -> list[str]:
        """The mode of each joint (`ControlMode`)."""
        return self._measured("control_modes")

    def interaction_modes(self) -> list[str]:
        """Stiff or compliant (`InteractionMode`)."""
        return self._measured("interaction_modes")

    def supply_voltages(self) -> list[float]:
        """Volts at each amplifier."""
        return self._ask.read("supply_voltages")

    def motor_temperatures(self) -> list[float]:
        """Temperature of each motor, degrees Celsius."""
        return self._ask.read("motor_temperatures")

    def amplifier_status(self) -> list[int]:
        """A number for each amplifier; its meaning depends on the robot."""
        return self._ask.read("amplifier_status")

    def faults(self) -> list[tuple[int, str]]:
        """The last fault of each joint: code and text."""
        return self._ask.read("faults")

    def motion_done(self) -> list[bool]:
        """Return for each joint whether it has arrived."""
        return self._ask.read("motion_done")

    def wait_motion_done(self, timeout: float | None = None) -> None:
        """Wait until all joints have arrived and `encoders` shows it. Raises Timeout after
        `timeout` seconds."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self._ask.all_done():
            if deadline is not None and time.monotonic() >= deadline:
                done = self.motion_done()
                late = [n for n, there in zip(self.axis_names, done, strict=True) if not there]
                raise Timeout(
                    f'"{self.remote}" is still moving after {timeout} s: {", ".join(late)}'
                )
            time.sleep(_POLL)
        self._latest.renew()

    # -- what acts ----------------------------------------------------------------------------

    def position_move(self, joints: Which, positions: Values) -> None:
        """Move to these positions (degrees) along a trajectory."""
        self._set("position_move", joints, positions)

    def relative_move(self, joints: Which, distances: Values) -> None:
        """Move by these angles, degrees."""
        self._set("relative_move", joints, distances)

    def position_direct(self, joints: Which, positions: Values) -> None:
        """Go directly to these positions (degrees). The joints must be in mode `posd`."""
        self._stream("position_direct", joints, positions)

    def velocity_move(self, joints: Which, speeds: Values) -> None:
        """Move at these speeds, deg/s. The joints must be in mode `vel`."""
        self._stream("velocity_move", joints, speeds)

    def apply_torques(self, joints: Which, torques: Values) -> None:
        """Make the joints exert these torques, Nm. The joints must be in mode `torq`."""
        self._stream("apply_torques", joints, torques)

    def apply_currents(self, joints: Which, currents: Values) -> None:
        """Drive the motors with these currents, A. The joints must be in mode `icur`."""
        self._stream("apply_currents", joints, currents)

    def apply_duty_cycles(self, joints: Which, duty_cycles: Values) -> None:
        """Drive the motors with these duty cycles, percent. The joints must be in mode `ipwm`."""
        self._stream("apply_duty_cycles", joints, duty_cycles)

    def stop(self, joints: Which | None = None) -> None:
        """Stop these joints, or all."""
        self._set("stop", joints)

    def switch_control_modes(self, joints: Which, modes: Words) -> None:
        """Change how joints are controlled: a `ControlMode`, or its word."""
        self._set("switch_control_modes", joints, modes)

    def switch_interaction_modes(self, joints: Which, modes: Words) -> None:
        """Make joints stiff or compliant: an `InteractionMode`, or its word."""
        self._set("switch_interaction_modes", joints, modes)

    def preset_encoders(self, joints: Which, positions: Values) -> None:
        """Reset the encoders: these are the positions (degrees) of the joints now."""
        self._set("preset_encoders", joints, positions)

    def preset_motor_encoders(self, joints: Which, positions: Values) -> None:
        """Reset the encoders: these are the positions (degrees) of the motors now."""
        self._set("preset_motor_encoders", joints, positions)

    def enable_amplifiers(self, joints: Which | None = None) -> None:
        """Power on: these joints, or all."""
        self._set("enable_amplifiers", joints)

    def disable_amplifiers(self, joints: Which | None = None) -> None:
        """Power off: these joints, or all."""
        self._set("disable_amplifiers", joints)

    def calibrate_joint(self, joint: int | str, kind: int, parameters: Sequence[float]) -> None:
        """Start calibrating a joint; `kind` and 3 or 4 parameters depend on the robot."""
        self._ask.calibrate_joint(self._joint(joint), kind, parameters)

    def calibration_done(self, joint: int | str) -> bool:
        """Return whether the calibration is finished."""
        return self._ask.calibration_done(self._joint(joint))

    def calibrate(self, joints: Which | None = None) -> None:
        """Calibrate these joints, or all, in the robot's own way. May take long."""
        self._ask.calibrator("calibrate", self._joints(joints))

    def home(self, joints: Which | None = None) -> None:
        """Move these joints, or all, to the home position. May take long."""
        self._ask.calibrator("home", self._joints(joints))

    def park(self, joints: Which | None = None) -> None:
        """Move these joints, or all, to where they can be switched off. May take long."""
        self._ask.calibrator("park", self._joints(joints))

    def quit_calibration(self) -> None:
        """Abort calibrating."""
        self._ask.calibrator("quit_calibration", ())

    def quit_parking(self) -> None:
        """Abort parking."""
        self._ask.calibrator("quit_parking", ())

    # -- what was commanded last --------------------------------------------------------------

    def position_targets(self) -> list[float]:
        """Targets of `position_move`, degrees."""
        return self._ask.read("position_targets")

    def direct_targets(self) -> list[float]:
        """The last `position_direct`, degrees."""
        return self._ask.read("direct_targets")

    def velocity_targets(self) -> list[float]:
        """The last `velocity_move`, deg/s."""
        return self._ask.read("velocity_targets")

    def torque_targets(self) -> list[float]:
        """The last `apply_torques`, Nm."""
        return self._ask.read("torque_targets")

    def current_targets(self) -> list[float]:
        """The last `apply_currents`, A."""
        return self._ask.read("current_targets")

    def duty_cycle_targets(self) -> list[float]:
        """The last `apply_duty_cycles`, percent."""
        return self._ask.read("duty_cycle_targets")

    # -- what is adjusted ---------------------------------------------------------------------

    @property
    def axis_names(self) -> list[str]:
        """The names of the joints."""
        if not self._axis_names:
            self._axis_names = self._ask.read("axis_names")
        return [*self._axis_names]

    @property
    def axis_types(self) -> list[str]:
        """The types of the joints: `revolute`, `prismatic` or `unknown`."""
        return self._ask.read("axis_types")

    reference_speeds = Adjustable[float]("deg/s, of position moves")
    reference_accelerations = Adjustable[float]("deg/s^2")
    position_limits = Adjustable[tuple[float, float]]("lowest and highest, degrees")
    velocity_limits = Adjustable[tuple[float, float]]("lowest and highest, deg/s")
    torque_ranges = Adjustable[tuple[float, float]]("lowest and highest, Nm")
    current_ranges = Adjustable[tuple[float, float]]("lowest and highest, A")
    max_currents = Adjustable[float]("A")
    nominal_currents = Adjustable[float]("A")
    peak_currents = Adjustable[float]("A")
    pwm_limits = Adjustable[float]("percent")
    temperature_limits = Adjustable[float]("degrees Celsius")
    gearbox_ratios = Adjustable[float]("")
    counts_per_revolution = Adjustable[float]("of motor encoders")
    motor_torque_parameters = Adjustable[MotorTorqueParameters]("", MotorTorqueParameters._make)
    impedances = Adjustable[tuple[float, float]]("stiffness Nm/deg, damping Nm s/deg")
    impedance_offsets = Adjustable[float]("Nm")
    impedance_ranges = Adjustable[tuple[float, float, float, float]]("see `impedances`")

    @property
    def pids(self) -> dict[str, RemotePids]:
        """Controllers by kind: `pos`, `vel`, `trq`, `cur`."""
        return {kind: RemotePids(self._ask, kind) for kind in ("pos", "vel", "trq", "cur")}

    @property
    def variables(self) -> RemoteVariables:
        """Further variables that the robot offers, by name, as a dict."""
        return RemoteVariables(self._ask)

    # -- within -------------------------------------------------------------------------------

    def _measured(self, field: str) -> list[Any]:
        found = self._latest.value().values.get(field)
        if found is None:
            raise LocalProtocolError(f'"{self.remote}" does not measure {field.replace("_", " ")}')
        return [*found]

    def _joints(self, which: Which | None) -> list[int]:
        if which is None:
            return [*range(self.axes)]
        one = isinstance(which, str) or not hasattr(which, "__len__")
        return [self._joint(joint) for joint in ([which] if one else which)]  # type: ignore

    def _joint(self, which: int | str) -> int:
        if not isinstance(which, str):
            joint = index(which)
            if 0 <= joint < self.axes:
                return joint
            raise IndexError(f'"{self.remote}" has joints 0 to {self.axes - 1}, not {joint}')
        if which in self.axis_names:
            return self.axis_names.index(which)
        known = ", ".join(self.axis_names)
        raise LookupError(f'"{self.remote}" has no joint "{which}", it has {known}')

    def _set(self, member: str, which: Which | None, values: Values | Words | None = None) -> None:
        joints = self._joints(which)
        self._ask.write(member, joints, None if values is None else _spread(values, len(joints)))

    def _stream(self, method: str, which: Which, values: Values) -> None:
        joints = self._joints(which)
        numbers = [float(value) for value in _spread(values, len(joints))]
        for bottle in command.make(method, joints, numbers, self.axes, self._ask.newer):
            message: object = bottle
            if self._ask.newer:
                message = Encoded(to_yarp4(bottle.to_bytes()))
            if not self._command.outputs:
                self._command.connect(f"{self.remote}/command:i", self._carrier)
            if not self._command.write(message):
                raise LinkClosed(f'"{self.remote}/command:i" is gone: is the robot running?')


def _spread(values: Any, count: int) -> list[Any]:
    """One value for each joint."""
    found = [*values] if hasattr(values, "__len__") and not isinstance(values, str) else None
    if found is None:
        return [values] * count
    if len(found) != count:
        raise ValueError(f"{len(found)} values for {count} joints")
    return found
