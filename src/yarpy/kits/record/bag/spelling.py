"""YARP's messages as objects of ROS's types, as the library rosbags has them.

Rules: pure. None is what has no type of its own there: it becomes a text.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.pointcloud import KINDS, PointCloud
from yarpy.data.sig.vector import Vector
from yarpy.errors import YarpError
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.form.sensor import JOINT_PARTS, PIXELS, SCAN_PARTS, is_scan, joints_of
from yarpy.kits.record.form.structure import Structures
from yarpy.kits.record.kind import BOTTLE

_FLOAT32, _UINT8 = 7, 2  # of PointField
_NUMBERS: Final = "std_msgs/msg/Float64MultiArray"
_SECONDS: Final = (1 << 31) - 1

Spelled = tuple[str, Any]


class Spelling:
    """Makes messages of `types`, by their names."""

    def __init__(self, types: Mapping[str, Any]) -> None:
        self._types = types
        self._structures: dict[str, Structures] = {}

    def _make(self, name: str, /, **fields: Any) -> Any:
        return self._types[name](**fields)

    def text(self, text: str) -> Any:
        """Return a text."""
        return self._make("std_msgs/msg/String", data=text)

    def _header(self, frame: str, sent: int, count: int) -> Any:
        seconds, rest = divmod(sent, SECOND)
        stamp = self._make("builtin_interfaces/msg/Time", sec=min(seconds, _SECONDS), nanosec=rest)
        fields: dict[str, Any] = {"stamp": stamp, "frame_id": frame}
        made = self._types["std_msgs/msg/Header"]
        if "seq" in made.__dataclass_fields__:  # ROS 1 counts
            fields["seq"] = count & 0xFFFFFFFF
        return made(**fields)

    def spelled(
        self, port: str, kind: str, payload: bytes | memoryview, sent: int, count: int
    ) -> Spelled | None:
        """Return the type of a message and the message."""
        try:
            if kind == "yarp/image":
                return self._picture(Image.from_wire(payload), self._header(port, sent, count))
            if kind == "yarp/pointcloud":
                return self._cloud(PointCloud.from_wire(payload), self._header(port, sent, count))
            if kind == "yarp/matrix":
                return self._numbers(Matrix.from_wire(payload).array.ravel())
            if kind == "yarp/vector":
                return self._numbers(Vector.from_wire(payload).array)
        except YarpError:
            return None
        return self._structured(port, payload, sent, count) if kind == BOTTLE else None

    def _picture(self, image: Image, header: Any) -> Spelled | None:
        import numpy as np

        pixels = PIXELS.get(str(image.code))
        if pixels is None:
            return None
        rows = np.ascontiguousarray(image.array)
        made = self._make(
            "sensor_msgs/msg/Image",
            header=header,
            height=image.height,
            width=image.width,
            encoding=pixels,
            is_bigendian=0,
            step=rows.nbytes // max(image.height, 1),
            data=rows.view("u1").ravel(),
        )
        return "sensor_msgs/msg/Image", made

    def _cloud(self, points: PointCloud, header: Any) -> Spelled:
        import numpy as np

        kind = KINDS[points.kind]
        places = [(name, at, _FLOAT32) for name, at in kind.floats.items()]
        places += [(name, at, _UINT8) for name, at in kind.bytes.items()]
        fields = [
            self._make("sensor_msgs/msg/PointField", name=name, offset=at, datatype=type_, count=1)
            for name, at, type_ in places
        ]
        made = self._make(
            "sensor_msgs/msg/PointCloud2",
            header=header,
            height=points.height,
            width=points.width,
            fields=fields,
            is_bigendian=False,
            point_step=kind.size,
            row_step=kind.size * points.width,
            data=np.frombuffer(points.array.tobytes(), "u1"),
            is_dense=points.dense,
        )
        return "sensor_msgs/msg/PointCloud2", made

    def _numbers(self, values: Any) -> Spelled:
        import numpy as np

        layout = self._make("std_msgs/msg/MultiArrayLayout", dim=[], data_offset=0)
        data = np.ascontiguousarray(values, "<f8")
        return _NUMBERS, self._make(_NUMBERS, layout=layout, data=data)

    def _structured(
        self, port: str, payload: bytes | memoryview, sent: int, count: int
    ) -> Spelled | None:
        import numpy as np

        found = self._structures.setdefault(port, Structures()).find(payload)
        if found is None:
            return None
        structure, values = found
        outline = structure.outline
        if len(outline) == SCAN_PARTS and is_scan(outline):
            ranges = np.array(values[4:-1], "<f4")
            first, last = math.radians(values[0]), math.radians(values[1])
            made = self._make(
                "sensor_msgs/msg/LaserScan",
                header=self._header(port, sent, count),
                angle_min=first,
                angle_max=last,
                angle_increment=(last - first) / max(len(ranges) - 1, 1),
                time_increment=0.0,
                scan_time=0.0,
                range_min=values[2],
                range_max=values[3],
                ranges=ranges,
                intensities=np.zeros(0, "<f4"),
            )
            return "sensor_msgs/msg/LaserScan", made
        if len(outline) in JOINT_PARTS and (joints := joints_of(outline)):
            made = self._make(
                "sensor_msgs/msg/JointState",
                header=self._header(port, sent, count),
                name=[f"joint_{n}" for n in range(joints)],
                position=np.radians(np.array(values[:joints], "<f8")),
                velocity=np.radians(np.array(values[joints : 2 * joints], "<f8")),
                effort=np.array(values[6 * joints : 7 * joints], "<f8"),
            )
            return "sensor_msgs/msg/JointState", made
        return self._numbers(values)
