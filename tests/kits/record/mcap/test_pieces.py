"""Pieces on their way into a file."""

import io
from pathlib import Path

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.mcap.pieces import COMPRESSIONS, compressor, joined, write_all
from yarpy.platform import file_bytes


def test_small_pieces_are_joined_and_large_ones_are_not_copied() -> None:
    large = bytes(5000)
    found = joined([b"a", b"b", large, b"c", b"d"])
    assert found == [b"ab", large, b"cd"]
    assert found[1] is large


def test_all_of_it_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A system takes as much as it likes."""
    real = file_bytes.write
    monkeypatch.setattr(file_bytes, "write", lambda file, views: real(file, [views[0][:3]]))
    with io.FileIO(tmp_path / "x", "x") as file:
        assert write_all(file, [b"abcd", b"", b"efghijk"]) == 11
    assert (tmp_path / "x").read_bytes() == b"abcdefghijk"


@pytest.mark.parametrize("name", COMPRESSIONS)
def test_compressions(name: str) -> None:
    compress = compressor(name)
    assert (compress is None) == (name == "none")
    if compress is not None:
        assert len(compress(bytes(10_000))) < 1000


def test_an_unknown_compression() -> None:
    with pytest.raises(LocalProtocolError, match="none, lz4, zstd"):
        compressor("zip")
