"""A serial line."""

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
            found = b""
            while len(found) < 3:
                more = line.read(time.monotonic() + 10.0)
                assert more
                found += more
            assert found == b"\r\x00\x11"
    finally:
        os.close(slave)
        os.close(master)


@unix
def test_it_is_unplugged() -> None:
    master, slave = os.openpty()
    with Line(os.ttyname(slave), 115_200) as line:
        os.close(slave)
        os.close(master)
        with pytest.raises(OSError):
            line.read(time.monotonic() + 10.0)


@unix
def test_one_program_has_it() -> None:
    master, slave = os.openpty()
    try:
        with Line(os.ttyname(slave), 115_200), pytest.raises(OSError, match="exclusively"):
            Line(os.ttyname(slave), 115_200)
    finally:
        os.close(slave)
        os.close(master)


def test_no_such_line(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="none"):
        Line(str(tmp_path / "none"), 115_200)


def test_without_its_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "serial", None)
    with pytest.raises(UnknownPlugin, match=r"yarpy\[hardware"):
        Line("COM1", 115_200)
