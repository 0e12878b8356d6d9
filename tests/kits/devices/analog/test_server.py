"""A sensor with channels on ports, byte for byte as analogServer of YARP 3 has it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from struct import pack

import pytest
from support.wait import HANG

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.analog.server import AnalogSensorServer
from yarpy.nameserver.local import LocalNames


class Sensor:
    def __init__(self) -> None:
        self.done: list[object] = []

    def channels(self) -> list[float]:
        return [1.5, -2.0, 3.25]

    def calibrate(self, values: Sequence[float] | None) -> None:
        self.done.append(values)

    def calibrate_channel(self, channel: int, value: float | None) -> None:
        if channel > 2:
            raise ValueError("no such channel")
        self.done.append((channel, value))


@pytest.fixture
def sensor() -> Sensor:
    return Sensor()


@pytest.fixture
def server(sensor: Sensor, names: LocalNames) -> Iterator[AnalogSensorServer]:
    with AnalogSensorServer("/force", sensor, 0.01, names=names) as server:
        yield server


def first(names: LocalNames, source: str) -> yarpy.Message:
    with yarpy.BufferedPort(f"/me{source}", names=names) as port:
        port.listen_to(source)
        message = port.read(HANG)
        assert message is not None
        return message


#: tag of a list of float64, and how many
HEAD = pack("<ii", 256 + 10, 3)
NUMBERS = pack("<3d", 1.5, -2.0, 3.25)


def test_a_vector_with_its_time(server: AnalogSensorServer, names: LocalNames) -> None:
    message = first(names, "/force")
    assert bytes(message.payload) == HEAD + NUMBERS
    assert message.stamp is not None and message.stamp.time > 1e9


def test_readers_of_yarp_4_get_its_form(
    server: AnalogSensorServer, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("yarpy.port.port.MessagePort._is_yarp4", lambda port, target: True)
    found = bytes(first(names, "/force").payload)
    assert found != HEAD + NUMBERS and found.endswith(NUMBERS)


@pytest.mark.parametrize(
    ("asked", "heard"),
    [
        (["cal"], None),
        (["cal", 1.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
        (["cal", [1.0, 2.0, 3.0]], [1.0, 2.0, 3.0]),  # as C++ clients send it
        (["calc", 1], (1, None)),
        (["calc", 1, 0.5], (1, 0.5)),
    ],
)
def test_calibration(
    server: AnalogSensorServer,
    sensor: Sensor,
    names: LocalNames,
    asked: list[object],
    heard: object,
) -> None:
    with yarpy.RpcClient("/force/rpc:i", names=names) as client:
        asking = Bottle([Vocab("iana"), Vocab(asked[0]), *asked[1:]])
        assert client.call(asking, timeout=HANG) == [0]
    assert sensor.done == [heard]


@pytest.mark.parametrize(
    ("asked", "answer"),
    [
        (["iana", "calc"], [1]),
        (["iana", "calc", 1, 2.0, 3.0], [1]),
        (["iana", "calc", 7], [1]),
        (["iana", "cal", "much"], [1]),
        (["iana", "stop"], ["fail"]),
        (["set"], ["fail"]),
        ([], ["fail"]),
    ],
)
def test_what_it_cannot_do(
    server: AnalogSensorServer,
    sensor: Sensor,
    names: LocalNames,
    asked: list[object],
    answer: list[object],
) -> None:
    with yarpy.RpcClient("/force/rpc:i", names=names) as client:
        assert client.call(Bottle(asked), timeout=HANG) == answer
    assert not sensor.done


def test_parts_have_ports_of_their_own(names: LocalNames) -> None:
    parts = {"hand": range(2), "arm": range(2, 3), "foot": range(3, 9)}
    with AnalogSensorServer("/skin", Sensor(), 0.01, parts=parts, names=names):
        assert [*first(names, "/skin/hand").as_(yarpy.Vector).array] == [1.5, -2.0]
        assert [*first(names, "/skin/arm").as_(yarpy.Vector).array] == [3.25]
        assert names.query("/skin/foot/rpc:i") is not None
        assert names.query("/skin") is None


def test_what_has_no_channels_is_refused(names: LocalNames) -> None:
    with pytest.raises(ValueError, match=r"needs channels\(\)"):
        AnalogSensorServer("/x", object(), names=names)
    assert names.query("/x") is None
