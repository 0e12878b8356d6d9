"""What is plugged in, in folders as Linux has them."""

from __future__ import annotations

from pathlib import Path

import pytest

from yarpy.kits.devices.catalogue import PURPOSES
from yarpy.kits.devices.hardware.plugged import plugged


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for path, text in {
        "dev/input/js0": "",
        "sys/class/input/js0/device/name": "Wireless Controller\n",
        "sys/class/video4linux/video0/name": "Integrated Camera: I\n",
        "sys/class/video4linux/video0/index": "0\n",
        "sys/class/video4linux/video1/name": "Integrated Camera: I\n",
        "sys/class/video4linux/video1/index": "1\n",
        "sys/bus/usb/devices/2-1/idVendor": "8086\n",
        "sys/bus/usb/devices/2-1/product": "Intel(R) RealSense(TM) Depth Camera 435i\n",
        "sys/bus/usb/devices/1-4/idVendor": "8086\n",
        "proc/asound/pcm": "00-00: ALC257 Analog : ALC257 Analog : playback 1 : capture 1\n",
        "dev/serial/by-id/usb-1a86_USB_Serial-if00-port0": "",
    }.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    return tmp_path


def test_what_is_there(root: Path) -> None:
    assert plugged(root) == [
        "yarpy dev gamepad --port /dev/input/js0    # Wireless Controller",
        "yarpy dev usbCamera --d /dev/video0    # Integrated Camera: I",
        "yarpy dev realsense2    # Intel(R) RealSense(TM) Depth Camera 435i",
        "yarpy dev portaudioRecorder --start 1    # microphone",
        "yarpy dev portaudioPlayer --start 1    # loudspeaker",
        "yarpy dev feetechServos|dynamixelServos|witmotionImu|xsensImu "
        "--port /dev/serial/by-id/usb-1a86_USB_Serial-if00-port0    # serial line",
    ]


def test_every_type_exists(root: Path) -> None:
    types = {each for line in plugged(root) for each in line.split()[2].split("|")}
    assert types <= PURPOSES.keys()


def test_nothing_is_there(tmp_path: Path) -> None:
    assert plugged(tmp_path) == []
