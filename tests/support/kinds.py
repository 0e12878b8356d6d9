"""Every kind of message that a port can write, and a walk of all of them over one connection.

Rules: `EVERY` is the table; a new kind of message gets a row here, and so goes through every
carrier that a test walks. A row arrives, or the write is refused with a reason; behind each row the
same connection carries the word `NEXT`, so that a row that ends it is seen.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Final

import numpy as np
import pytest
from support.wait import HANG

import yarpy
from yarpy.data import codec
from yarpy.data.bottle import Property
from yarpy.data.sig.pixel import NAMES, pixel_of
from yarpy.data.sig.pointcloud import KINDS
from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
from yarpy.wire.message import UNSENDABLE, Message

NEXT: Final = "next"
DTYPES: Final = (
    *("bool", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"),
    *("float16", "float32", "float64", "complex64", "complex128"),
)


@dataclass
class Joint:
    """What a device would say of a joint."""

    position: float
    torque: float | None
    name: str


def _image(name: str) -> yarpy.Image:
    pixel = pixel_of(name)
    shape = (6, 4) if pixel.channels == 1 else (6, 4, pixel.channels)
    numbers = np.arange(6 * 4 * pixel.channels) % 100
    return yarpy.Image(numbers.reshape(shape).astype(pixel.dtype), name)


def _cloud(kind: str, *shape: int) -> yarpy.PointCloud:
    points = np.zeros(shape, KINDS[kind].dtype)
    for place, name in enumerate(points.dtype.names or ()):
        points[name] = np.arange(points.size).reshape(shape) % 50 + place
    return yarpy.PointCloud(points, kind)


def _plain() -> Iterator[tuple[str, Any]]:
    yield "bottle", yarpy.Bottle(["a", 1, 2.5, [1, [2]], True, Vocab("set"), b"\0\xff"])
    yield "empty bottle", yarpy.Bottle()
    yield "list of one", ["word"]
    yield "tuple", (1, "two", 3.0)
    yield "text", 'words with "quotes", umlauts \xfc and a line\nend'
    yield "number", 3
    yield "long number", 1 << 40
    yield "real number", 2.5
    yield "truth", True
    yield "nothing", None
    yield "bytes", b"\0\xffabc"
    yield "vocab", Vocab("set")
    for odd in (Int8(3), Int16(300), Int64(3), Float32(0.5)):
        yield type(odd).__name__, odd
    yield "complex", 1 + 2j
    yield "property", Property({"a": 1, "b": [1, 2.5], "c": "x"})
    yield "dict", {"a": 1, "b": [1, None], "c": {"d": (1, 2), "e": 1}}
    yield "dataclass", Joint(0.5, None, "elbow")
    yield "stamp", yarpy.Stamp(3, 1.5)
    yield "not a number", [float("nan"), float("inf")]


def _large() -> Iterator[tuple[str, Any]]:
    yield "vector", yarpy.Vector([1.0, 2.0, 3.0])
    yield "empty vector", yarpy.Vector([])
    yield "matrix", yarpy.Matrix(np.arange(6.0).reshape(2, 3))
    for dtype in DTYPES:
        yield f"array {dtype}", np.arange(5).astype(dtype)
        yield f"array {dtype} of 2 dimensions", np.arange(6).reshape(2, 3).astype(dtype)
        yield f"{dtype} itself", np.dtype(dtype).type(1)
    yield "array of 3 dimensions", np.arange(24.0).reshape(2, 3, 4)
    yield "empty array", np.zeros((0, 3))
    for name in NAMES:
        yield f"image {name}", _image(name)
    yield "sound", yarpy.Sound([[1, 2, 3], [4, 5, 6]], 8000)
    yield "empty sound", yarpy.Sound()
    for kind in KINDS:
        yield f"cloud {kind}", _cloud(kind, 2, 3)
    for shape in ((1, 1), (1, 2), (5, 1), (1, 256), (1, 257), (2, 266), (0, 0)):
        yield f"cloud {shape[1]} wide, {shape[0]} high", _cloud("xyz", *shape)
    rgb, depth = _image("rgb"), _image("dec")
    yield "camera with depth", {"rgb": rgb, "depth": depth, "stamp": yarpy.Stamp(1, 2.0)}
    yield "state of a board", [yarpy.Vector([0.1, 0.2]), True, yarpy.Vector([1.0, 2.0]), False]
    yield (
        "list of all",
        ["x", _cloud("xyz", 1, 2), yarpy.Sound([1, 2]), rgb, np.arange(3, dtype="u2")],
    )
    yield "dict of all", {"cloud": _cloud("xy", 1, 2), "sound": yarpy.Sound([1]), "picture": depth}
    header = {"seq": 1, "stamp": {"secs": 1, "nsecs": 2}, "frame_id": "base"}
    yield "as of ROS", {"header": header, "name": ["a", "b"], "position": np.array([0.5, 1.5])}
    yield "table of pandas", _table()


def _table() -> Any:
    pandas = pytest.importorskip("pandas", reason="pandas: pip install 'yarpy[test]'")
    return pandas.DataFrame({"a": [1.0, 2.0], "b": [3.0, 4.0]})


def every() -> dict[str, Any]:
    """Return one message of every kind, by a name."""
    return {**dict(_plain()), **dict(_large())}


#: what no carrier can say, whose write is refused
REFUSED: Final[dict[str, Any]] = {
    "set": {1, 2},
    "decimal": Decimal("0.5"),
    "class": Joint,
    "long integer": 1 << 70,
    "set in a list": [1, {2}],
    "array of objects": np.array([{}], dtype=object),
}


def walk(
    out: yarpy.Port,
    arrived: Callable[[], Any],
    same: Callable[[str, Any, Any], bool],
    also: Collection[str] = (),
) -> None:
    """Write one message of every kind. `arrived()` returns what came next at the other end, in
    whatever form; `same(name, came, value)` whether it is what was written. `also`: what this
    carrier takes of `REFUSED`."""
    wrong = []
    for name, value in every().items():
        out.write(value)
        came = arrived()
        if not same(name, came, value):
            wrong.append(f"{name}: {came!r:.200}")
        out.write(NEXT)
        behind = arrived()
        assert NEXT in str(getattr(behind, "value", behind)), f"{name}: behind it came {behind!r}"
    for name, value in REFUSED.items():
        try:
            out.write(value)
        except UNSENDABLE as error:
            assert str(error), name
        else:
            arrived()
            if name not in also:
                wrong.append(f"{name}: not refused")
        out.write(NEXT)
        behind = arrived()
        assert NEXT in str(getattr(behind, "value", behind)), f"{name}: behind it came {behind!r}"
    assert not wrong, "\n".join(wrong)


def as_sent(name: str, came: Any, value: Any) -> bool:
    """The bytes are those that were written."""
    return bytes(came.to_bytes()) == b"".join(codec.encode(value))


def read(reader: yarpy.BufferedPort) -> Callable[[], Message]:
    """Return what reads the next message at a port."""
    return lambda: reader.read(timeout=HANG)
