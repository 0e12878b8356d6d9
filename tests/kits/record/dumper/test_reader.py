"""Folders of C++, read: what C++ wrote, and what became of it since."""

from pathlib import Path

import pytest

import yarpy
from yarpy import record
from yarpy.errors import MissingFile
from yarpy.kits.record.dumper import reader
from yarpy.kits.record.dumper.reader import DumperStorage

GOLDEN = Path(__file__).parents[3] / "golden" / "datadumper"


def folder(where: Path, data: bytes, stamps: str = "rx", type_: str = "Bottle") -> Path:
    where.mkdir(parents=True)
    head = f"Type: {type_};\nStamp: {stamps};\n[10.000000] /a [connected]\n"
    (where / "info.log").write_text(head)
    (where / "data.log").write_bytes(data)
    return where


def test_all_of_one_recording() -> None:
    storage = DumperStorage(GOLDEN)
    assert [*storage.ports] == ["/cap/out"] and len([*storage.messages()]) == 35
    assert storage.complete and not storage.damages and storage.size > 0
    assert storage.begin == 5_500_000_000 and storage.end == 1_795_225_117_737_058_000
    assert len(storage.notes()) == 28 and storage.facts == {}
    storage.close()


def test_pictures_are_part_of_its_size() -> None:
    files = [file for file in (GOLDEN / "image").iterdir() if file.is_file()]
    assert len(files) > 2
    assert DumperStorage(GOLDEN / "image").size == sum(file.stat().st_size for file in files)


def test_values_and_times() -> None:
    (first, _, last) = DumperStorage(GOLDEN / "bottle_rxtx").messages()
    assert first.value == [1, "ping", 3.14] and last.value == ["hello"]
    assert (first.envelope, first.sent) == ("1 100.25", 100.25)
    assert first.received == 1795225087.449362
    (first, *_) = DumperStorage(GOLDEN / "bottle_txtime_noenv").messages()
    assert (first.envelope, first.received_ns) == ("", 1_795_225_090_687_992_000)
    assert first.value == [1, "ping", 3.14]
    (numbers, *_) = DumperStorage(GOLDEN / "vector").messages()
    assert numbers.as_(yarpy.Vector) == yarpy.Vector([0.5, 1.5, 2.5])


@pytest.mark.parametrize("name", ["image", "image_png", "image_jpg", "image_txrx"])
def test_pictures(name: str) -> None:
    if name == "image_png":
        pytest.importorskip("cv2", reason='pictures as PNG: pip install "yarpy[vision]"')
    storage = DumperStorage(GOLDEN / name)
    found = [one.value for one in storage.messages()]
    assert found and all(isinstance(image, yarpy.Image) for image in found)
    assert not storage.damages and storage.ports["/cap/out"].kinds == ["yarp/image"]
    if name == "image":
        assert [(str(one.code), one.width, one.height) for one in found] == [
            ("rgb", 4, 3),
            ("rgb", 3, 2),
            ("mono", 4, 2),
        ]
        assert found[0].array[0, 2].tolist() == [20, 0, 2]


def test_a_part_of_it() -> None:
    storage = DumperStorage(GOLDEN / "bottle_rxtime")
    times = [one.received_ns for one in storage.messages()]
    assert [one.value for one in storage.messages(["/cap/out"], times[1], times[2])] == [
        yarpy.Bottle.from_text('(a (1 2)) [set] "two words"')
    ]
    assert [*storage.messages(["/x"])] == []


def test_what_is_spoilt_is_named_and_the_rest_read(tmp_path: Path) -> None:
    data = b"1 1.000000 a\n\nnonsense\r\n2 2.000000 b\r\n3 3.000000 c"
    storage = DumperStorage(folder(tmp_path / "x", data))
    assert [one.value for one in storage.messages()] == [["a"], ["b"]]
    assert [*map(str, storage.damages)] == [
        "byte 38: x/data.log: the last line is cut off",
        "byte 14: x/data.log: a line without a number and a time",
    ]
    assert not storage.complete and storage.ports["/a"].messages == 2


def test_columns_of_times(tmp_path: Path) -> None:
    """One that follows a sender's time may be a number of the message."""
    data = b"1 5.000000 2.500000 x\n-1 0.000000 7.000000 8.000000 y\n"
    storage = DumperStorage(folder(tmp_path / "x", data, "tx"))
    assert [(one.received, one.value) for one in storage.messages()] == [
        (5.0, [2.5, "x"]),
        (7.0, [8.0, "y"]),
    ]
    storage = DumperStorage(folder(tmp_path / "y", data, "tx+rx"))
    assert [(one.sent, one.received) for one in storage.messages()] == [(5.0, 2.5), (0.0, 7.0)]
    storage = DumperStorage(folder(tmp_path / "z", data, "rx"))
    assert [one.received for one in storage.messages()] == [5.0, 0.0]


@pytest.mark.parametrize(
    "content",
    [
        "../secret.ppm [rgb]",
        "/etc/passwd [rgb]",
        "gone.ppm [rgb]",
        "short.ppm [rgb]",
        "x.float [dec]",
    ],
)
def test_names_of_pictures_lead_nowhere_else(content: str, tmp_path: Path) -> None:
    (tmp_path / "secret.ppm").write_bytes(b"P6\n1 1\n255\nabc")
    where = folder(tmp_path / "x", f"1 1.000000 {content}\n".encode(), "rx", "Image")
    (where / "short.ppm").write_bytes(b"P6\n100 100\n255\nabc")
    (where / "x.float").write_bytes(b"\xff" * 16)
    storage = DumperStorage(where)
    assert not any(isinstance(one.value, yarpy.Image) for one in storage.messages())


def test_several_ports_on_one_time_axis(tmp_path: Path) -> None:
    folder(tmp_path / "a", b"1 1.000000 a\n2 3.000000 a\n")
    folder(tmp_path / "deep" / "b", b"1 2.000000 b\n2 4.000000 b\n")
    info = (tmp_path / "deep" / "b" / "info.log").read_text()
    (tmp_path / "deep" / "b" / "info.log").write_text(info.replace("/a", "/b"))
    with record.open(tmp_path) as found:
        assert [(one.port, one.received) for one in found] == [
            ("/a", 1.0),
            ("/b", 2.0),
            ("/a", 3.0),
            ("/b", 4.0),
        ]


def test_lines_have_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reader, "DUMPED_LINE", 100)
    storage = DumperStorage(
        folder(tmp_path / "x", b"1 1.000000 a\n2 2.000000 " + b"b" * 200 + b"\n")
    )
    assert [one.value for one in storage.messages()] == [["a"]]
    assert "a line of more than 100 bytes" in str(storage.damages[0])


def test_a_recorder_that_nobody_connected(tmp_path: Path) -> None:
    (tmp_path / "quiet").mkdir()
    (tmp_path / "quiet" / "info.log").write_text("Type: Bottle;\nStamp: rx;\n")
    (tmp_path / "quiet" / "data.log").write_text("")
    storage = DumperStorage(tmp_path)
    assert [*storage.ports] == ["/quiet"] and (storage.begin, storage.end) == (0, 0)
    with pytest.raises(MissingFile, match=r"no folder with info\.log and data\.log"):
        DumperStorage(GOLDEN.parent / "vectors")
