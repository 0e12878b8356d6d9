"""MultipleAnalogSensorsMetadata: the service of Thrift by which C++ YARP asks a set of sensors.

    struct SensorMetadata { string sensorName, string frameName, string additionalMetadata }
    service MultipleAnalogSensorsMetadata { SensorRPCData getMetadata() }

SensorRPCData has a list of SensorMetadata for each kind of sensor, in their order: ten, or the
twelve of YARP 3.11 and later.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from yarpy.kits import thrift
from yarpy.kits.devices.multi_sensor.interface import KINDS, OLDER


class SensorMetadata(thrift.Struct):
    """The names of a sensor and of its frame."""

    sensorName: str = ""  # noqa: N815
    frameName: str = ""  # noqa: N815
    additionalMetadata: str = ""  # noqa: N815


Sensors = list[SensorMetadata]


class SensorRPCData(thrift.Struct):
    """The sensors of each kind."""

    gyroscopes: Sensors = thrift.new(list)
    accelerometers: Sensors = thrift.new(list)
    magnetometers: Sensors = thrift.new(list)
    orientations: Sensors = thrift.new(list)
    thermometers: Sensors = thrift.new(list)
    force_torques: Sensors = thrift.new(list)
    contact_loads: Sensors = thrift.new(list)
    encoder_arrays: Sensors = thrift.new(list)
    skin_patches: Sensors = thrift.new(list)
    position_sensors: Sensors = thrift.new(list)


class NewerSensorRPCData(SensorRPCData):
    """The same with the kinds of YARP 3.11."""

    linear_velocities: Sensors = thrift.new(list)
    angular_accelerations: Sensors = thrift.new(list)


class MultipleAnalogSensorsMetadata(thrift.Service):
    """The names of sensors, for programs before YARP 3.11."""

    def __init__(self, data: Any) -> None:
        self._data = data

    @thrift.method
    def getMetadata(self) -> SensorRPCData:  # noqa: N802
        """The sensors of each kind."""
        found: SensorRPCData = self._data
        return found


class NewerMetadata(MultipleAnalogSensorsMetadata):
    """The same for programs since."""

    @thrift.method
    def getMetadata(self) -> NewerSensorRPCData:  # noqa: N802
        """The sensors of each kind."""
        found: NewerSensorRPCData = self._data
        return found


def metadata(sensors: Mapping[str, Sensors], newer: bool) -> MultipleAnalogSensorsMetadata:
    """The service that tells of these sensors, by their kinds."""
    kinds = [*KINDS] if newer else [*KINDS][:OLDER]
    listed = {kind: sensors.get(kind, []) for kind in kinds}
    if newer:
        return NewerMetadata(NewerSensorRPCData(**listed))
    return MultipleAnalogSensorsMetadata(SensorRPCData(**listed))
