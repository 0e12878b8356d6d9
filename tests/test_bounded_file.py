"""Files that lie about their sizes, and parts that unpack to more than there is room for."""

from pathlib import Path
from typing import Any

import pytest

from yarpy.bounded_file import BoundedFile, limited_like
from yarpy.errors import DecodeError


def test_an_index_that_leads_to_the_same_place(tmp_path: Path) -> None:
    (tmp_path / "x.bag").write_bytes(bytes(1000))
    file = BoundedFile(tmp_path / "x.bag")
    found: Any = None
    with pytest.raises(DecodeError, match="the same place over and over"):
        for _ in range(3000):
            file.seek(0)
            found = file.read(1 << 40)
    assert len(found) == 1000 and file.place == 0 and str(file) == str(tmp_path / "x.bag")
    assert file.exists() and file.open("rb") is file and file.tell() == 1000
    file.close()


def test_a_file_without_an_index(tmp_path: Path) -> None:
    (tmp_path / "x.bag").write_bytes(b"first\n" + bytes(1000))
    file = BoundedFile(tmp_path / "x.bag")
    assert file.readline() == b"first\n"
    file.opened()
    for _ in range(3000):
        file.seek(6)
        assert len(file.read(1000)) == 1000
    file.close()


@pytest.mark.parametrize("name", ["bz2", "lz4.frame"])
def test_what_is_packed_unpacks_to_a_limit(name: str) -> None:
    library: Any = pytest.importorskip(name)
    packed = library.compress(bytes(100_000))
    unpack = limited_like(library.decompress, 100_000)
    assert unpack(packed) == bytes(100_000)
    for short in (packed[:-10], library.compress(bytes(100_001))):
        with pytest.raises(DecodeError, match="cut off, or has more than 100000 bytes"):
            unpack(short)


def test_what_is_not_packed_stays_as_it_is() -> None:
    def same(data: bytes) -> bytes:
        return data

    assert limited_like(same, 1) is same
