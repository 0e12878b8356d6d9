"""The interfaces `I...Raw`: what drivers of boards have beneath the units of their users.

    raw = yarp.IEncodersRaw(driver.getImplementation())
    raw.getEncodersRaw(values)

Rules: devices of yarpy have one kind of units, so each method is that of the same name without Raw.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from yarp import _control_view as control
from yarp import _measuring_view as measuring
from yarp import _motion_view as motion
from yarp import _pid_view as pid
from yarp._view import View


class RawView:
    """The base of these views. `of`: the view whose methods it has."""

    _of: ClassVar[type[View]]

    def __init__(self, board: Any = None) -> None:
        self._view = self._of(board)

    def __init_subclass__(cls, of: type[View]) -> None:
        super().__init_subclass__()
        cls._of = of
        for name in dir(of):
            if name == "getAxes":  # which has the same name in both
                setattr(cls, name, _that_of(name))
            elif not name.startswith("_"):
                setattr(cls, f"{name}Raw", _that_of(name))


def _that_of(name: str) -> Callable[..., Any]:
    def method(self: RawView, *arguments: Any) -> Any:
        return getattr(self._view, name)(*arguments)

    method.__name__ = name
    method.__doc__ = f"The same as `{name}`."
    return method


class IAmplifierControlRaw(RawView, of=measuring.IAmplifierControl):
    """Amplifiers of motors."""


class IAxisInfoRaw(RawView, of=measuring.IAxisInfo):
    """Names and kinds of joints."""


class IControlLimitsRaw(RawView, of=control.IControlLimits):
    """How far and how fast joints may move."""


class IControlModeRaw(RawView, of=control.IControlMode):
    """How joints are controlled."""


class ICurrentControlRaw(RawView, of=motion.ICurrentControl):
    """Currents of motors."""


class IEncodersRaw(RawView, of=measuring.IEncoders):
    """Where joints are."""


class IEncodersTimedRaw(RawView, of=measuring.IEncodersTimed):
    """Where joints are, and since when."""


class IImpedanceControlRaw(RawView, of=motion.IImpedanceControl):
    """Stiffness and damping."""


class IInteractionModeRaw(RawView, of=control.IInteractionMode):
    """Stiffness of joints: stiff or compliant."""


class IJointFaultRaw(RawView, of=measuring.IJointFault):
    """Faults of joints."""


class IMotorEncodersRaw(RawView, of=measuring.IMotorEncoders):
    """Where motors are."""


class IMotorRaw(RawView, of=measuring.IMotor):
    """Temperatures and gears."""


class IPWMControlRaw(RawView, of=motion.IPWMControl):
    """Duty cycles of motors."""


class IPidControlRaw(RawView, of=pid.IPidControl):
    """Controllers of joints."""


class IPositionControlRaw(RawView, of=motion.IPositionControl):
    """Goes somewhere along a trajectory."""


class IPositionDirectRaw(RawView, of=motion.IPositionDirect):
    """Goes somewhere at once."""


class IRemoteVariablesRaw(RawView, of=measuring.IRemoteVariables):
    """Variables of the device."""


class ITorqueControlRaw(RawView, of=motion.ITorqueControl):
    """Exerts torques."""


class IVelocityControlRaw(RawView, of=motion.IVelocityControl):
    """Moves at a speed."""
