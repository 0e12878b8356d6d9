"""What cannot be opened says what to do. Cameras and gamepads try what is not there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from yarpy.kits.devices.hardware.device_file import open_device

WORDS = {"others": "pad*", "option": "--port", "absent": "plug one in", "group": "input"}


def test_a_file_that_is_there(tmp_path: Path) -> None:
    (tmp_path / "pad0").write_bytes(b"x")
    file = open_device(str(tmp_path / "pad0"), os.O_RDONLY, "pad", **WORDS)
    try:
        assert os.read(file, 2) == b"x"
    finally:
        os.close(file)


def test_a_file_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: str, flags: int) -> int:
        raise PermissionError(13, "Permission denied", path)

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(PermissionError, match=r"the pad at /dev/pad0 .*: sudo usermod -aG input"):
        open_device("/dev/pad0", os.O_RDONLY, "pad", **WORDS)
