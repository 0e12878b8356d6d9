"""The folders of C++, against what C++ 3.9.1 has written."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.recordings import START, STEP, payload_of

import yarpy
from yarpy import record
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.convert import convert
from yarpy.kits.record.dumper.part import Times, picture_file
from yarpy.kits.record.dumper.writer import DumperWriter, harmless

GOLDEN = Path(__file__).parents[3] / "golden" / "datadumper"
TIMES: dict[tuple[bool, bool], Times] = {
    (False, False): "",
    (True, False): "rx",
    (False, True): "tx",
    (True, True): "tx+rx",
}
# PNG and JPEG are read, and written as PPM.
ROWS = [
    row
    for row in json.loads((GOLDEN / "index.json").read_text())
    if not {"image_png", "image_jpg"} & {*row["options"]}
]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["dir"])
def test_byte_for_byte(row: dict[str, object], tmp_path: Path) -> None:
    folder, options = GOLDEN / str(row["dir"]), row["options"]
    assert isinstance(options, list)
    times = TIMES["--rxTime" in options, "--txTime" in options]
    with record.open(folder) as recording:
        convert(recording, tmp_path / "x", form="dumper", times=times)
        assert not recording.damages
    written = tmp_path / "x" / "cap" / "out"
    assert {file.name for file in written.iterdir()} == {file.name for file in folder.iterdir()}
    for file in folder.iterdir():
        assert (written / file.name).read_bytes() == file.read_bytes(), file.name


def test_a_port_that_was_connected_before_anybody_looked(tmp_path: Path) -> None:
    writer = DumperWriter(tmp_path / "x")
    writer.add("/a", "7 5.25", START, payload_of([1, "two words"]))
    assert writer.pending
    writer.flush()
    folder = tmp_path / "x" / "a"
    assert (folder / "data.log").read_text() == '7 5.250000 1 "two words"\n'
    writer.note({"what": "disconnected", "port": "/a"}, START + STEP)
    writer.note({"what": "mark"}, START)
    writer.close()
    assert (folder / "info.log").read_text().splitlines() == [
        "Type: Bottle;",
        "Stamp: rx;",
        "[1795000000.000000] /a [connected]",
        "[1795000000.010000] /a [disconnected]",
    ]
    assert writer.size == len('7 5.250000 1 "two words"\n')


@pytest.mark.parametrize(
    ("code", "shape", "dtype", "ending"),
    [
        ("mono", (2, 3), "u1", ".pgm"),
        ("rgb", (2, 3, 3), "u1", ".ppm"),
        ("bgr", (2, 3, 3), "u1", ".ppm"),
        ("dec", (2, 3), "f4", ".float"),
        ("grbg", (2, 4), "u1", ".pgm"),
    ],
)
def test_pictures_come_back(code: str, shape: tuple[int, ...], dtype: str, ending: str, tmp_path):
    """Odd widths and Bayer patterns too, which C++ spoils or dies of."""
    image = yarpy.Image(np.arange(np.prod(shape)).reshape(shape).astype(dtype), code)
    assert picture_file(image)[0] == ending
    writer = DumperWriter(tmp_path / "x")
    writer.add("/cam", "1 1", START, payload_of(image))
    writer.close()
    with record.open(tmp_path / "x") as found:
        (one,) = found
        assert one.value == image and found.ports["/cam"].kinds == ["yarp/image"]


def test_other_pixels_become_rgb(tmp_path: Path) -> None:
    deep = yarpy.Image(np.full((2, 2), 7, "u2"))
    assert picture_file(deep)[1].startswith(b"P6\n2 2\n255\n")
    alpha = yarpy.Image(np.full((1, 1, 4), 9, "u1"))
    assert picture_file(alpha) == (".ppm", b"P6\n1 1\n255\n\x09\x09\x09")


def test_a_port_whose_type_changes(tmp_path: Path) -> None:
    image = yarpy.Image(np.zeros((1, 1), "u1"))
    writer = DumperWriter(tmp_path / "x")
    for value in (image, [1], image):
        writer.add("/cam", "", START, payload_of(value))
    writer.close()
    lines = (tmp_path / "x" / "cam" / "data.log").read_text().splitlines()
    assert [line.split(" ", 2)[2] for line in lines] == [
        "00000000.pgm [mono]",
        "1",
        "00000002.pgm [mono]",
    ]


def test_what_has_no_text(tmp_path: Path) -> None:
    writer = DumperWriter(tmp_path / "x")
    with pytest.raises(LocalProtocolError, match="C\\+\\+ cannot record"):
        writer.add("/a", "", START, b"\1\2\3")
    writer.close()


@pytest.mark.parametrize(
    ("port", "folders"),
    [
        ("/icub/cam/left", ["icub", "cam", "left"]),
        ("/we:ird*", ["we_ird_"]),
        ("/../../etc/passwd", ["__", "__", "etc", "passwd"]),
        ("//a//./b", ["a", "_", "b"]),
        ("/a/data.log", ["a", "data.log_"]),
        ("/a/00000000.ppm", ["a", "00000000.ppm_"]),
        ("", ["port"]),
        ("/a\\..\\b\0", ["a_.._b_"]),
        ("/" + "x" * 5000, ["x" * 200]),
    ],
)
def test_names_of_ports_lead_nowhere_else(port: str, folders: list[str], tmp_path: Path) -> None:
    assert harmless(port) == folders
    writer = DumperWriter(tmp_path / "deep" / "x")
    writer.add(port, "", START, payload_of([1]))
    writer.add(port + "?", "", START, payload_of([1]))
    writer.close()
    assert {file.name for file in tmp_path.iterdir()} == {"deep"}
    assert len([*(tmp_path / "deep" / "x").rglob("info.log")]) == 2


def test_two_ports_of_one_folder(tmp_path: Path) -> None:
    writer = DumperWriter(tmp_path / "x")
    for port in ("/a:b", "/a*b", "/a_b/c"):
        writer.add(port, "", START, payload_of([1]))
    writer.close()
    with record.open(tmp_path / "x") as found:
        assert {*found.ports} == {"/a:b", "/a*b", "/a_b/c"}


def test_nothing_is_replaced(tmp_path: Path) -> None:
    with pytest.raises(FileExistsError):
        DumperWriter(tmp_path)
