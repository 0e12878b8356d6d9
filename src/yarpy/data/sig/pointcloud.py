"""PointCloud: points of one kind in rows, as yarp::sig::PointCloud sends them.

    the header (`cloud_head`), then the points

Rules: the header is not a Bottle. Points are single precision, in groups of 16 bytes; a received
cloud is a view of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

from yarpy.data.pickling import Wired
from yarpy.data.sig.cloud_head import HEAD, POINTS, SIZES
from yarpy.errors import DecodeError, Truncated

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


_XYZ = {"x": 0, "y": 4, "z": 8}


@dataclass(frozen=True, slots=True)
class Kind:
    """The fields of a point of a cloud: the offset of every number in its bytes."""

    name: str
    code: int
    floats: dict[str, int]
    bytes: dict[str, int]

    @property
    def size(self) -> int:
        """The bytes of a point."""
        return SIZES[self.code]

    @property
    def dtype(self) -> np.dtype[Any]:
        """The numpy type of a point, padding included."""
        import numpy as np

        places = {**self.floats, **self.bytes}
        return np.dtype(
            {
                "names": list(places),
                "formats": ["<f4"] * len(self.floats) + ["u1"] * len(self.bytes),
                "offsets": list(places.values()),
                "itemsize": self.size,
            }
        )


def _normal(at: int) -> dict[str, int]:
    return {"normal_x": at, "normal_y": at + 4, "normal_z": at + 8}


def _colour(at: int) -> dict[str, int]:
    return {"b": at, "g": at + 1, "r": at + 2, "a": at + 3}


KINDS = {
    kind.name: kind
    for kind in (
        Kind("xy", 1, {"x": 0, "y": 4}, {}),
        Kind("xyz", 2, _XYZ, {}),
        Kind("normal", 33554528, {**_normal(0), "curvature": 16}, {}),
        Kind("xyz_rgba", 33554438, _XYZ, _colour(16)),
        Kind("xyz_i", 10, {**_XYZ, "intensity": 16}, {}),
        Kind("interest", 18, {**_XYZ, "strength": 16}, {}),
        Kind("xyz_normal", 33554530, {**_XYZ, **_normal(16), "curvature": 32}, {}),
        Kind(
            "xyz_normal_rgba",
            16777318,
            {**_XYZ, **_normal(16), "curvature": 36},
            _colour(32),
        ),
    )
}
_BY_CODE = {kind.code: kind for kind in KINDS.values()}


class PointCloud(Wired):
    """Points in `height` rows of `width`.

    `PointCloud(numbers)` makes points of kind `xyz` from an array (n, 3) or (height, width, 3), of
    kind `xy` from one that ends in 2. `PointCloud(points, kind)` takes a numpy array with named
    fields; fields that the array lacks are zero. `array` is the structured array
    (height, width) over the memory of the cloud, `xyz` the coordinates in it.
    """

    __slots__ = ("_array", "_data", "dense", "height", "kind", "width")

    width: int
    height: int
    #: the name of the kind of points: xy, xyz, normal, xyz_rgba, xyz_i, interest ...
    kind: str
    #: are all coordinates finite numbers?
    dense: bool

    def __init__(self, points: ArrayLike, kind: str | None = None, *, dense: bool = True) -> None:
        import numpy as np

        given = np.asarray(points)
        fields = given.dtype.names
        if fields is None:
            kind = kind or {2: "xy", 3: "xyz"}.get(given.shape[-1] if given.ndim else 0)
        if kind not in KINDS:
            raise ValueError(f"no kind of points {kind!r}; there are {', '.join(KINDS)}")
        dtype = KINDS[kind].dtype
        shape = given.shape if fields is not None else given.shape[:-1]
        if fields is None and given.shape[-1:] != (len(dtype.names or ()),):
            raise ValueError(
                f"points of kind {kind} have {len(dtype.names or ())} numbers each, this array has "
                f"the shape {given.shape}"
            )
        if len(shape) not in (1, 2):
            raise ValueError(f"points come in a list or in rows, not in the shape {given.shape}")
        self.height, self.width = (1, *shape)[-2:]
        array = np.zeros((self.height, self.width), dtype)
        for index, name in enumerate(dtype.names or ()):
            if fields is None:
                array[name] = given[..., index]
            elif name in fields:
                array[name] = given[name]
        self.kind = kind
        self.dense = dense
        self._array: NDArray[Any] | None = array
        self._data = memoryview(array.view("u1").data).cast("B") if array.size else memoryview(b"")

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """A PointCloud over the bytes of a message; DecodeError if they are not one."""
        if len(view) < HEAD.size:
            raise Truncated(f"a PointCloud has a header of {HEAD.size} bytes", HEAD.size)
        width, height, code, dense, list_code, count = HEAD.unpack_from(view)
        if list_code != POINTS or width < 0 or height < 0 or count != width * height:
            raise DecodeError("not a PointCloud: the header is a different one")
        kind = _BY_CODE.get(code)
        if kind is None:
            raise DecodeError(f"a PointCloud with points of the unknown kind {code}")
        end = HEAD.size + kind.size * count
        if len(view) < end:
            raise Truncated(f"this PointCloud takes {end} bytes, here are {len(view)}", end)
        self = cls.__new__(cls)
        self.width, self.height, self.kind, self.dense = width, height, kind.name, dense != 0
        self._array = None
        self._data = memoryview(view)[HEAD.size : end]
        return self

    @classmethod
    def over(
        cls, data: memoryview, width: int, height: int, kind: str, *, dense: bool = True
    ) -> Self:
        """A PointCloud over the bytes of its points, row after row, uncopied. ValueError if there
        are too few."""
        end = KINDS[kind].size * width * height
        if width < 0 or height < 0 or len(data) < end:
            raise ValueError(f"{width} times {height} points take {end} bytes, not {len(data)}")
        self = cls.__new__(cls)
        self.width, self.height, self.kind, self.dense = width, height, kind, dense
        self._array = None
        self._data = data[:end]
        return self

    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        """Header and points, two blocks; the points are the memory of the cloud itself."""
        code, count = KINDS[self.kind].code, self.width * self.height
        head = HEAD.pack(self.width, self.height, code, self.dense, POINTS, count)
        return (head, self._data) if count else (head,)

    def __len__(self) -> int:
        return self.width * self.height

    @property
    def array(self) -> NDArray[Any]:
        """The points, a structured array (height, width) over the same memory."""
        if self._array is None:
            import numpy as np

            points = np.frombuffer(self._data, KINDS[self.kind].dtype)
            self._array = points.reshape(self.height, self.width)
        return self._array

    @property
    def xyz(self) -> NDArray[Any]:
        """The coordinates, float32 (height, width, 3), over the same memory."""
        import numpy as np

        kind = KINDS[self.kind]
        if "z" not in kind.floats:
            raise ValueError(f"points of kind {self.kind} have no coordinates x, y, z")
        shape, strides = (self.height, self.width, 3), (self.width * kind.size, kind.size, 4)
        return np.ndarray(shape, "<f4", self._data, 0, strides)

    def converted(self, kind: str) -> PointCloud:
        """The same points as another kind: shared fields are copied, the others are zero."""
        return PointCloud(self.array, kind, dense=self.dense)

    def __eq__(self, other: object) -> bool:
        """The same numbers; padding does not count."""
        if not isinstance(other, PointCloud):
            return NotImplemented
        mine = (self.kind, self.width, self.height, self.dense)
        if mine != (other.kind, other.width, other.height, other.dense):
            return False
        names = self.array.dtype.names or ()
        return all((self.array[name] == other.array[name]).all() for name in names)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"PointCloud({self.width} x {self.height}, {self.kind!r})"
