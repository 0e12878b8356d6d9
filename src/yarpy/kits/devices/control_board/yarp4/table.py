"""The functions of a control board of YARP 4: which member of the interface each one means.

    getEncoderOne(joint)                 -> encoders, of one joint
    positionMoveGroup(joints, values)    -> position_move, of several
    setPidErrorLimits(kind, values)      -> error_limits of controllers, of all joints

Rules: just tables, which server and client read from opposite sides, as they do `grammar` for YARP
3. A row has up to three functions: for one joint, for all, for several. Their names on the wire end
in RPC (`functions.thrift`). A Shape says over how many fields a value is spread, and how.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from yarpy.data.value import Vocab
from yarpy.kits.devices.control_board.grammar import (
    FIELDS_OF_TORQUE,
    GAINS,
    IMPEDANCE,
    IMPEDANCE_RANGE,
    Form,
    Words,
)
from yarpy.kits.devices.control_board.interface import Gains, MotorTorqueParameters
from yarpy.kits.devices.control_board.yarp4.functions import Pid, PidDetails, TorqueParameters
from yarpy.kits.devices.kind import (
    FAULT,
    FLAG,
    FLOAT,
    JOINT_TYPE,
    NOTHING,
    PAIR,
    TEXT,
    WHOLE,
    WORD,
    Kind,
    number,
)


class Shape:
    """One field. `kind`: what the value is in Python."""

    fields = 1

    def __init__(self, kind: Kind) -> None:
        self.kind = kind

    def spread(self, value: Any) -> list[Any]:
        """The fields of a value."""
        return [value]

    def gather(self, fields: Sequence[Any]) -> Any:
        """The value of the fields. Raises Refused for numbers that are not finite."""
        return self.kind.read([fields[0]])


class Plain(Shape):
    """A truth value or a string, which is the same on the wire."""

    def gather(self, fields: Sequence[Any]) -> Any:
        return self.kind.check(fields[0])


class Coded(Shape):
    """A word that travels as the number of its vocab."""

    def spread(self, value: Any) -> list[Any]:
        return [Vocab(value).code]

    def gather(self, fields: Sequence[Any]) -> Any:
        return str.__str__(Vocab.from_code(int(fields[0])))


class JointTypes(Shape):
    """Revolute, prismatic or unknown."""

    def spread(self, value: Any) -> list[Any]:
        return self.kind.write(value)

    def gather(self, fields: Sequence[Any]) -> Any:
        return self.kind.parse(fields)


class Several(Shape):
    """Some numbers, or whatever the kind consists of."""

    def __init__(self, kind: Kind, fields: int) -> None:
        super().__init__(kind)
        self.fields = fields

    def spread(self, value: Any) -> list[Any]:
        return [*value]

    def gather(self, fields: Sequence[Any]) -> Any:
        return self.kind.check(fields)


class Numbers(Several):
    """Numbers, which are finite."""

    def gather(self, fields: Sequence[Any]) -> Any:
        return tuple(number(field) for field in fields)


class GainsShape(Shape):
    """The gains of a controller, in another order than in YARP 3."""

    def spread(self, value: Any) -> list[Any]:
        return [Pid(**dict(zip(Gains._fields, map(float, value), strict=True)))]

    def gather(self, fields: Sequence[Any]) -> Any:
        return tuple(number(getattr(fields[0], name)) for name in Gains._fields)


class DetailsKind(Kind):
    """The description of a controller: texts by name."""

    def check(self, value: Any) -> Any:
        names = PidDetails._attributes
        unknown = sorted(set(value) - set(names))
        if unknown:
            raise ValueError(f"controllers are told {', '.join(names)}, not {unknown[0]}")
        return {name: str(value[name]) for name in names if name in value}


class DetailsShape(Shape):
    """The description of a controller."""

    def spread(self, value: Any) -> list[Any]:
        return [PidDetails(**value)]

    def gather(self, fields: Sequence[Any]) -> Any:
        return {name: str(getattr(fields[0], name)) for name in PidDetails._attributes}


class TorqueShape(Shape):
    """The parameters by which a motor produces torque, as one value."""

    def spread(self, value: Any) -> list[Any]:
        return [TorqueParameters(*map(float, value))]

    def gather(self, fields: Sequence[Any]) -> Any:
        names = MotorTorqueParameters._fields
        return tuple(number(getattr(fields[0], name)) for name in names)


VALUE: Final = Shape(FLOAT)
INTEGER: Final = Shape(WHOLE)
TRUTH: Final = Plain(FLAG)
NAME: Final = Plain(TEXT)
MODE: Final = Coded(WORD)
JOINT: Final = JointTypes(JOINT_TYPE)
RANGE: Final = Numbers(PAIR, 2)
STIFFNESS: Final = Numbers(IMPEDANCE, 2)
STIFFNESS_RANGE: Final = Numbers(IMPEDANCE_RANGE, 4)
FAULTS: Final = Several(FAULT, 2)
TORQUE: Final = TorqueShape(FIELDS_OF_TORQUE)
GAINS_: Final = GainsShape(GAINS)
DETAILS: Final = DetailsShape(DetailsKind())
NONE: Final = Shape(NOTHING)


@dataclass(frozen=True, slots=True)
class Row(Words):
    """The functions for one member of the interface, and the shape of its values."""

    shape: Shape = VALUE


def _row(stem: str, member: str, shape: Shape = VALUE, some: bool = False, s: str = "") -> Row:
    group = f"{stem}{s}Group" if some else ""
    return Row(f"{stem}One", f"{stem}{s}All", group, member, shape)


READ: Final[tuple[Row, ...]] = (
    Row("getAxisName", "", "", "axis_names", NAME),
    Row("getJointType", "", "", "axis_types", JOINT),
    # commanded
    _row("getTargetPosition", "position_targets", some=True),
    _row("getTargetVelocity", "velocity_targets", some=True),
    _row("getRefPosition", "direct_targets", some=True),
    _row("getRefVelocity", "direct_velocity_targets", some=True),
    _row("getRefTorque", "torque_targets", some=True),
    _row("getRefCurrent", "current_targets"),
    _row("getRefDutyCycle", "duty_cycle_targets"),
    _row("getTrajSpeed", "reference_speeds", some=True, s="s"),
    _row("getTrajAcceleration", "reference_accelerations", some=True),
    _row("checkMotionDone", "motion_done", TRUTH, some=True),
    # measured
    _row("getEncoder", "encoders"),
    _row("getEncoderSpeed", "encoder_speeds"),
    _row("getEncoderAcceleration", "encoder_accelerations"),
    _row("getMotorEncoder", "motor_encoders"),
    _row("getMotorEncoderSpeed", "motor_speeds"),
    _row("getMotorEncoderAcceleration", "motor_accelerations"),
    _row("getCurrent", "currents"),
    _row("getDutyCycle", "duty_cycles"),
    _row("getTemperature", "motor_temperatures"),
    Row("getPWM", "", "", "duty_cycles"),
    Row("getPowerSupplyVoltage", "", "", "supply_voltages"),
    _row("getAmpStatus", "amplifier_status", INTEGER),
    _row("getInteractionMode", "interaction_modes", MODE, some=True, s="s"),
    Row("getLastJointFault", "", "", "faults", FAULTS),
    Row("isJointBraked", "", "", "braked", TRUTH),
    # adjusted
    _row("getCurrentRange", "current_ranges", RANGE),
    _row("getTorqueRange", "torque_ranges", RANGE),
    Row("getPosLimits", "", "", "position_limits", RANGE),
    Row("getVelLimits", "", "", "velocity_limits", RANGE),
    Row("getImpedance", "", "", "impedances", STIFFNESS),
    Row("getImpedanceOffset", "", "", "impedance_offsets"),
    Row("getCurrentImpedanceLimit", "", "", "impedance_ranges", STIFFNESS_RANGE),
    Row("getNominalCurrent", "", "", "nominal_currents"),
    Row("getPeakCurrent", "", "", "peak_currents"),
    Row("getMaxCurrent", "", "", "max_currents"),
    Row("getPWMLimit", "", "", "pwm_limits"),
    Row("getGearboxRatio", "", "", "gearbox_ratios"),
    Row("getTemperatureLimit", "", "", "temperature_limits"),
    Row("getMotorEncoderCountsPerRevolution", "", "", "counts_per_revolution"),
    Row("getMotorTorqueParams", "", "", "motor_torque_parameters", TORQUE),
    Row("getAutoBrakeEnabled", "", "", "automatic_brakes", TRUTH),
)

WRITE: Final[tuple[Row, ...]] = (
    _row("positionMove", "position_move", some=True),
    _row("relativeMove", "relative_move", some=True),
    _row("velocityMove", "velocity_move", some=True),
    _row("setRefPosition", "position_direct", some=True),
    _row("setRefVelocity", "velocity_direct", some=True),
    _row("setRefTorque", "apply_torques", some=True),
    _row("setRefCurrent", "apply_currents", some=True),
    _row("setRefDutyCycle", "apply_duty_cycles", some=True),
    _row("setTrajSpeed", "reference_speeds", some=True),
    _row("setTrajAcceleration", "reference_accelerations", some=True, s="s"),
    _row("stop", "stop", NONE, some=True),
    _row("setControlMode", "switch_control_modes", MODE, some=True),
    _row("setInteractionMode", "switch_interaction_modes", MODE, some=True, s="s"),
    _row("setEncoder", "preset_encoders"),
    Row("setMotorEncoder", "setMotorEncodersAll", "", "preset_motor_encoders"),
    Row("enableAmp", "", "", "enable_amplifiers", NONE),
    Row("disableAmp", "", "", "disable_amplifiers", NONE),
    Row("setPosLimits", "", "", "position_limits", RANGE),
    Row("setVelLimits", "", "", "velocity_limits", RANGE),
    Row("setImpedance", "", "", "impedances", STIFFNESS),
    Row("setImpedanceOffset", "", "", "impedance_offsets"),
    Row("setNominalCurrent", "", "", "nominal_currents"),
    Row("setPeakCurrent", "", "", "peak_currents"),
    Row("setMaxCurrent", "", "", "max_currents"),
    Row("setPWMLimit", "", "", "pwm_limits"),
    Row("setGearboxRatio", "", "", "gearbox_ratios"),
    Row("setTemperatureLimit", "", "", "temperature_limits"),
    Row("setMotorEncoderCountsPerRevolution", "", "", "counts_per_revolution"),
    Row("setMotorTorqueParams", "", "", "motor_torque_parameters", TORQUE),
    Row("setManualBrakeActive", "", "", "apply_brakes", TRUTH),
    Row("setAutoBrakeEnabled", "", "", "automatic_brakes", TRUTH),
)

#: functions whose first argument is a kind of controllers
PID_READ: Final[tuple[Row, ...]] = (
    Row("getPid", "getPids", "", "gains", GAINS_),
    Row("getPidExtraInfo", "getPidExtraInfos", "", "details", DETAILS),
    Row("getPidReference", "getPidReferences", "", "targets"),
    Row("getPidErrorLimit", "getPidErrorLimits", "", "error_limits"),
    Row("getPidError", "getPidErrors", "", "errors"),
    Row("getPidOutput", "getPidOutputs", "", "outputs"),
    Row("isPidEnabled", "", "", "enabled", TRUTH),
)
PID_WRITE: Final[tuple[Row, ...]] = (
    Row("setPid", "setPids", "", "gains", GAINS_),
    Row("setPidReference", "setPidReferences", "", "targets"),
    Row("setPidErrorLimit", "setPidErrorLimits", "", "error_limits"),
    Row("setPidOffsetOne", "", "", "offsets"),
    Row("resetPid", "", "", "reset", NONE),
)

#: function -> what the calibrator does, for how many joints
CALIBRATOR: Final = {
    "calibrateSingleJoint": ("calibrate", Form.ONE),
    "calibrateWholePart": ("calibrate", Form.ALL),
    "calibrateRobot": ("calibrate", Form.ALL),
    "homingSingleJoint": ("home", Form.ONE),
    "homingWholePart": ("home", Form.ALL),
    "parkSingleJoint": ("park", Form.ONE),
    "parkWholePart": ("park", Form.ALL),
    "park": ("park", Form.ALL),
}
QUITTING: Final = {
    "quitCalibrate": "quit_calibration",
    "abortCalibration": "quit_calibration",
    "quitPark": "quit_parking",
    "abortPark": "quit_parking",
}

#: what programs of C++ ask for an interface by -> the members of which a device needs one
INTERFACES: Final = {
    "iAmplifierControl": ("enable_amplifiers", "currents", "max_currents", "amplifier_status"),
    "iAxisInfo": ("axis_names",),
    "iControlCalibration": ("calibrate_joint", "calibration_done"),
    "iControlLimits": ("position_limits", "velocity_limits"),
    "iControlMode": ("control_modes", "switch_control_modes"),
    "iCurrentControl": ("current_targets", "apply_currents", "current_ranges"),
    "iEncodersTimed": ("encoders",),
    "iImpedanceControl": ("impedances", "impedance_offsets"),
    "iInteractionMode": ("interaction_modes", "switch_interaction_modes"),
    "iJointBrake": ("braked", "apply_brakes", "automatic_brakes"),
    "iJointFault": ("faults",),
    "iMotor": ("motor_temperatures", "temperature_limits", "gearbox_ratios"),
    "iMotorEncoders": ("motor_encoders", "motor_speeds", "counts_per_revolution"),
    "iPidControl": ("pids",),
    "iPositionControl": ("position_move", "position_targets"),
    "iPositionDirect": ("position_direct", "direct_targets"),
    "iPreciselyTimed": ("timestamps",),
    "iPWMControl": ("apply_duty_cycles", "duty_cycle_targets"),
    "iPwmControl": ("apply_duty_cycles", "duty_cycle_targets"),  # so the clients of 4.0.0 ask
    "iRemoteCalibrator": ("calibrate", "home", "park"),
    "iRemoteVariables": ("variables",),
    "iTorqueControl": ("torques", "torque_targets", "apply_torques"),
    "iVelocityControl": ("velocity_move", "velocity_targets"),
    "iVelocityDirect": ("velocity_direct", "direct_velocity_targets"),
}
