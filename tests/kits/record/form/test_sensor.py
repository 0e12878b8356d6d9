"""What sensors send, as Foxglove's messages: each field by its number, and YARP's bytes again."""

import math
import struct

import numpy as np
import pytest
from support.recordings import payload_of

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.record.form import sensor
from yarpy.kits.record.form.form import Converted, restored
from yarpy.kits.record.form.protobuf import fields_of
from yarpy.kits.record.form.structure import Structure

SENT = 1_500_000_000


def read(found: Converted | None, payload: bytes) -> dict[int, bytes]:
    """The fields of bytes of a message, which must give the payload back."""
    assert found is not None
    data = memoryview(b"".join(found.parts(None)))
    parts, _ = restored(found.form.name, data, False)
    assert b"".join(parts) == payload
    fields = {number: bytes(one) for number, one in fields_of(data).items()}
    assert fields[1] == bytes.fromhex("08011080cab5ee01")  # 1.5 s, but for scans' and clouds' names
    return fields


@pytest.mark.parametrize(
    ("array", "code", "name"),
    [
        (np.arange(2 * 5 * 3, dtype="u1").reshape(2, 5, 3), "rgb", b"rgb8"),
        (np.arange(10, dtype="u1").reshape(2, 5), "mono", b"mono8"),
        (np.arange(10, dtype="u2").reshape(2, 5), "mo16", b"mono16"),
        (np.arange(10, dtype="f4").reshape(2, 5), "dec", b"32FC1"),
        (np.arange(10, dtype="u1").reshape(2, 5), "grbg", b"bayer_grbg8"),
    ],
)
def test_pictures(array: np.ndarray, code: str, name: bytes) -> None:
    """Rows of five pixels are padded; the step says so."""
    image = yarpy.Image(array, code)
    payload = payload_of(image)
    found = sensor.picture(payload, SENT, "/cam")
    fields = read(found, payload)
    assert (fields[4], fields[7]) == (name, b"/cam")
    assert fields[6] == payload[60:]
    assert found is not None and len(found.body) == len(payload) - 60  # uncopied
    sizes = struct.pack("<BIBI", 0x15, 5, 0x1D, 2)
    step = struct.pack("<BI", 0x2D, len(fields[6]) // 2)
    assert sizes in found.front and step in found.front


@pytest.mark.parametrize(
    "image",
    [
        yarpy.Image(np.zeros((2, 2, 3), "f4"), "rgb."),
        yarpy.Image(np.zeros((2, 2, 3), "u1"), top_down=False),
        yarpy.Image(np.zeros((0, 0), "u1")),
    ],
)
def test_pictures_that_stay_as_they_are(image: yarpy.Image) -> None:
    assert sensor.picture(payload_of(image), SENT, "") is None


def test_a_picture_that_something_follows() -> None:
    payload = payload_of(yarpy.Image(np.zeros((2, 8), "u1")))
    assert sensor.picture(payload + b"\0", SENT, "") is None
    assert sensor.picture(payload[:-1], SENT, "") is None


def test_points() -> None:
    cloud = yarpy.PointCloud(np.zeros(3, yarpy.PointCloud([[0, 0, 0]]).array.dtype), "xyz_rgba")
    payload = payload_of(cloud)
    found = sensor.cloud(payload, SENT, "/depth")
    assert found is not None
    data = memoryview(b"".join(found.parts(None)))
    assert b"".join(restored(found.form.name, data, False)[0]) == payload
    fields = fields_of(data)
    assert fields[2] == b"/depth" and len(fields[6]) == 3 * 32
    for name in (b"x", b"y", b"z", b"red", b"green", b"blue", b"alpha"):
        assert bytes((0x0A, len(name))) + name in found.front
    assert sensor.cloud(payload + b"\0", SENT, "") is None


@pytest.mark.parametrize("channels", [1, 2])
def test_sounds(channels: int) -> None:
    samples = np.arange(channels * 6, dtype="i2").reshape(channels, 6)
    payload = payload_of(yarpy.Sound(samples, 8000))
    found = sensor.sound(payload, SENT)
    fields = read(found, payload)
    assert fields[3] == b"pcm-s16"
    assert fields[2] == samples.T.tobytes()  # interleaved
    assert found is not None
    rates = struct.pack("<BIBI", 0x25, 8000, 0x2D, channels)
    assert rates in found.front


def numbers_of(payload: bytes) -> tuple[tuple, tuple]:
    structure = Structure(payload)
    values = structure.values(payload)
    assert values is not None
    return structure.outline, values


def test_a_laser() -> None:
    payload = payload_of([-90.0, 90.0, 0.1, 10.0, [1.0, 2.0, 3.0], 0])
    outline, values = numbers_of(payload)
    assert sensor.is_scan(outline)
    found = sensor.scan(values, payload, SENT, "/laser")
    fields = read(found, payload)
    assert fields[2] == b"/laser"
    assert struct.unpack("<3d", fields[6]) == (1, 2, 3)
    assert struct.pack("<Bd", 0x21, math.radians(-90)) in found.front
    assert not sensor.is_scan(numbers_of(payload_of([1, 2, 3, 4, [5.0], 6]))[0])


def test_joints() -> None:
    parts: list[object] = []
    for n in range(11):
        kind = int if n > 8 else float
        parts += [Bottle([kind(10 * n + 1), kind(10 * n + 2)]), Vocab("ok")]
    payload = payload_of(Bottle(parts))
    outline, values = numbers_of(payload)
    assert sensor.joints_of(outline) == 2
    found = sensor.joints(values, 2, payload, SENT)
    last = fields_of(memoryview(read(found, payload)[2]))
    assert bytes(last[1]) == b"joint_1"
    assert struct.pack("<Bd", 0x11, math.radians(2)) in found.front
    assert struct.pack("<Bd", 0x29, 62.0) in found.front  # the torque
    assert sensor.joints_of(numbers_of(payload_of([[1.0], [2.0]] * 11))[0]) == 0
