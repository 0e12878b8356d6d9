"""Views of a set of sensors, such as an inertial unit: IThreeAxisGyroscopes and its like.

Rules: sensors have numbers, in the order of the device. A measurement goes into a Vector, and the
result is when it was made; -1.0 if there is none. Units are those of `yarpy.devices`.
"""

from __future__ import annotations

from typing import Any, ClassVar

from yarp._log import say
from yarp._view import FAILURES, View

MAS_OK, MAS_ERROR, MAS_TIMEOUT = 0, 1, 3


class Sensors(View):
    """The questions to all of them. Subclasses give it the names of C++."""

    kind: ClassVar[str]

    def _readings(self) -> dict[str, Any]:
        """The values of each sensor by its name; {} if nothing comes."""
        try:
            return {**getattr(self._board, self.kind)()}
        except FAILURES as error:
            say("ERROR", f"|yarp.dev.{type(self).__name__}| {error}")
            return {}

    def _count(self) -> int:
        """How many there are."""
        return len(self._readings())

    def _name(self, sens_index: int) -> str:
        """Its name, "unknown" if there is none."""
        names = [*self._readings()]
        return names[sens_index] if 0 <= sens_index < len(names) else "unknown"

    def _frame(self, sens_index: int) -> str:
        """The name of its frame, "unknown" if there is none."""
        name = self._name(sens_index)
        frames: dict[str, str] = getattr(self._board, "frames", {})
        return frames.get(name, name)

    def _status(self, sens_index: int) -> int:
        """MAS_OK, or MAS_TIMEOUT while nothing comes, or MAS_ERROR: there is no such sensor."""
        found = self._readings()
        return MAS_TIMEOUT if not found else MAS_OK if 0 <= sens_index < len(found) else MAS_ERROR

    def _size(self, sens_index: int) -> int:
        """How many values it has."""
        rows = [*self._readings().values()]
        return len(_row(rows[sens_index])) if 0 <= sens_index < len(rows) else 0

    def _measure(self, sens_index: int, out: Any) -> float:
        """Store its values; when they were measured, in seconds, or -1.0."""
        found = self._readings()
        if not 0 <= sens_index < len(found):
            return -1.0
        name = [*found][sens_index]
        values = _row(found[name])
        out.resize(len(values))
        out._store(values)
        try:
            return float(self._board.timestamps()[name])
        except FAILURES:
            return 0.0


def _row(values: Any) -> list[float]:
    return [*values] if hasattr(values, "__iter__") else [values]


class IThreeAxisGyroscopes(Sensors):
    kind = "gyroscopes"
    getNrOfThreeAxisGyroscopes = Sensors._count
    getThreeAxisGyroscopeStatus = Sensors._status
    getThreeAxisGyroscopeName = Sensors._name
    getThreeAxisGyroscopeFrameName = Sensors._frame
    getThreeAxisGyroscopeMeasure = Sensors._measure


class IThreeAxisLinearAccelerometers(Sensors):
    kind = "accelerometers"
    getNrOfThreeAxisLinearAccelerometers = Sensors._count
    getThreeAxisLinearAccelerometerStatus = Sensors._status
    getThreeAxisLinearAccelerometerName = Sensors._name
    getThreeAxisLinearAccelerometerFrameName = Sensors._frame
    getThreeAxisLinearAccelerometerMeasure = Sensors._measure


class IThreeAxisMagnetometers(Sensors):
    kind = "magnetometers"
    getNrOfThreeAxisMagnetometers = Sensors._count
    getThreeAxisMagnetometerStatus = Sensors._status
    getThreeAxisMagnetometerName = Sensors._name
    getThreeAxisMagnetometerFrameName = Sensors._frame
    getThreeAxisMagnetometerMeasure = Sensors._measure


class IOrientationSensors(Sensors):
    kind = "orientations"
    getNrOfOrientationSensors = Sensors._count
    getOrientationSensorStatus = Sensors._status
    getOrientationSensorName = Sensors._name
    getOrientationSensorFrameName = Sensors._frame
    getOrientationSensorMeasureAsRollPitchYaw = Sensors._measure


class ITemperatureSensors(Sensors):
    kind = "thermometers"
    getNrOfTemperatureSensors = Sensors._count
    getTemperatureSensorStatus = Sensors._status
    getTemperatureSensorName = Sensors._name
    getTemperatureSensorFrameName = Sensors._frame
    getTemperatureSensorMeasure = Sensors._measure


class ISixAxisForceTorqueSensors(Sensors):
    kind = "force_torques"
    getNrOfSixAxisForceTorqueSensors = Sensors._count
    getSixAxisForceTorqueSensorStatus = Sensors._status
    getSixAxisForceTorqueSensorName = Sensors._name
    getSixAxisForceTorqueSensorFrameName = Sensors._frame
    getSixAxisForceTorqueSensorMeasure = Sensors._measure


class IPositionSensors(Sensors):
    kind = "position_sensors"
    getNrOfPositionSensors = Sensors._count
    getPositionSensorStatus = Sensors._status
    getPositionSensorName = Sensors._name
    getPositionSensorFrameName = Sensors._frame
    getPositionSensorMeasure = Sensors._measure


class IContactLoadCellArrays(Sensors):
    kind = "contact_loads"
    getNrOfContactLoadCellArrays = Sensors._count
    getContactLoadCellArrayStatus = Sensors._status
    getContactLoadCellArrayName = Sensors._name
    getContactLoadCellArraySize = Sensors._size
    getContactLoadCellArrayMeasure = Sensors._measure


class IEncoderArrays(Sensors):
    kind = "encoder_arrays"
    getNrOfEncoderArrays = Sensors._count
    getEncoderArrayStatus = Sensors._status
    getEncoderArrayName = Sensors._name
    getEncoderArraySize = Sensors._size
    getEncoderArrayMeasure = Sensors._measure


class ISkinPatches(Sensors):
    kind = "skin_patches"
    getNrOfSkinPatches = Sensors._count
    getSkinPatchStatus = Sensors._status
    getSkinPatchName = Sensors._name
    getSkinPatchSize = Sensors._size
    getSkinPatchMeasure = Sensors._measure


class IThreeAxisAngularAccelerometers(Sensors):
    kind = "angular_accelerations"
    getNrOfThreeAxisAngularAccelerometers = Sensors._count
    getThreeAxisAngularAccelerometerStatus = Sensors._status
    getThreeAxisAngularAccelerometerName = Sensors._name
    getThreeAxisAngularAccelerometerFrameName = Sensors._frame
    getThreeAxisAngularAccelerometerMeasure = Sensors._measure


class ILinearVelocitySensors(Sensors):
    kind = "linear_velocities"
    getNrOfLinearVelocitySensors = Sensors._count
    getLinearVelocitySensorStatus = Sensors._status
    getLinearVelocitySensorName = Sensors._name
    getLinearVelocitySensorFrameName = Sensors._frame
    getLinearVelocitySensorMeasure = Sensors._measure
