"""What the page is sent of clouds and sounds."""

import base64

import numpy as np
from support.recordings import START, payload_of

import yarpy
from yarpy.data.sig.pointcloud import KINDS
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.view.media import POINTS, SAMPLES, cloud, media_of, sound


def numbers(text: str, kind: str) -> list[float]:
    found: list[float] = np.frombuffer(base64.b64decode(text), kind).tolist()
    return found


def test_points() -> None:
    found = cloud(yarpy.PointCloud([[1.0, 2, 3], [4, np.nan, 6], [7, 8, 9]]))
    assert found.pop("of") == 3 and numbers(found.pop("xyz"), "<f4") == [1, 2, 3, 7, 8, 9]
    assert found == {}
    flat = cloud(yarpy.PointCloud([[1.0, 2]]))
    assert numbers(flat["xyz"], "<f4") == [1, 2, 0]


def test_colours() -> None:
    points = np.zeros((1, 2), KINDS["xyz_rgba"].dtype)
    points["x"], points["r"], points["g"], points["b"] = [1, 2], [10, 11], [20, 21], [30, 31]
    found = cloud(yarpy.PointCloud(points, kind="xyz_rgba"))
    assert numbers(found["rgb"], "u1") == [10, 20, 30, 11, 21, 31]


def test_many_points() -> None:
    found = cloud(yarpy.PointCloud(np.ones((3 * POINTS + 1, 3))))
    assert found["of"] == 3 * POINTS + 1
    assert POINTS / 2 < len(numbers(found["xyz"], "<f4")) / 3 <= POINTS


def test_sounds() -> None:
    found = sound(yarpy.Sound(np.array([[1, -2, 3], [4, 5, 6]], "i2"), 8000))
    assert numbers(found.pop("samples"), "<i2") == [1, -2, 3]
    assert found == {"rate": 8000, "channels": 2, "seconds": 3 / 8000}
    long = sound(yarpy.Sound(np.zeros((1, SAMPLES + 5), "i2"), 8000))
    assert len(numbers(long["samples"], "<i2")) == SAMPLES


def test_messages() -> None:
    for value, name in (
        (yarpy.PointCloud([[1.0, 2, 3]]), "cloud"),
        (yarpy.Sound(np.zeros((1, 3), "i2"), 8000), "sound"),
        (yarpy.Vector([1.0]), ""),
    ):
        recorded = Recorded("/a", START, START, "", payload_of(value))
        assert [*media_of(recorded, kind_of(recorded.payload))] == ([name] if name else [])
    broken = payload_of(yarpy.PointCloud([[1.0, 2, 3]]))[:-1]
    assert media_of(Recorded("/a", START, START, "", broken), "yarp/pointcloud") == {}
