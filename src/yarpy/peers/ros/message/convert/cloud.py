"""YARP's PointCloud as sensor_msgs/PointCloud2, and back.

Rules: points are not copied where the fields lie alike, as those of PCL do (its types are where
YARP's kinds come from); otherwise the fields that a kind of YARP has are picked out. Colours are
one field `rgba` of 32 bits there, four bytes here. What a peer says about offsets and sizes is
checked before it is used.
"""

from __future__ import annotations

from typing import Any, Final

from yarpy.data.sig.pointcloud import KINDS, PointCloud
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.fault import array_of
from yarpy.peers.ros.message.message import Message

#: number of a datatype -> type of numpy
_DATATYPES: Final = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
_UINT32: Final = 6
_FLOAT32: Final = 7
_MAX_SIDE: Final = 0x7FFFFFFF
_MAX_FIELDS: Final = 256


def cloud_message(cloud: PointCloud, cls: type[Message], header: Any) -> Message:
    """A sensor_msgs/PointCloud2 over the points of a PointCloud."""
    import numpy as np

    kind = KINDS[cloud.kind]
    field: Any = next(used for used in cls._used.values() if used._type == "sensor_msgs/PointField")
    fields = [field(name, at, _FLOAT32, 1) for name, at in kind.floats.items()]
    if kind.bytes:
        fields.append(field("rgba", kind.bytes["b"], _UINT32, 1))
    blocks = cloud.to_wire()
    return cls(
        header=header,
        height=cloud.height,
        width=cloud.width,
        fields=fields,
        point_step=kind.size,
        row_step=kind.size * cloud.width,
        data=np.frombuffer(blocks[1] if len(blocks) == 2 else b"", "u1"),
        is_dense=cloud.dense,
    )


def cloud_of(message: Any) -> PointCloud:
    """The PointCloud of a sensor_msgs/PointCloud2, of the kind that keeps most of its fields.

    DecodeError if there is none, or if fields and data do not belong together.
    """
    import numpy as np

    fields = _fields(message)
    width, height, size = message.width, message.height, message.point_step
    row = message.row_step if height > 1 else size * width
    path = "sensor_msgs/PointCloud2.data"
    data = np.ascontiguousarray(array_of(message.data, np.dtype("u1"), path))
    if (
        max(width, height) > _MAX_SIDE
        or size < 1
        or row < size * width
        or len(data) < row * max(height - 1, 0) + size * width
    ):
        raise DecodeError(
            f"a cloud of {width} times {height} points of {size} bytes, with rows of {row} and "
            f"{len(data)} bytes in all: that does not fit together"
        )
    kind = _kind(fields)
    offsets = {name: at for name, (at, dtype) in fields.items() if dtype in ("<f4", "<u1")}
    wanted = {**KINDS[kind].floats, **KINDS[kind].bytes}
    alike = size == KINDS[kind].size and row == size * width
    if alike and all(offsets.get(name) == at for name, at in wanted.items()):
        return PointCloud.over(data.data, width, height, kind, dense=bool(message.is_dense))
    dtype = np.dtype(
        {
            "names": [*fields],
            "formats": [dtype for _, dtype in fields.values()],
            "offsets": [at for at, _ in fields.values()],
            "itemsize": size,
        }
    )
    if not width or not height:
        return PointCloud(np.zeros((height, width), dtype), kind, dense=bool(message.is_dense))
    points: Any = np.ndarray((height, width), dtype, data, 0, (row, size))
    return PointCloud(points, kind, dense=bool(message.is_dense))


def _fields(message: Any) -> dict[str, tuple[int, str]]:
    """Offset and type of each number in a point; colours are four bytes."""
    order = ">" if message.is_bigendian else "<"
    found: dict[str, tuple[int, str]] = {}
    if len(message.fields) > _MAX_FIELDS:
        raise DecodeError(f"a cloud of points with {len(message.fields)} fields each")
    for field in message.fields:
        kind = _DATATYPES.get(field.datatype)
        if kind is None:
            raise DecodeError(f"a cloud with the unknown datatype {field.datatype}")
        if field.offset + int(kind[1]) > message.point_step:
            raise DecodeError(f"a cloud whose field {field.name[:40]!r} lies outside of its points")
        if field.name in ("rgb", "rgba") and kind[1] == "4":
            letters = "argb" if message.is_bigendian else "bgra"
            found |= {letter: (field.offset + at, "<u1") for at, letter in enumerate(letters)}
        elif field.name and field.name not in found:
            found[field.name] = field.offset, (order if kind[1] != "1" else "<") + kind
    return found


def _kind(fields: dict[str, tuple[int, str]]) -> str:
    """The kind of YARP that keeps most of these fields and has no others."""
    names = {*fields}
    fitting = [
        (len(kind.floats) + len(kind.bytes), kind.name)
        for kind in KINDS.values()
        if {*kind.floats, *kind.bytes} <= names
    ]
    if not fitting:
        raise DecodeError(
            f"a cloud of points with {', '.join(sorted(names))[:80] or 'nothing'}: a PointCloud "
            "has at least x and y"
        )
    return max(fitting)[1]
