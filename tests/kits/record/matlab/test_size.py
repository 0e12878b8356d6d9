"""How much memory a file of MATLAB takes."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.record.matlab import size
from yarpy.kits.record.matlab.reader import MatStorage
from yarpy.kits.record.matlab.size import check_size

RECORDED = Path(__file__).parents[3] / "data" / "robometry"


def element(kind: int, data: bytes) -> bytes:
    return struct.pack("<2I", kind, len(data)) + data


def file_of(path: Path, *elements: bytes) -> Path:
    path.write_bytes(b"MATLAB 5.0".ljust(124) + b"\x00\x01IM" + b"".join(elements))
    return path


@pytest.mark.parametrize("name", ["v5.mat", "v73.mat"])
def test_files_of_robometry_fit(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if "73" in name:
        pytest.importorskip("h5py", reason='files of MATLAB 7.3: pip install "yarpy[matlab]"')
    check_size(RECORDED / name)
    monkeypatch.setattr(size, "MATLAB_FILE", 100)
    with pytest.raises(DecodeError, match="more than 0 MB of memory"):
        check_size(RECORDED / name)


def test_a_bomb_is_refused_before_a_library_unpacks_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pymatreader", reason='files of MATLAB: pip install "yarpy[matlab]"')
    monkeypatch.setattr(size, "MATLAB_FILE", 16 << 20)
    packed = zlib.compress(bytes(17 << 20), 9)
    assert len(packed) < 20_000
    bomb = file_of(tmp_path / "bomb.mat", element(14, bytes(8)), element(15, packed))
    with pytest.raises(DecodeError, match="more than 16 MB of memory"):
        MatStorage(bomb)


def test_dimensions_that_lie_are_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py", reason='files of MATLAB 7.3: pip install "yarpy[matlab]"')
    path = tmp_path / "empty.mat"
    with h5py.File(path, "w") as file:
        file.create_dataset("a/b", (1 << 20, 1 << 20), "f8", chunks=(1, 1 << 10))
    with pytest.raises(DecodeError, match="memory"):
        check_size(path)


@pytest.mark.parametrize("cut", [0, 4, 127, 128, 131, 140, 150])
def test_what_is_damaged_is_left_to_the_library(tmp_path: Path, cut: int) -> None:
    path = file_of(
        tmp_path / "x.mat", element(15, zlib.compress(bytes(100))), element(15, b"x" * 9)
    )
    path.write_bytes(path.read_bytes()[:cut])
    check_size(path)
