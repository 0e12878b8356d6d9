"""Point clouds to sensor_msgs and back: every kind, fields elsewhere, no copies, lies."""

from typing import Any

import numpy as np
import pytest
from support import ros

from yarpy.data.sig.pointcloud import KINDS, PointCloud
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.convert import cloud
from yarpy.peers.ros.message.library import Library


def points(kind: str, height: int = 2, width: int = 3) -> PointCloud:
    dtype = KINDS[kind].dtype
    array = np.zeros((height, width), dtype)
    for at, name in enumerate(dtype.names or ()):
        array[name] = np.arange(height * width).reshape(height, width) + 10 * at
    return PointCloud(array, kind, dense=False)


def message(library: Library, made: PointCloud) -> Any:
    header = library.message("std_msgs/Header")()
    return cloud.cloud_message(made, library.message("sensor_msgs/PointCloud2"), header)


def described(library: Library, fields: list[tuple[str, int, int]], **others: Any) -> Any:
    """A message with fields of these names, offsets and datatypes."""
    field = library.message("sensor_msgs/PointField")
    made = [field(name, offset, datatype, 1) for name, offset, datatype in fields]
    return library.message("sensor_msgs/PointCloud2")(fields=made, **others)


XYZ = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7)]


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_comes_back(library: Library, kind: str) -> None:
    made = points(kind)
    sent = message(library, made)
    again = cloud.cloud_of(type(sent).from_ros(b"".join(sent.to_ros())))
    assert again.kind == kind
    assert again == made


def test_points_are_not_copied_either_way(library: Library) -> None:
    made = points("xyz_rgba", 30, 30)
    sent = message(library, made)
    blocks = sent.to_ros()
    memory = np.frombuffer(made.to_wire()[1], "u1")
    assert any(np.shares_memory(np.frombuffer(block, "u1"), memory) for block in blocks)
    data = b"".join(blocks)
    again = cloud.cloud_of(type(sent).from_ros(data))
    assert np.shares_memory(again.array, np.frombuffer(data, "u1"))


def test_fields_are_picked_out(library: Library) -> None:
    """As a laser scanner sends them: packed, doubles, a ring number, rows with padding."""
    dtype = np.dtype(
        {
            "names": ["x", "y", "z", "intensity", "ring"],
            "formats": ["<f8", "<f8", "<f8", "<f4", "<u2"],
            "itemsize": 30,
        }
    )
    rows = np.zeros((2, 100), "u1")
    array: Any = np.ndarray((2, 3), dtype, rows.data, 0, (100, 30))
    array["x"] = [[1, 2, 3], [4, 5, 6]]
    array["intensity"] = 0.5
    fields = [("x", 0, 8), ("y", 8, 8), ("z", 16, 8), ("intensity", 24, 7), ("ring", 28, 4)]
    found = cloud.cloud_of(
        described(
            library,
            fields,
            height=2,
            width=3,
            point_step=30,
            row_step=100,
            data=rows.ravel(),
            is_dense=True,
        )
    )
    assert (found.kind, found.dense) == ("xyz_i", True)
    assert found.xyz[..., 0].tolist() == [[1, 2, 3], [4, 5, 6]]
    assert found.array["intensity"].tolist() == [[0.5] * 3] * 2


def test_colours_of_either_name_and_order(library: Library) -> None:
    data = np.array([1, 2, 3], "<f4").tobytes() + b"BGRA"
    made = described(
        library, [*XYZ, ("rgb", 12, 7)], height=1, width=1, point_step=16, row_step=16, data=data
    )
    found = cloud.cloud_of(made)
    assert found.kind == "xyz_rgba"
    assert [chr(found.array[name][0, 0]) for name in "bgra"] == [*"BGRA"]
    made.data = np.array([1, 2, 3], ">f4").tobytes() + b"ARGB"
    made.is_bigendian = True
    found = cloud.cloud_of(made)
    assert found.xyz.ravel().tolist() == [1, 2, 3]
    assert [chr(found.array[name][0, 0]) for name in "bgra"] == [*"BGRA"]


def test_empty_clouds(library: Library) -> None:
    found = cloud.cloud_of(described(library, XYZ, point_step=12, height=1))
    assert (found.height, found.width) == (1, 0)
    assert len(message(library, PointCloud(np.zeros((0, 3)))).data) == 0


@pytest.mark.parametrize(
    ("fields", "others", "said"),
    [
        ([("x", 0, 7)], {}, "with x: a PointCloud has at least x and y"),
        ([], {}, "with nothing"),
        ([*XYZ, ("ring", 11, 4)], {}, "'ring' lies outside"),
        ([*XYZ, ("far", 0xFFFFFFFF, 2)], {}, "'far' lies outside"),
        ([("x", 0, 9)], {}, "unknown datatype 9"),
        ([("x", 0, 7)] * 300, {}, "300 fields"),
        (XYZ, {"data": bytes(23)}, "does not fit together"),
        (XYZ, {"width": (1 << 32) - 1}, "does not fit together"),
        (XYZ, {"height": 2, "row_step": 23, "data": bytes(100)}, "does not fit together"),
    ],
)
def test_clouds_that_are_none(
    library: Library, fields: list[tuple[str, int, int]], others: dict[str, Any], said: str
) -> None:
    made = {"height": 1, "width": 2, "point_step": 12, "row_step": 24, "data": bytes(24), **others}
    with pytest.raises(DecodeError, match=said):
        cloud.cloud_of(described(library, fields, **made))


@pytest.mark.peer("ros")
def test_ros_reads_the_points(library: Library) -> None:
    made = points("xyz_i")
    given = b"".join(message(library, made).to_ros()).hex()
    program = """
import struct
from sensor_msgs.msg import PointCloud2, PointField
cloud = PointCloud2()
cloud.deserialize(bytes.fromhex(given))
assert all(field.datatype == PointField.FLOAT32 for field in cloud.fields)
answer = [
    [struct.unpack_from("<f", cloud.data, at + field.offset)[0] for field in cloud.fields]
    for at in range(0, len(cloud.data), cloud.point_step)
]
"""
    expected = [[float(value) for value in row] for row in made.array.ravel().tolist()]
    assert ros.ask(program, given) == expected
