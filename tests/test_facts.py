"""Facts of plug-ins: what a carrier leads to, where a plug-in is at home."""

from __future__ import annotations

import pytest

from yarpy.facts import BROKER, PORT, SERVER, SOCKET, TOPIC, CarrierRow, Reach, Row


@pytest.mark.parametrize(
    ("reach", "foreign", "nameless", "topic", "broker"),
    [
        (PORT, False, False, False, False),
        (SERVER, True, False, False, False),
        (SOCKET, True, True, False, False),
        (BROKER, True, True, False, True),
        (TOPIC, True, True, True, False),
        (Reach("broker", number=1883), True, True, False, True),
    ],
)
def test_what_is_at_the_other_end(
    reach: Reach, foreign: bool, nameless: bool, topic: bool, broker: bool
) -> None:
    found = (reach.foreign, reach.nameless, reach.topic, reach.broker)
    assert found == (foreign, nameless, topic, broker)


def test_home_is_a_ring_and_a_room() -> None:
    assert Row("tcp", "yarpy.carriers.own.tcp:Tcp").home == "core"
    assert Row("ros2", "yarpy.peers.ros2.carrier:Ros2").home == "peers.ros2"
    assert Row("sim", "yarpy.kits.sim.verbs.sim:command").home == "kits.sim"
    assert Row("other", "stranger:Other").home == ""


def test_advice_names_the_extra() -> None:
    assert Row("x", "yarpy.x:X", "zenoh").advice == 'pip install "yarpy[zenoh]"'
    assert Row("x", "yarpy.x:X").advice == "pip install yarpy"


def test_a_magic_with_a_mask_counts_some_bits_alone() -> None:
    row = CarrierRow("x", magic=(b"YA\x04\0\0\0RP",), mask=b"\xff\xff\x0f\0\0\0\xff\xff")
    assert row.may_begin(b"YA\xe4\x1e\0\0RP")
    assert not row.may_begin(b"YA\xe5\x1e\0\0RP")
    assert not row.may_begin(b"GARBAGE!")
    assert CarrierRow("x", magic=(b"GET /", b"PUT /")).may_begin(b"PUT /abc")
    assert not CarrierRow("x").may_begin(b"PUT /abc")
