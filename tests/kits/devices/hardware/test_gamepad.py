"""A gamepad of Linux, whose events come through a pipe with a name."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.wait import wait_until

from yarpy import Property
from yarpy.kits.devices import Joypad
from yarpy.kits.devices.hardware.gamepad import Gamepad, gamepad
from yarpy.nameserver.local import LocalNames

if sys.platform == "win32":
    pytest.skip("there are no pipes with names", allow_module_level=True)

# As the kernel writes them: four bytes of time, two of the value, kind, number.
BEGIN = bytes.fromhex(
    "10000000 0000 82 00 10000000 0080 82 01 10000000 0000 81 00".replace(" ", "")
)
PRESSED = bytes.fromhex("2000000001000102")
PUSHED = bytes.fromhex("20000000ff7f0200")


@pytest.fixture
def pipe(tmp_path: Path) -> Iterator[tuple[str, int]]:
    path = tmp_path / "js0"
    os.mkfifo(path)
    writer = os.open(path, os.O_RDWR)
    os.write(writer, BEGIN)
    yield str(path), writer
    os.close(writer)


def test_what_it_tells_at_first_is_known_at_once(pipe: tuple[str, int]) -> None:
    with Gamepad(pipe[0]) as pad:
        assert (pad.axis_count(), pad.button_count()) == (2, 1)
        assert (pad.axis(0), pad.axis(1), pad.button(0)) == (0.0, -1.0, 0.0)
        assert pad.stick_count() == pad.hat_count() == 0


def test_it_changes_as_it_is_used(pipe: tuple[str, int]) -> None:
    with Gamepad(pipe[0]) as pad:
        os.write(pipe[1], PRESSED + PUSHED[:3])  # events come in pieces only here
        wait_until(lambda: pad.button_count() == 3)
        assert [*pad.buttons().value] == [0.0, 0.0, 1.0]
        os.write(pipe[1], PUSHED[3:])
        wait_until(lambda: pad.axis(0) == 1.0)


def test_unplugged(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    path = tmp_path / "js0"
    os.mkfifo(path)
    writer = os.open(path, os.O_RDWR)
    os.write(writer, BEGIN + PUSHED)
    with Gamepad(str(path)) as pad:
        assert pad.axis(0) == 1.0
        os.close(writer)
        wait_until(lambda: pad.axis(0) == 0.0)
        assert pad.axis_count() == 2
    assert "nothing is plugged in" in caplog.text


def test_on_ports(pipe: tuple[str, int], names: LocalNames) -> None:
    pad = gamepad(Property(port=pipe[0]))
    assert isinstance(pad, Gamepad)
    with (
        pad,
        Joypad.serve("/pad", pad, names=names),
        Joypad.connect("/pad", names=names) as client,
    ):
        assert client.axis_count() == 2
        os.write(pipe[1], PUSHED)
        wait_until(lambda: client.axis(0) == 1.0)


def test_nothing_there(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"no gamepad at .*/js0: plug one in"):
        Gamepad(str(tmp_path / "js0"))
    (tmp_path / "js3").touch()
    with pytest.raises(FileNotFoundError, match=r"--port takes one of .*/js3$"):
        Gamepad(str(tmp_path / "js0"))


def test_somebody_elses(pipe: tuple[str, int], monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(path: str, flags: int) -> int:  # root may read everything
        raise PermissionError(13, "Permission denied", path)

    monkeypatch.setattr("yarpy.kits.devices.hardware.gamepad.os.open", refused)
    with pytest.raises(PermissionError, match="sudo usermod -aG input"):
        Gamepad(pipe[0])
