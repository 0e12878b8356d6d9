"""Rerun and Foxglove: what they are told."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.recordings import START, payload_of

import yarpy
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.view.elsewhere import foxglove_address, show

LINE = ["[/log/a/b/1]", "(level WARNING) (systemtime 1.5) (message hot)"]
ROWS = [
    (yarpy.Image(np.zeros((4, 5, 3), "u1")), "Image", (4, 5, 3)),
    (yarpy.Image(np.zeros((4, 5), "f4")), "DepthImage", (4, 5)),
    (yarpy.Image(np.zeros((4, 5, 3), "f4"), "rgb."), "Image", (4, 5, 3)),
    (yarpy.PointCloud([[1.0, 2, 3], [4, 5, 6]]), "Points3D", (2, 3)),
    (yarpy.Matrix(np.eye(2)), "Scalars", (4,)),
    (yarpy.Vector([1.5, 2]), "Scalars", (2,)),
    ([1, 2, 3], "Scalars", (3,)),
    (LINE, "TextLog", ()),
    (["some", "words"], "TextDocument", ()),
    (yarpy.Sound(np.zeros(8, "i2")), "TextDocument", ()),
]


class Library:
    """Stands in for the library: keeps what it is told."""

    def __init__(self) -> None:
        self.times: dict[str, Any] = {}
        self.said: list[tuple[str, Any]] = []

    def set_time(self, timeline: str, *, timestamp: Any) -> None:
        self.times[timeline] = timestamp

    def log(self, path: str, what: Any) -> None:
        self.said.append((path, what))

    def __getattr__(self, name: str) -> Any:
        return lambda value, **more: SimpleNamespace(name=name, value=value, **more)


@pytest.mark.parametrize(("value", "name", "shape"), ROWS)
def test_rerun(value: object, name: str, shape: tuple[int, ...]) -> None:
    library = Library()
    show(library, Recorded("/a/b", START, 1_500_000_000, "", payload_of(value)))
    ((path, found),) = library.said
    assert (path, found.name) == ("a/b", name)
    assert np.shape(found.value) == shape
    assert library.times["sent"] == np.datetime64(1_500_000_000, "ns")
    assert library.times["received"] == np.datetime64(START, "ns")
    if name == "TextLog":
        assert (found.value, found.level) == ("hot", "WARN")


def test_what_cannot_be_read() -> None:
    library = Library()
    picture = payload_of(yarpy.Image(np.zeros((4, 5), "u1")))
    show(library, Recorded("/", START, START, "", picture[:70]))
    ((path, found),) = library.said
    assert path == "message" and "cannot be read" in found.value


@pytest.mark.parametrize(("value", "name", "shape"), ROWS)
def test_the_library_takes_it(value: object, name: str, shape: tuple[int, ...], tmp_path) -> None:
    rerun = pytest.importorskip("rerun", reason="Rerun's own library: pip install rerun-sdk")
    rerun.init("test")
    rerun.save(tmp_path / "x.rrd")
    show(rerun, Recorded("/a/b", START, START, "", payload_of(value)))
    rerun.disconnect()
    assert (tmp_path / "x.rrd").stat().st_size > 0


def test_foxglove() -> None:
    assert foxglove_address("http://127.0.0.1:99/").endswith("ds.url=ws%3A%2F%2F127.0.0.1%3A99%2F")
