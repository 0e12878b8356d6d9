"""Packets of inertial units, as the makers' documents have them."""

from __future__ import annotations

import math
import struct

import pytest

from yarpy.kits.devices.hardware.imu_packet import GRAVITY, Split, euler, witmotion, xsens

# By WitMotion's formulas: 1 g upwards, -2000 to nearly 2000 degrees a second, angles of 90, -45, 0.
ACCELERATION = bytes.fromhex("55 51 0000 0000 0008 0c0a c4")
TURN = bytes.fromhex("55 52 0080 ff7f 0000 0000 a5")
ANGLE = bytes.fromhex("55 53 0040 00e0 0000 0000 c8")
FIELD = bytes.fromhex("55 54 0100 0200 0300 0000 af")
FRAMES = ACCELERATION + TURN + ANGLE + FIELD

# What an MTi-300 said, and what its maker's program read in it: temperature, and all else but GNSS.
SAID = bytes.fromhex(
    "1020 02 918d 1060 04 01363fa6 2010 10 3f35e0423f31cd15bd9f49dbbda938cf"
    "4020 0c bd635a90411d08d43e5faa50 4010 0c b91168003cc901003a0f7d00"
    "4030 0c bc3b29803c35fc003ca46e00 8020 0c 3caea241bb56d800bad5ac01"
    "8030 10 3f80000037df8801b6898000b608c000 c020 0c befbfbf23f33c485bfa0a2c1"
    "0810 04 42168000 3010 04 000186e1 e020 04 00400003"
)


def message(said: bytes, *, extended: bool = False) -> bytes:
    """A message MTData2."""
    length = b"\xff" + len(said).to_bytes(2, "big") if extended else bytes((len(said),))
    body = b"\xff\x36" + length + said
    return b"\xfa" + body + bytes((-sum(body) & 0xFF,))


def item(what: int, form: str, *numbers: float) -> bytes:
    return struct.pack(
        f">HB{len(numbers)}{form}", what, struct.calcsize(form) * len(numbers), *numbers
    )


def test_frames_of_witmotion() -> None:
    found, rest = witmotion(FRAMES)
    assert rest == b""
    assert dict(found) == {
        "accelerometers": (0.0, 0.0, GRAVITY),
        "gyroscopes": (-2000.0, 2000.0 * 32767 / 32768, 0.0),
        "orientations": (90.0, -45.0, 0.0),
    }


def test_messages_of_xsens() -> None:
    found, rest = xsens(message(SAID))
    assert rest == b""
    assert [kind for kind, _ in found] == [
        *("orientations", "accelerometers", "gyroscopes", "thermometers")
    ]
    said = dict(found)
    assert said["thermometers"] == (37.625,)
    assert said["accelerometers"] == pytest.approx((-0.05550629, 9.81465530, 0.21842313))
    radians = (0.02131760, -0.00327826, -0.00163019)
    assert said["gyroscopes"] == pytest.approx([math.degrees(one) for one in radians], rel=1e-5)
    assert said["orientations"] == euler(*struct.unpack_from(">4f", SAID, 15))
    lies = math.degrees(math.atan2(9.81465530, 0.21842313))
    assert said["orientations"][0] == pytest.approx(lies, abs=0.1), "as gravity says"


def test_other_forms_of_numbers() -> None:
    data = item(0x4023, "d", 1.0, 2.0, 3.0) + item(0x2034, "f", 10.0, 20.0, 30.0)
    strange = item(0x4021, "i", 1, 2, 3) + item(0x8020, "f", 1.0, 2.0) + item(0x0810, "f", 1.0)[:-1]
    found, _ = xsens(message(data + strange, extended=True))
    assert found == [("accelerometers", (1.0, 2.0, 3.0)), ("orientations", (10.0, 20.0, 30.0))]


def test_what_a_unit_of_xsens_answers_is_skipped() -> None:
    # GoToConfig as the manual has it, its answer, and a length that no message has.
    others = bytes.fromhex("faff3000d1 faff3100d0 faff36ffffff")
    found, rest = xsens(others + message(SAID) + b"\xfa")
    assert len(found) == 4
    assert rest == b"\xfa"


@pytest.mark.parametrize(
    ("split", "packet", "count"),
    [(witmotion, ACCELERATION, 1), (xsens, message(SAID), 4)],
    ids=["witmotion", "xsens"],
)
def test_packets_come_in_pieces_and_with_noise(split: Split, packet: bytes, count: int) -> None:
    broken = packet[:-1] + bytes((packet[-1] ^ 1,))
    rest, found = b"", []
    for one in packet[3:] + broken + packet + b"\x55\xfa" + packet:
        more, rest = split(rest + bytes((one,)))
        found += more
    assert len(found) == 2 * count


@pytest.mark.parametrize(
    ("quaternion", "angles"),
    [
        ((0.5**0.5, 0.5**0.5, 0.0, 0.0), (90.0, 0.0, 0.0)),
        ((0.75**0.5, 0.0, 0.5, 0.0), (0.0, 60.0, 0.0)),
        ((0.5**0.5, 0.0, 0.0, 0.5**0.5), (0.0, 0.0, 90.0)),
    ],
    ids=["roll", "pitch", "yaw"],
)
def test_angles(
    quaternion: tuple[float, float, float, float], angles: tuple[float, float, float]
) -> None:
    assert euler(*quaternion) == pytest.approx(angles, abs=1e-5)
