"""A serial line as a file."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest

from yarpy.errors import UnknownPlugin
from yarpy.kits.devices.hardware.line import Line

unix = pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo terminals")


@unix
def test_bytes_both_ways() -> None:
    master, slave = os.openpty()
    try:
        with Line(os.ttyname(slave), 115_200) as line:
            line.write(b"\x03\n\xff")  # nothing is translated
            assert os.read(master, 100) == b"\x03\n\xff"
            assert line.read(time.monotonic()) == b""
            os.write(master, b"\r\x00\x11")
            assert line.read(time.monotonic() + 10.0) == b"\r\x00\x11"
    finally:
        os.close(slave)
        os.close(master)


@unix
def test_no_such_line(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="none"):
        Line(str(tmp_path / "none"), 115_200)
    with pytest.raises(ValueError, match="has 12345 baud"):
        Line("/dev/null", 12_345)


def test_windows_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    with pytest.raises(UnknownPlugin, match="Windows has none"):
        Line("COM1", 115_200)
