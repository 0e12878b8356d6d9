"""Why a file is not opened."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from yarpy.platform.refusal import reason


def test_a_folder_is_told_as_one(tmp_path: Path) -> None:
    with pytest.raises(OSError) as caught:
        tmp_path.read_bytes()
    assert reason(caught.value) == os.strerror(errno.EISDIR)


def test_what_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(OSError) as caught:
        (tmp_path / "none").read_bytes()
    assert reason(caught.value) == os.strerror(errno.ENOENT)


def test_words_of_whoever_raised_it() -> None:
    assert reason(PermissionError("it is not yours")) == "it is not yours"
    assert reason(PermissionError()) == "PermissionError"
