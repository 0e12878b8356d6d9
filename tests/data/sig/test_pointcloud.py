import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.vectors import rows

from yarpy.data import codec
from yarpy.data.sig.pointcloud import KINDS, PointCloud
from yarpy.errors import DecodeError, Truncated

(GOLDEN,) = (row for row in rows("types") if row["type"] == "pointcloud_xyz")
MESSAGE = bytes.fromhex(GOLDEN["binary"])


def joined(cloud):
    return b"".join(cloud.to_wire())


def test_golden():
    cloud = PointCloud.from_wire(MESSAGE)
    assert (cloud.kind, cloud.width, cloud.height, cloud.dense) == ("xyz", 2, 1, True)
    assert cloud.xyz.tolist() == [GOLDEN["params"]]
    assert joined(cloud) == MESSAGE == joined(PointCloud(GOLDEN["params"]))
    assert codec.decode_as(memoryview(MESSAGE), PointCloud) == cloud
    assert b"".join(codec.encode(cloud)) == MESSAGE
    assert codec.decode(MESSAGE) == cloud
    text = codec.encode_text(cloud)
    assert text.startswith(b"{2 0 0 0 1 0 0 0 ") and text.endswith(
        b"} (yarpy.type (pointcloud) 56)"
    )
    assert codec.decode_text(text) == cloud == codec.decode_text_as(text, PointCloud)
    for size in range(len(MESSAGE)):
        with pytest.raises(Truncated) as caught:
            PointCloud.from_wire(MESSAGE[:size])
        assert size < caught.value.need <= len(MESSAGE)


def test_captured_point():
    message = bytes.fromhex(
        "010000000100000002000000010a010000010000000000803f000000400000404000000000"
    )
    assert joined(PointCloud([[1, 2, 3]])) == message


@pytest.mark.parametrize(
    ("name", "code", "size"),
    [
        ("xy", 1, 8),
        ("xyz", 2, 16),
        ("normal", 33554528, 32),
        ("xyz_rgba", 33554438, 32),
        ("xyz_i", 10, 32),
        ("interest", 18, 32),
        ("xyz_normal", 33554530, 48),
        ("xyz_normal_rgba", 16777318, 48),
    ],
)
def test_kinds(name, code, size):
    kind = KINDS[name]
    assert (kind.code, kind.size, kind.dtype.itemsize) == (code, size, size)
    points = np.zeros((2, 3), kind.dtype)
    for index, field in enumerate(kind.dtype.names):
        points[field] = np.arange(6).reshape(2, 3) + index
    cloud = PointCloud(points, name, dense=False)
    message = joined(cloud)
    assert struct.unpack_from("<iiibii", message) == (3, 2, code, 0, 266, 6)
    assert len(message) == 21 + 6 * size
    again = PointCloud.from_wire(message)
    assert again == cloud and again.array.shape == (2, 3) and len(again) == 6
    assert repr(again) == f"PointCloud(3 x 2, {name!r})"


def test_layout_of_the_largest():
    kind = KINDS["xyz_normal_rgba"]
    point = np.zeros(1, kind.dtype)
    point["x"], point["normal_x"], point["b"], point["a"], point["curvature"] = 1, 2, 3, 4, 5
    raw = joined(PointCloud(point, kind.name))[21:]
    assert struct.unpack_from("<f", raw, 0) == (1,)
    assert struct.unpack_from("<f", raw, 16) == (2,)
    assert raw[32] == 3 and raw[35] == 4
    assert struct.unpack_from("<f", raw, 36) == (5,)


def test_conversion_copies_what_is_shared():
    colours = np.zeros((1, 2), KINDS["xyz_rgba"].dtype)
    colours["x"], colours["r"] = [[1, 2]], 9
    cloud = PointCloud(colours, "xyz_rgba")
    assert cloud.converted("xyz") == PointCloud([[1, 0, 0], [2, 0, 0]])
    full = cloud.converted("xyz_normal_rgba")
    assert full.array["r"].tolist() == [[9, 9]] and not full.array["normal_x"].any()
    assert cloud.converted("xy").array["x"].tolist() == [[1, 2]]


def test_shapes():
    assert PointCloud(np.zeros((4, 3))).array.shape == (1, 4)
    assert PointCloud(np.zeros((4, 2))).kind == "xy"
    cloud = PointCloud(np.arange(24).reshape(2, 4, 3))
    assert (cloud.height, cloud.width) == (2, 4)
    assert cloud.xyz.tolist() == np.arange(24.0).reshape(2, 4, 3).tolist()
    assert PointCloud(np.zeros((0, 3))).array.shape == (1, 0)
    assert PointCloud.from_wire(joined(PointCloud(np.zeros((0, 3))))) == PointCloud(
        np.zeros((0, 3))
    )


def test_memory():
    message = bytearray(MESSAGE)
    cloud = PointCloud.from_wire(message)
    cloud.xyz[0, 0, 2] = 7
    assert cloud.array["z"][0, 0] == 7 and message[29:33] == struct.pack("<f", 7)
    assert np.shares_memory(np.frombuffer(cloud.to_wire()[1], "u1"), np.frombuffer(message, "u1"))


def test_what_is_no_cloud():
    with pytest.raises(ValueError, match="no kind of points"):
        PointCloud([[1, 2, 3, 4]])
    with pytest.raises(ValueError, match="xyz_i"):
        PointCloud(np.zeros(3, KINDS["xyz"].dtype), "what")
    with pytest.raises(ValueError, match="3 numbers"):
        PointCloud([[1, 2]], "xyz")
    with pytest.raises(ValueError, match="in rows"):
        PointCloud(np.zeros((2, 2, 2, 3)))
    with pytest.raises(ValueError, match="no coordinates"):
        assert PointCloud([[1, 2]]).xyz
    assert PointCloud([[1, 2]]) != PointCloud([[1, 3]]) != "word"


@pytest.mark.parametrize("at", [0, 4, 8, 13, 17])
@pytest.mark.parametrize("word", [-1, 77, 0x7FFFFFFF])
def test_wrong_header(at, word):
    message = bytearray(MESSAGE)
    struct.pack_into("<i", message, at, word)
    with pytest.raises(DecodeError):
        PointCloud.from_wire(message)


@given(st.binary(min_size=15, max_size=30), st.integers(0, 21))
def test_mutated(noise, at):
    message = bytearray(MESSAGE)
    message[at : at + 4] = noise[:4]
    try:
        PointCloud.from_wire(message).array.copy()
    except DecodeError:
        pass


def test_memory_that_is_laid_out_as_on_the_wire() -> None:
    cloud = PointCloud([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    data = bytearray(cloud.to_wire()[1])
    again = PointCloud.over(memoryview(data), 2, 1, "xyz")
    assert again == cloud
    again.array["x"][0, 0] = 9
    assert data[:4] == b"\0\0\x10\x41"
    with pytest.raises(ValueError, match="take 48 bytes, not 32"):
        PointCloud.over(memoryview(data), 3, 1, "xyz")
