"""A file that one process alone holds."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from support.wait import HANG

from yarpy.platform.file_lock import hold

OTHER = """
import sys
from yarpy.platform.file_lock import hold
with open(sys.argv[1], "r+b") as file:
    print(hold(file.fileno()), file.read())
"""


def other(path: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", OTHER, str(path)], capture_output=True, text=True, timeout=HANG
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_one_process_holds_it_and_others_read(tmp_path: Path) -> None:
    path = tmp_path / "held"
    path.write_bytes(b"words")
    with path.open("r+b") as file:
        assert hold(file.fileno())
        assert file.read() == b"words"
        assert other(path) == "False b'words'"
    assert other(path) == "True b'words'"


def test_a_process_that_ends_holds_nothing(tmp_path: Path) -> None:
    path = tmp_path / "held"
    path.touch()
    assert other(path) == "True b''"
    file = os.open(path, os.O_RDWR)
    assert hold(file)
    os.close(file)
