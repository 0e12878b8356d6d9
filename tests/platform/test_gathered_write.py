"""Many pieces on their way into a file, as much as the system takes."""

from __future__ import annotations

import io
from pathlib import Path

from yarpy.platform import gathered_write


def test_the_first_ones_are_written(tmp_path: Path) -> None:
    pieces = [memoryview(b"%d " % number * 100) for number in range(2000)]
    with io.FileIO(tmp_path / "x", "x") as file:
        done = gathered_write.write(file, pieces)
    assert (tmp_path / "x").read_bytes() == b"".join(pieces)[:done]
    assert done >= len(pieces[0])
