"""The user that this program runs as."""

from __future__ import annotations

import sys
from pathlib import Path

from yarpy.platform.user import user


def test_files_that_we_make_are_ours(tmp_path: Path) -> None:
    made = tmp_path / "made"
    made.touch()
    assert user() == (None if sys.platform == "win32" else made.stat().st_uid)
