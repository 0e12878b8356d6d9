"""Every member of the interface, over the network; and what C++ 3.9.1 was recorded to send."""

import pytest
from support.interface import check_every_member
from support.wait import HANG

import yarpy
from yarpy.kits.devices.interfaces.joypad import (
    Hats,
    Joypad,
    Numbers,
    Point,
    Points,
    Touch,
    Touches,
)
from yarpy.nameserver.local import LocalNames

TEN, ELEVEN = "0000000000002440", "0000000000002640"
#: What ports of JoypadControlServer of 3.9.1 send of fakeJoypad, the first two of each.
RECORDED = [
    ("hat:o", Hats([0, 10]), "4001000002000000 000a"),
    ("axis:o", Numbers([0.0, 10.0]), f"0a01000002000000 {'00' * 8} {TEN}"),
    (
        "trackballs:o",
        Points([Point(), Point(10.0, 11.0)]),
        f"0a01000004000000 {'00' * 16} {TEN} {ELEVEN}",
    ),
    (
        "touch:o",
        Touches([Touch([Point()]), Touch([Point(10.0, 11.0)])]),
        f"0a01000004000000 {'00' * 16} {TEN} {ELEVEN}",
    ),
]


class Pad:
    def hats(self) -> Hats:
        return Hats([0, 10])

    def axes(self) -> Numbers:
        return Numbers([0.0, 10.0])

    def trackballs(self) -> Points:
        return Points([Point(), Point(10.0, 11.0)])

    def touches(self) -> Touches:
        return Touches([Touch(), Touch([Point(10.0, 11.0), Point(20.0, 21.0)])])


def test_joypad(names: LocalNames) -> None:
    check_every_member(Joypad, names)


@pytest.mark.parametrize(("port", "value", "data"), RECORDED, ids=[port for port, *_ in RECORDED])
def test_as_3_9_has_it(names: LocalNames, port: str, value: object, data: str) -> None:
    wire = bytes.fromhex(data)
    assert type(value).from_wire(memoryview(wire)) == value  # type: ignore[attr-defined]
    with (
        Joypad.serve("/pad", Pad(), 0.01, names=names),
        yarpy.BufferedPort("/reader", names=names) as reader,
    ):
        reader.listen_to(f"/pad/{port}")
        message = reader.read(HANG)
        assert message is not None and bytes(message.payload) == wire
