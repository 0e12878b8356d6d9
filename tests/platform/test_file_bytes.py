"""Many pieces into a file, as much as the system takes, and bytes at a place of one."""

from __future__ import annotations

import io
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from yarpy.platform import file_bytes


def test_the_first_ones_are_written(tmp_path: Path) -> None:
    pieces = [memoryview(b"%d " % number * 100) for number in range(2000)]
    with io.FileIO(tmp_path / "x", "x") as file:
        done = file_bytes.write(file, pieces)
    assert (tmp_path / "x").read_bytes() == b"".join(pieces)[:done]
    assert done >= len(pieces[0])


def test_threads_share_a_file(tmp_path: Path) -> None:
    size = 10_000
    (tmp_path / "x").write_bytes(b"".join(bytes([number]) * size for number in range(8)))
    with open(tmp_path / "x", "rb") as file, ThreadPoolExecutor(8) as pool:
        handle = file.fileno()
        assert file_bytes.read_at(handle, size, 8 * size - 1) == b"\7"
        assert file_bytes.read_at(handle, size, 8 * size) == b""

        def wrong(number: int) -> int:
            wanted = bytes([number]) * size
            found = (file_bytes.read_at(handle, size, number * size) for _ in range(300))
            return sum(data != wanted for data in found)

        assert [*pool.map(wrong, range(8))] == [0] * 8
