"""Disks and sizes."""

from pathlib import Path
from typing import NamedTuple

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.capture.disk_space import (
    DiskSpace,
    Split,
    parse_size,
    parse_split,
    size_text,
)


class Disk(NamedTuple):
    total: int
    free: int


def test_a_disk_that_fills(tmp_path: Path) -> None:
    free = [50]
    room = DiskSpace(tmp_path, lambda where: Disk(100, free[0]))
    for left, state in ((50, ""), (11, ""), (10, "low"), (3, "low"), (2, "full"), (40, "")):
        free[0] = left
        assert room.look() == room.state == state and room.free == left


def test_a_disk_that_says_nothing(tmp_path: Path) -> None:
    def usage(where: Path) -> Disk:
        raise OSError

    assert DiskSpace(tmp_path, usage).look() == ""
    assert DiskSpace(tmp_path, lambda where: Disk(0, 0)).look() == ""
    assert DiskSpace(tmp_path).look() in ("", "low", "full")


@pytest.mark.parametrize(
    ("text", "size"),
    [("1", 1), ("4096 B", 4096), ("1k", 1000), ("1.5 GB", 1_500_000_000), ("2MiB", 1 << 21)],
)
def test_sizes(text: str, size: int) -> None:
    assert parse_size(text) == size
    assert parse_split(text) == Split(bytes=size)


@pytest.mark.parametrize("text", ["", "0", "-1", "1 kg", "much", "1e9", "0.2", "٣"])
def test_no_sizes(text: str) -> None:
    with pytest.raises(LocalProtocolError, match="is no size"):
        parse_size(text)
    with pytest.raises(LocalProtocolError, match="no size or time"):
        parse_split(text)


def test_times() -> None:
    assert parse_split("30s") == Split(seconds=30.0)
    assert parse_split("1.5 min") == Split(seconds=90.0)
    assert parse_split("2h") == Split(seconds=7200.0)


@pytest.mark.parametrize(
    ("size", "text"), [(0, "0 B"), (999, "999 B"), (999_600, "1 MB"), (3 * 10**12, "3 TB")]
)
def test_sizes_for_people(size: int, text: str) -> None:
    assert size_text(size) == text
