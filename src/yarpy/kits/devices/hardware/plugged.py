"""List what is plugged into this computer, as the lines that open it.

    plugged()[0]        "yarpy dev gamepad --port /dev/input/js0"

Rules: it looks at files of Linux alone, and opens nothing: a camera or a line that another program
has is listed too. Elsewhere there is nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

#: What an adapter of a serial line may lead to.
_LINES: Final = ("feetechServos", "dynamixelServos", "witmotionImu", "xsensImu")
_INTEL: Final = "8086"  # of USB


def plugged(root: Path = Path("/")) -> list[str]:
    """Return lines of a shell, each with a remark. root: where dev, sys and proc are."""
    return [*_pads(root), *_cameras(root), *_depth_cameras(root), *_audio(root), *_lines(root)]


def _pads(root: Path) -> Iterator[str]:
    for each in sorted((root / "dev/input").glob("js*")):
        name = _text(root / f"sys/class/input/{each.name}/device/name")
        yield _line(f"gamepad --port /dev/input/{each.name}", name)


def _cameras(root: Path) -> Iterator[str]:
    for each in sorted((root / "sys/class/video4linux").glob("video*")):
        if _text(each / "index") in ("", "0"):  # the others of a camera have no pictures
            yield _line(f"usbCamera --d /dev/{each.name}", _text(each / "name"))


def _depth_cameras(root: Path) -> Iterator[str]:
    for each in sorted((root / "sys/bus/usb/devices").glob("*")):
        name = _text(each / "product")
        if _text(each / "idVendor") == _INTEL and "RealSense" in name:
            yield _line("realsense2", name)


def _audio(root: Path) -> Iterator[str]:
    cards = _text(root / "proc/asound/pcm")
    if "capture" in cards:
        yield _line("portaudioRecorder --start 1", "microphone")
    if "playback" in cards:
        yield _line("portaudioPlayer --start 1", "loudspeaker")


def _lines(root: Path) -> Iterator[str]:
    for each in sorted((root / "dev/serial/by-id").glob("*")):
        yield _line(f"{'|'.join(_LINES)} --port /dev/serial/by-id/{each.name}", "serial line")


def _line(opened: str, what: str) -> str:
    return f"yarpy dev {opened}" + (f"    # {what}" if what else "")


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""
