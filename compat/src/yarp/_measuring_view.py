"""Views that measure: IEncoders, IEncodersTimed, IMotorEncoders, IMotor, IAxisInfo ..."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._numbers import store
from yarp._view import View

_JOINT_TYPES = {"revolute": "revo", "prismatic": "pris"}


class IEncoders(View):
    """Where joints are, and how fast they move."""

    def getEncoder(self, j: int, v: Any = None) -> float:
        """The position of a joint; with a second argument, whether it was stored there."""
        return self._one("encoders", j) if v is None else self._get("encoders", (j, v))

    def getEncoders(self, encs: Any) -> bool:
        return self._get("encoders", (encs,))

    def getEncoderSpeed(self, j: int, sp: Any = None) -> float:
        if sp is None:
            return self._one("encoder_speeds", j)
        return self._get("encoder_speeds", (j, sp))

    def getEncoderSpeeds(self, spds: Any) -> bool:
        return self._get("encoder_speeds", (spds,))

    def getEncoderAcceleration(self, j: int, accs: Any = None) -> float:
        if accs is None:
            return self._one("encoder_accelerations", j)
        return self._get("encoder_accelerations", (j, accs))

    def getEncoderAccelerations(self, accs: Any) -> bool:
        return self._get("encoder_accelerations", (accs,))

    def resetEncoder(self, j: int) -> bool:
        return self._do("preset_encoders", (j, 0.0))

    def resetEncoders(self) -> bool:
        return self._do("preset_encoders", ([0.0] * self.getAxes(),))

    def setEncoder(self, j: int, val: float) -> bool:
        return self._do("preset_encoders", (j, val))

    def setEncoders(self, vals: Any) -> bool:
        return self._do("preset_encoders", (vals,))


class IEncodersTimed(IEncoders):
    """The same with times."""

    def getEncoderTimed(self, j: int, encs: Any, time: Any) -> bool:
        return self._get("encoders", (j, encs)) and self._get("timestamps", (j, time))

    def getEncodersTimed(self, encs: Any, time: Any) -> bool:
        return self._get("encoders", (encs,)) and self._get("timestamps", (time,))


class IMotorEncoders(View):
    """Where motors are, and how fast they turn."""

    def getNumberOfMotorEncoders(self, num: Any = None) -> int:
        return self.getAxes(num)

    def getMotorEncoder(self, m: int, v: Any = None) -> float:
        return self._one("motor_encoders", m) if v is None else self._get("motor_encoders", (m, v))

    def getMotorEncoders(self, encs: Any) -> bool:
        return self._get("motor_encoders", (encs,))

    def getMotorEncoderTimed(self, m: int, encs: Any, time: Any) -> bool:
        return self._get("motor_encoders", (m, encs)) and self._get("timestamps", (m, time))

    def getMotorEncodersTimed(self, encs: Any, time: Any) -> bool:
        return self._get("motor_encoders", (encs,)) and self._get("timestamps", (time,))

    def getMotorEncoderSpeed(self, m: int, sp: Any = None) -> float:
        return self._one("motor_speeds", m) if sp is None else self._get("motor_speeds", (m, sp))

    def getMotorEncoderSpeeds(self, spds: Any) -> bool:
        return self._get("motor_speeds", (spds,))

    def getMotorEncoderAcceleration(self, m: int, acc: Any) -> bool:
        return self._get("motor_accelerations", (m, acc))

    def getMotorEncoderAccelerations(self, accs: Any) -> bool:
        return self._get("motor_accelerations", (accs,))

    def getMotorEncoderCountsPerRevolution(self, m: int, cpr: Any) -> bool:
        return self._get("counts_per_revolution", (m, cpr))

    def setMotorEncoderCountsPerRevolution(self, m: int, cpr: float) -> bool:
        return self._change("counts_per_revolution", (m, cpr))

    def resetMotorEncoder(self, m: int) -> bool:
        return self._do("preset_motor_encoders", (m, 0.0))

    def resetMotorEncoders(self) -> bool:
        return self._do("preset_motor_encoders", ([0.0] * self.getAxes(),))

    def setMotorEncoder(self, m: int, val: float) -> bool:
        return self._do("preset_motor_encoders", (m, val))

    def setMotorEncoders(self, vals: Any) -> bool:
        return self._do("preset_motor_encoders", (vals,))


class IMotor(View):
    """Temperatures and gears."""

    def getNumberOfMotors(self, num: Any = None) -> int:
        return self.getAxes(num)

    def getTemperature(self, m: int, val: Any) -> bool:
        return self._get("motor_temperatures", (m, val))

    def getTemperatures(self, vals: Any) -> bool:
        return self._get("motor_temperatures", (vals,))

    def getTemperatureLimit(self, m: int, temp: Any) -> bool:
        return self._get("temperature_limits", (m, temp))

    def setTemperatureLimit(self, m: int, temp: float) -> bool:
        return self._change("temperature_limits", (m, temp))

    def getGearboxRatio(self, m: int, val: Any) -> bool:
        return self._get("gearbox_ratios", (m, val))

    def setGearboxRatio(self, m: int, val: float) -> bool:
        return self._change("gearbox_ratios", (m, val))


class IAmplifierControl(View):
    """Amplifiers, on and off, and their currents."""

    def enableAmp(self, j: int) -> bool:
        return self._tell(lambda: self._board.enable_amplifiers([j]))

    def disableAmp(self, j: int) -> bool:
        return self._tell(lambda: self._board.disable_amplifiers([j]))

    def getAmpStatus(self, *st: Any) -> bool:
        return self._get("amplifier_status", st)

    def getCurrent(self, j: int, val: Any) -> bool:
        return self._get("currents", (j, val))

    def getCurrents(self, vals: Any) -> bool:
        return self._get("currents", (vals,))

    def getMaxCurrent(self, j: int, v: Any) -> bool:
        return self._get("max_currents", (j, v))

    def setMaxCurrent(self, j: int, v: float) -> bool:
        return self._change("max_currents", (j, v))

    def getNominalCurrent(self, m: int, val: Any) -> bool:
        return self._get("nominal_currents", (m, val))

    def setNominalCurrent(self, m: int, val: float) -> bool:
        return self._change("nominal_currents", (m, val))

    def getPeakCurrent(self, m: int, val: Any) -> bool:
        return self._get("peak_currents", (m, val))

    def setPeakCurrent(self, m: int, val: float) -> bool:
        return self._change("peak_currents", (m, val))

    def getPWM(self, j: int, val: Any) -> bool:
        return self._get("duty_cycles", (j, val))

    def getPWMLimit(self, j: int, val: Any) -> bool:
        return self._get("pwm_limits", (j, val))

    def setPWMLimit(self, j: int, val: float) -> bool:
        return self._change("pwm_limits", (j, val))

    def getPowerSupplyVoltage(self, j: int, val: Any) -> bool:
        return self._get("supply_voltages", (j, val))


class IAxisInfo(View):
    """The names of joints, and how they move."""

    def getAxisName(self, axis: int) -> str:
        """The name of a joint, "" if there is none."""
        found: list[str] = [""]
        self._get("axis_names", (axis, found))
        return str(found[0])

    def getJointType(self, axis: int) -> int:
        """`VOCAB_JOINTTYPE_REVOLUTE` ..."""
        found: list[str] = [""]
        self._get("axis_types", (axis, found))
        return yarpy.Vocab(_JOINT_TYPES.get(str(found[0]), "unkn")).code


class IJointFault(View):
    """Faults of joints."""

    def getLastJointFault(self, j: int, fault: Any, message: Any) -> bool:
        """Store the code and the text of the last fault of a joint."""

        def read() -> None:
            if not 0 <= j < self.getAxes():
                raise IndexError(f"no joint {j} (there are 0 to {self.getAxes() - 1})")
            code, text = self._board.faults()[j]
            store(fault, [code])
            store(message, [text])

        return self._tell(read)


class IRemoteVariables(View):
    """Further variables of a robot."""

    def getRemoteVariable(self, key: str, val: Any) -> bool:
        def read() -> None:
            found = self._board.variables[key]
            val._native[:] = found if isinstance(found, list | tuple) else [found]

        return self._tell(read)

    def setRemoteVariable(self, key: str, val: Any) -> bool:
        def write() -> None:
            self._board.variables[key] = [*val._native]

        return self._tell(write)

    def getRemoteVariablesList(self, listOfKeys: Any) -> bool:
        def read() -> None:
            listOfKeys._native[:] = [*self._board.variables]

        return self._tell(read)
