"""Arrays, and dicts of them, as C++ reads them: the nearest type of YARP, else a described blob."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from support.cpp_program import CppProgram
from support.wait import HANG

import yarpy

SIDE = """
import ctypes
port = yarp.Port()
assert port.open('/cpp')
def read(what):
    assert port.read(what)
    return what
def back(bottle):
    port.write(bottle)
    return bottle.size()
def pixels(image):
    size = image.getRawImageSize()
    return ctypes.string_at(int(image.getRawImage()), size).hex()
"""


ARRAYS = [
    *(np.arange(5, dtype=kind) for kind in ("f8", "f4", "i8", "i4", "i2", "i1", "u1", "u2", "u8")),
    *(np.ones((3, 4), kind) for kind in ("f8", "f4", "i4", "i2", "u1", "?", "c8", "f2")),
    *(np.ones((3, 5, 3), kind) for kind in ("u1", "f4", "f8", "u4")),
    *(np.zeros((0, 3), "f4"), np.arange(9000, dtype="u4"), np.ones((2, 3, 4, 5), "f4")),
]


@pytest.mark.peer("cpp")
@pytest.mark.parametrize("array", ARRAYS, ids=lambda it: f"{it.dtype}{it.shape}")
def test_every_array_through_a_cpp_bottle(
    side: CppProgram, port: yarpy.Port, array: NDArray[Any]
) -> None:
    """C++ reads it as a Bottle, writes it again, and it is the array it was."""
    side.begin("back(read(yarp.Bottle()))")
    port.write(array)
    message = port.read(timeout=HANG)
    assert side.end()
    for found in (message.as_(np.ndarray), np.asarray(message.value)):
        assert found.dtype == array.dtype and found.shape == array.shape
        assert (found == array).all()


@pytest.mark.peer("cpp")
def test_nearest_types(side: CppProgram, port: yarpy.Port) -> None:
    for array, code in (
        (np.arange(3.0), "[v.get(i) for i in range(v.size())]"),
        (np.arange(3, dtype="i4"), "[v.get(i) for i in range(v.size())]"),
    ):
        side.begin(f"v = read(yarp.Vector{'Int' if array.dtype == 'i4' else ''}()); {code}")
        port.write(array)
        assert side.end() == [0, 1, 2]
    for kind, dtype in (("ImageFloat", "f4"), ("ImageInt", "i4"), ("ImageMono", "u1")):
        for shape in ((2, 3), (3, 32), (2, 101)):
            array = np.arange(shape[0] * shape[1]).reshape(shape).astype(dtype)
            side.begin(
                f"i = read(yarp.{kind}()); [i.height(), i.width(), i.getRowSize(), pixels(i)]"
            )
            port.write(array)
            height, width, row, raw = side.end()
            assert (height, width) == shape
            rows = np.frombuffer(bytes.fromhex(raw), "u1").reshape(height, row)
            assert rows[:, : width * array.itemsize].tobytes() == array.tobytes()


@pytest.mark.peer("cpp")
def test_a_blob_and_what_it_is(side: CppProgram, port: yarpy.Port) -> None:
    array = np.arange(6, dtype="u2")
    side.begin(
        "b = read(yarp.Bottle()); d = b.find('yarpy.type').asList()\n"
        "[b.get(0).isBlob(), b.get(0).asBlobLength(), d.get(0).asString(), d.get(1).asString(),"
        " d.get(2).asInt32()]"
    )
    port.write(array)
    assert side.end() == [True, 12, "array", "<u2", 6]


@dataclass
class Observation:
    rgb: NDArray[np.uint8]
    joints: NDArray[np.float64]
    mask: NDArray[np.bool_]
    task: str | None
    pose: tuple[float, dict[str, Any]]


def observation() -> Observation:
    return Observation(
        np.arange(4 * 8 * 3, dtype="u1").reshape(4, 8, 3),
        np.arange(7.0),
        np.ones((2, 3), bool),
        None,
        (1.5, {"frame": "map", "none": None}),
    )


def check(found: Observation) -> None:
    wanted = observation()
    for one, other in (
        (found.rgb, wanted.rgb),
        (found.joints, wanted.joints),
        (found.mask, wanted.mask),
    ):
        assert one.dtype == other.dtype and one.shape == other.shape and (one == other).all()
    assert (found.task, found.pose) == (wanted.task, wanted.pose)


@pytest.mark.peer("cpp")
def test_a_dataclass_is_a_property(side: CppProgram, port: yarpy.Port) -> None:
    side.begin(
        "b = read(yarp.Bottle())\n"
        "rgb, joints, mask = (b.find(k) for k in ('rgb', 'joints', 'mask'))\n"
        "port.write(b)\n"
        "[rgb.asList().get(0).toString(), joints.asList().get(6).asFloat64(), mask.isBlob(),"
        " b.find('pose').asList().get(1).asList().find('frame').asString(),"
        " b.find('yarpy.type').asList().find('mask').asList().toString()]"
    )
    port.write(observation())
    check(port.read(timeout=HANG).as_(Observation))
    assert side.end() == ["mat", 6.0, True, "map", 'array "|b1" 2 3']
    # As a Property, C++ makes a text of it and reads that; what text can say comes back.
    side.begin("p = read(yarp.Property()); port.write(p); p.check('yarpy.type')")
    port.write(observation())
    check(port.read(timeout=HANG).as_(Observation))
    assert side.end()


@pytest.mark.peer("cpp")
def test_a_property_of_cpp_as_a_dataclass(side: CppProgram, port: yarpy.Port) -> None:
    @dataclass
    class State:
        joints: NDArray[np.float64]
        speed: float
        name: str = ""
        more: int = 3

    side.begin(
        "p = yarp.Property(); p.fromString('(joints (0.5 1.5)) (speed 2) (name arm) (other x)')\n"
        "port.write(p)"
    )
    found = port.read(timeout=HANG).as_(State)
    assert side.end()
    assert found.joints.tolist() == [0.5, 1.5] and found.joints.dtype == "f8"
    assert (found.speed, found.name, found.more) == (2.0, "arm", 3) and type(found.speed) is float
