"""The service that names sensors: bytes as C++ writes them, for older and newer programs."""

from support.thrift import reply

from yarpy.data.bottle import Bottle
from yarpy.kits.devices.multi_sensor.interface import KINDS, NEWER, OLDER
from yarpy.kits.devices.multi_sensor.metadata import (
    NewerSensorRPCData,
    SensorMetadata,
    SensorRPCData,
    metadata,
)

SENSORS = {"accelerometers": [SensorMetadata("a", "f")]}


def test_fields_are_the_kinds_in_their_order():
    assert SensorRPCData._attributes == tuple(KINDS)[:OLDER]
    assert NewerSensorRPCData._attributes == tuple(KINDS) and len(KINDS) == NEWER


def test_answers():
    question = Bottle(["getMetadata"]).to_bytes()
    older = reply(metadata(SENSORS, newer=False), question)
    assert older[:16].hex(" ") == "00 01 00 00 0a 00 00 00 00 01 00 00 00 00 00 00"
    assert older[16:32].hex(" ") == "00 01 00 00 01 00 00 00 00 01 00 00 03 00 00 00"
    assert Bottle.from_bytes(older) == [[], [["a", "f", ""]], *[[]] * 8]
    newer = reply(metadata(SENSORS, newer=True), question)
    assert Bottle.from_bytes(newer) == [[], [["a", "f", ""]], *[[]] * 10]


def test_people():
    service = metadata(SENSORS, newer=False)
    assert reply(service, "getMetadata") == '() ((a f "")) () () () () () () () ()'
    assert "getMetadata" in reply(service, "help")
    assert reply(service, "getRemoteProtocolVersion") == "0 3 12 0"
