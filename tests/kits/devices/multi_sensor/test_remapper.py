"""Sensors of several devices as one."""

from typing import Any

import pytest

import yarpy
from yarpy import Property
from yarpy.kits.devices import MultiSensorServer, SimulatedBattery, SimulatedImu
from yarpy.kits.devices.multi_sensor.interface import KINDS
from yarpy.kits.devices.multi_sensor.remapper import NAMES, RemappedSensors, Remapper


class Motors:
    frames = {"m1": "elbow"}

    def thermometers(self) -> dict[str, float]:
        return {"m1": 30.0, "m2": 35.0}

    def timestamps(self) -> dict[str, float]:
        return {"m1": 5.0, "m2": 6.0}


def imu(name: str) -> SimulatedImu:
    return SimulatedImu(name, f"{name}_frame", constant=True)


def test_what_is_named_in_that_order() -> None:
    mapper = Remapper(
        Property.from_text("(ThreeAxisGyroscopesNames (chest head)) (TemperatureSensorsNames (m2))")
    )
    with pytest.raises(ValueError, match="no sensors yet"):
        _ = mapper.served
    mapper.attach({"h": imu("head"), "c": imu("chest"), "m": Motors(), "b": SimulatedBattery()})
    sensors: Any = mapper.served
    assert sensors.kinds == ["gyroscopes", "thermometers"]
    assert [*sensors.gyroscopes()] == ["chest", "head"]
    assert sensors.thermometers() == {"m2": 35.0}
    assert not hasattr(sensors, "accelerometers")
    assert sensors.frames == {"head": "head_frame", "chest": "chest_frame", "m1": "elbow"}
    assert sensors.timestamps()["m2"] == 6.0
    mapper.detach()
    with pytest.raises(ValueError, match="no sensors yet"):
        _ = mapper.served


def test_without_names_it_has_all_and_is_served() -> None:
    mapper = Remapper(Property())
    mapper.attach({"h": imu("head"), "m": Motors()})
    served: Any = mapper.served
    assert served.kinds == [
        *("gyroscopes", "accelerometers", "magnetometers", "orientations", "thermometers")
    ]
    server = MultiSensorServer("/all", served, names=yarpy.LocalNames())
    server.close()
    assert "2 thermometers" in repr(server)


def test_what_cannot_be_mapped_is_refused() -> None:
    with pytest.raises(ValueError, match="none of these has any"):
        Remapper(Property()).attach({"b": SimulatedBattery()})
    with pytest.raises(ValueError, match='no device has a sensor "knee" among thermometers'):
        RemappedSensors([Motors()], {"thermometers": ["knee"]})
    with pytest.raises(ValueError, match='two devices have a sensor "head"'):
        RemappedSensors([imu("head"), imu("head")], {"gyroscopes": ["head"]})


def test_every_kind_has_a_parameter() -> None:
    assert {*NAMES.values()} == {*KINDS}
