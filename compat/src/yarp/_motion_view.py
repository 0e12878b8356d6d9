"""Views that move joints: IPositionControl, IPositionDirect, IVelocityControl and others."""

from __future__ import annotations

from typing import Any

from yarp._numbers import store
from yarp._view import View
from yarpy.kits import devices


class _Referenced(View):
    """Speeds and accelerations of trajectories."""

    def setRefAcceleration(self, j: int, acc: float) -> bool:
        return self._change("reference_accelerations", (j, acc))

    def setRefAccelerations(self, *accs: Any) -> bool:
        return self._change("reference_accelerations", accs)

    def getRefAcceleration(self, j: int, acc: Any) -> bool:
        return self._get("reference_accelerations", (j, acc))

    def getRefAccelerations(self, *accs: Any) -> bool:
        return self._get("reference_accelerations", accs)

    def stop(self, *joints: Any) -> bool:
        """Stop all joints, one, or some."""
        return self._tell(lambda: self._board.stop(self._joints(joints)))

    setTrajAcceleration = setRefAcceleration
    setTrajAccelerations = setRefAccelerations
    getTrajAcceleration = getRefAcceleration
    getTrajAccelerations = getRefAccelerations


class IPositionControl(_Referenced):
    """Moves along trajectories."""

    def positionMove(self, *where: Any) -> bool:
        """Move all joints, one, or some to positions."""
        return self._do("position_move", where)

    def relativeMove(self, *delta: Any) -> bool:
        """Move all joints, one, or some by angles."""
        return self._do("relative_move", delta)

    def checkMotionDone(self, *arguments: Any) -> bool:
        """Return whether all have arrived; a BVector as the last argument is filled."""
        if not arguments:
            return self.isMotionDone()
        if len(arguments) == 1 and isinstance(arguments[0], int):
            return self.isMotionDone(arguments[0])
        return self._get("motion_done", arguments)

    def isMotionDone(self, i: int | None = None) -> bool:
        """Return whether one joint has arrived, or all."""
        done: list[bool] = []
        if not self._tell(lambda: done.extend(self._values("motion_done"))):
            return False
        return all(done) if i is None else bool(done[i])

    def setRefSpeed(self, j: int, sp: float) -> bool:
        return self._change("reference_speeds", (j, sp))

    def setRefSpeeds(self, *spds: Any) -> bool:
        return self._change("reference_speeds", spds)

    def getRefSpeed(self, j: int, ref: Any) -> bool:
        return self._get("reference_speeds", (j, ref))

    def getRefSpeeds(self, *spds: Any) -> bool:
        return self._get("reference_speeds", spds)

    def getTargetPosition(self, joint: int, ref: Any) -> bool:
        return self._get("position_targets", (joint, ref))

    def getTargetPositions(self, *refs: Any) -> bool:
        return self._get("position_targets", refs)

    setTrajSpeed = setRefSpeed
    setTrajSpeeds = setRefSpeeds
    getTrajSpeed = getRefSpeed
    getTrajSpeeds = getRefSpeeds


class IPositionDirect(View):
    """Goes directly to positions."""

    def setPosition(self, j: int, ref: float) -> bool:
        return self._do("position_direct", (j, ref))

    def setPositions(self, *refs: Any) -> bool:
        return self._do("position_direct", refs)

    def getRefPosition(self, joint: int, ref: Any) -> bool:
        return self._get("direct_targets", (joint, ref))

    def getRefPositions(self, *refs: Any) -> bool:
        return self._get("direct_targets", refs)


class IVelocityControl(_Referenced):
    """Moves at speeds."""

    def velocityMove(self, *sp: Any) -> bool:
        """Move all joints, one, or some."""
        return self._do("velocity_move", sp)

    def getRefVelocity(self, joint: int, vel: Any) -> bool:
        return self._get("velocity_targets", (joint, vel))

    def getRefVelocities(self, *vels: Any) -> bool:
        return self._get("velocity_targets", vels)

    getTargetVelocity = getRefVelocity
    getTargetVelocities = getRefVelocities


class MotorTorqueParameters:
    """How a motor produces torque."""

    #: in the order of the protocol
    NAMES = (
        *("bemf", "bemf_scale", "ktau", "ktau_scale", "viscousPos", "viscousNeg"),
        *("coulombPos", "coulombNeg", "velocityThres"),
    )

    def __init__(self) -> None:
        self.bemf = self.bemf_scale = self.ktau = self.ktau_scale = 0.0
        self.viscousPos = self.viscousNeg = self.coulombPos = self.coulombNeg = 0.0
        self.velocityThres = 0.0


class ITorqueControl(View):
    """Exerts torques."""

    def getTorque(self, j: int, t: Any) -> bool:
        return self._get("torques", (j, t))

    def getTorques(self, *t: Any) -> bool:
        return self._get("torques", t)

    def getRefTorque(self, j: int, t: Any) -> bool:
        return self._get("torque_targets", (j, t))

    def getRefTorques(self, *t: Any) -> bool:
        return self._get("torque_targets", t)

    def setRefTorque(self, j: int, t: float) -> bool:
        return self._do("apply_torques", (j, t))

    def setRefTorques(self, *t: Any) -> bool:
        return self._do("apply_torques", t)

    def getTorqueRange(self, j: int, min: Any, max: Any) -> bool:
        return self._get("torque_ranges", (j, min), 0) and self._get("torque_ranges", (j, max), 1)

    def getTorqueRanges(self, min: Any, max: Any) -> bool:
        return self._get("torque_ranges", (min,), 0) and self._get("torque_ranges", (max,), 1)

    def getMotorTorqueParams(self, j: int, params: MotorTorqueParameters) -> bool:
        """Store how a motor produces torque."""
        found: list[Any] = []
        if not self._get("motor_torque_parameters", (j, found)):
            return False
        for name, value in zip(MotorTorqueParameters.NAMES, found[0], strict=True):
            setattr(params, name, float(value))
        return True

    def setMotorTorqueParams(self, j: int, params: MotorTorqueParameters) -> bool:
        """Change how a motor produces torque."""
        values = [float(getattr(params, name)) for name in MotorTorqueParameters.NAMES]
        return self._change("motor_torque_parameters", (j, devices.MotorTorqueParameters(*values)))


class ICurrentControl(View):
    """Drives motors with currents."""

    def getNumberOfMotors(self, ax: Any = None) -> int:
        return self.getAxes(ax)

    def getCurrent(self, m: int, curr: Any) -> bool:
        return self._get("currents", (m, curr))

    def getCurrents(self, *currs: Any) -> bool:
        return self._get("currents", currs)

    def getCurrentRange(self, m: int, min: Any, max: Any) -> bool:
        return self._get("current_ranges", (m, min), 0) and self._get("current_ranges", (m, max), 1)

    def getCurrentRanges(self, min: Any, max: Any) -> bool:
        return self._get("current_ranges", (min,), 0) and self._get("current_ranges", (max,), 1)

    def getRefCurrent(self, m: int, curr: Any) -> bool:
        return self._get("current_targets", (m, curr))

    def getRefCurrents(self, *currs: Any) -> bool:
        return self._get("current_targets", currs)

    def setRefCurrent(self, m: int, curr: float) -> bool:
        return self._do("apply_currents", (m, curr))

    def setRefCurrents(self, *currs: Any) -> bool:
        return self._do("apply_currents", currs)


class IPWMControl(View):
    """Drives motors with duty cycles."""

    def getNumberOfMotors(self, number: Any = None) -> int:
        return self.getAxes(number)

    def getDutyCycle(self, m: int, val: Any) -> bool:
        return self._get("duty_cycles", (m, val))

    def getDutyCycles(self, *vals: Any) -> bool:
        return self._get("duty_cycles", vals)

    def getRefDutyCycle(self, m: int, ref: Any) -> bool:
        return self._get("duty_cycle_targets", (m, ref))

    def getRefDutyCycles(self, *refs: Any) -> bool:
        return self._get("duty_cycle_targets", refs)

    def setRefDutyCycle(self, m: int, ref: float) -> bool:
        return self._do("apply_duty_cycles", (m, ref))

    def setRefDutyCycles(self, *refs: Any) -> bool:
        return self._do("apply_duty_cycles", refs)


class IImpedanceControl(View):
    """How joints yield."""

    def getImpedance(self, j: int, stiffness: Any, damping: Any) -> bool:
        return self._get("impedances", (j, stiffness), 0) and self._get(
            "impedances", (j, damping), 1
        )

    def setImpedance(self, j: int, stiffness: float, damping: float) -> bool:
        return self._change("impedances", (j, (stiffness, damping)))

    def getImpedanceOffset(self, j: int, offset: Any) -> bool:
        return self._get("impedance_offsets", (j, offset))

    def setImpedanceOffset(self, j: int, offset: float) -> bool:
        return self._change("impedance_offsets", (j, offset))

    def getCurrentImpedanceLimit(self, j: int, *targets: Any) -> bool:
        """Lowest and highest stiffness, lowest and highest damping."""

        def fill() -> None:
            for target, value in zip(targets, self._values("impedance_ranges")[j], strict=True):
                store(target, [value])

        return self._tell(fill)
