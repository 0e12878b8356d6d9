"""Recordings as files of robometry, as MATLAB sees them."""

import json
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.recordings import START, payload_of

import yarpy
from yarpy import record
from yarpy.kits.record.convert import convert
from yarpy.kits.record.mcap.writer import McapWriter

pytestmark = pytest.mark.skipif(find_spec("scipy") is None, reason="files are read with scipy")


def loadmat(file: Path, **options: object) -> dict[str, Any]:
    """What a file says, as scipy reads it; which takes a while to load."""
    from scipy.io import loadmat as read

    return read(file, **options)


def recorded(folder: Path) -> Path:
    """A port whose name is also the beginning of another one, pictures, and a port that changes."""
    with McapWriter(folder / "x.mcap") as writer:
        for n in range(4):
            at = START + n * 10_000_000
            stamp = f"{n} {10 + n}.5"
            writer.add("/arm", stamp, at, payload_of(yarpy.Vector([n, 0.5])))
            writer.add("/arm/state:o", stamp, at, payload_of([1, n]))
            writer.add("/m", "", at, payload_of(yarpy.Matrix([[1, 2, 3], [4, 5, n]])))
            writer.add("/cam", stamp, at, payload_of(yarpy.Image(np.zeros((2, 2, 3), "u1"))))
            writer.add("/odd", stamp, at, payload_of(yarpy.Vector([0.0] * (1 + n // 2))))
            writer.add("/text", stamp, at, payload_of("hello"))
    return folder / "x.mcap"


def test_as_matlab_sees_it(tmp_path: Path) -> None:
    with record.open(recorded(tmp_path)) as found:
        done = convert(
            found, tmp_path / "walk", form="robometry", ports=["/arm", "/arm/state:o", "/m"]
        )
    assert (done.path, done.messages, done.left_out) == (tmp_path / "walk.mat", 12, 0)
    walk = loadmat(done.path, simplify_cells=True)["walk"]
    assert walk["arm"]["data"].shape == (2, 4)
    assert walk["arm"]["dimensions"].tolist() == [2, 1, 4]
    assert walk["arm"]["timestamps"].tolist() == [10.5, 11.5, 12.5, 13.5]
    assert walk["arm_"]["state_o"]["data"].tolist() == [[1, 1, 1, 1], [0, 1, 2, 3]]
    assert walk["m"]["data"][:, :, 3].tolist() == [[1, 2, 3], [4, 5, 3]]
    assert [*walk["arm"]["elements_names"]] == ["element_0", "element_1"]
    said = json.loads((tmp_path / "walk.json").read_text(encoding="utf-8"))
    assert [one["name"] for one in said["channels"]] == ["arm", "arm_::state_o", "m"]
    assert (said["filename"], said["n_samples"]) == ("walk", 4)


def test_what_is_no_numbers_is_left_out(tmp_path: Path) -> None:
    with record.open(recorded(tmp_path)) as found:
        done = convert(found, tmp_path / "walk", form="robometry")
        # Pictures are numbers, of one size; texts are none, and two messages are longer.
        assert (done.messages, done.left_out) == (18, 6)
        with pytest.raises(FileExistsError):
            convert(found, tmp_path / "walk.mat", form="robometry")


@pytest.mark.parametrize("code", ["mono", "rgb", "bgr", "rgba", "bgra"])
def test_pictures_there_and_back(tmp_path: Path, code: str) -> None:
    depth = len(code.replace("mono", "m"))
    shape = (4, 6) if code == "mono" else (4, 6, depth)
    pixels = np.arange(3 * 24 * depth, dtype="u1").reshape(3, *shape)
    with McapWriter(tmp_path / "x.mcap") as writer:
        for n, array in enumerate(pixels):
            image = yarpy.Image(np.ascontiguousarray(array), code)
            writer.add("/cam", f"{n} {10 + n}.5", START + n, payload_of(image))
    with record.open(tmp_path / "x.mcap") as found:
        expected = [one.as_(yarpy.Image) for one in found]
        done = convert(found, tmp_path / "walk", form="robometry")
    assert loadmat(done.path, simplify_cells=True)["walk"]["cam"]["data"].dtype == np.uint8
    with record.open(done.path) as found:
        assert found.ports["/cam"].kinds == ["yarp/image"] and found.damages == []
        for one, was in zip(found, expected, strict=True):
            picture = one.as_(yarpy.Image)
            assert str(picture.code) == code.replace("bgr", "rgb")
            assert (picture.array == was.converted(picture.code).array).all()


def test_a_configuration_names_no_pixels(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        image = yarpy.Image(np.zeros((240, 320, 3), "u1"))
        writer.add("/cam", "0 10.5", START, payload_of(image))
        writer.add("/arm", "0 10.5", START, payload_of(yarpy.Vector([1.0, 0.5])))
    with record.open(tmp_path / "x.mcap") as found:
        convert(found, tmp_path / "walk", form="robometry")
    with record.open(tmp_path / "walk.json") as found:
        assert found.ports["/arm"].messages == 1
