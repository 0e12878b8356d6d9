"""A camera of Linux that is not there: frames as cameras send them, and a kernel that is ours."""

from __future__ import annotations

import errno
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

if sys.platform != "linux":
    pytest.skip("cameras are files of Linux", allow_module_level=True)

from support.v4l2_kernel import Frame, Kernel

from yarpy import Image, Property, Timeout
from yarpy.data.sig import jpeg
from yarpy.kits.devices import FrameGrabber, FrameGrabberServer
from yarpy.kits.devices.hardware import v4l2
from yarpy.kits.devices.hardware.v4l2 import Layout, V4l2Camera, from_yuyv, usb_camera
from yarpy.nameserver.local import LocalNames

# Y, U, Y, V of two pixels of one colour, as BT.601 has them, and these colours.
COLOURS = {
    "red": ("51 5a 51 f0", (255, 0, 0)),
    "green": ("91 36 91 22", (0, 255, 0)),
    "blue": ("29 f0 29 6e", (0, 0, 255)),
    "white": ("eb 80 eb 80", (255, 255, 255)),
    "black": ("10 80 10 80", (0, 0, 0)),
}


def kernel_at(monkeypatch: pytest.MonkeyPatch, folder: Path, **formats: tuple[int, int]) -> Kernel:
    found = Kernel(folder / "video0", formats)
    monkeypatch.setattr(v4l2, "ioctl", found.ioctl)
    monkeypatch.setattr(v4l2, "has_input", found.has_input)
    return found


def motion_jpeg(colour: tuple[int, int, int], size: tuple[int, int] = (64, 48)) -> bytes:
    """A picture of one colour, without the tables of Huffman, which cameras leave out."""
    data = jpeg.encode(Image(np.full((size[1], size[0], 3), colour, "u1")))
    while (at := data.find(b"\xff\xc4")) >= 0:
        data = data[:at] + data[at + 2 + int.from_bytes(data[at + 2 : at + 4], "big") :]
    return data


@pytest.mark.parametrize("name", COLOURS)
def test_yuyv(name: str) -> None:
    pair, colour = COLOURS[name]
    line = bytes.fromhex(pair) * 2 + b"padding!"
    found = from_yuyv(line * 3, Layout(4, 3, len(line)))
    assert found.shape == (3, 4, 3)
    assert np.abs(found.astype(int) - colour).max() <= 2


def test_two_pixels_of_a_pair() -> None:
    found = from_yuyv(bytes.fromhex("10 80 eb 80"), Layout(2, 1, 0))
    assert found.tolist() == [[[0, 0, 0], [255, 255, 255]]]
    with pytest.raises(ValueError, match="buffer is smaller"):
        from_yuyv(b"\x10\x80", Layout(2, 1, 0))


def test_motion_jpeg(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    kernel = kernel_at(monkeypatch, tmp_path, YUYV=(640, 480), MJPG=(64, 48))
    with V4l2Camera(str(kernel.path), (60, 50)) as camera:
        assert kernel.asked == ["MJPG 60x50"]
        assert camera.resolution == (64, 48)
        assert camera.description == ("usb", "Webcam")
        at = time.monotonic()
        kernel.frames += [
            Frame(motion_jpeg((0, 0, 255))),
            Frame(b"", flags=0x40),
            Frame(motion_jpeg((255, 0, 0)), 0x2000, at - 5.0),
        ]
        image = camera.image()
        assert image.shape == (48, 64, 3)
        assert np.abs(image.astype(int) - (255, 0, 0)).max() <= 3, "the newest one"
        assert camera.timestamp() == pytest.approx(
            time.time() - 5.0, abs=0.01 + time.monotonic() - at
        )
        assert sorted(kernel.queued) == [0, 1, 2], "all buffers are the camera's again"
        for n in range(7):
            kernel.frames.append(Frame(motion_jpeg((n, n, n))))
            assert abs(int(camera.image()[0, 0, 0]) - n) <= 2
    assert not kernel.streaming


def test_yuyv_where_there_is_nothing_else(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, names: LocalNames
) -> None:
    kernel = kernel_at(monkeypatch, tmp_path, YUYV=(4, 2))
    made: Any = usb_camera(Property(d=str(kernel.path)))
    with (
        made,
        FrameGrabberServer("/eye", made, 0.01, names=names),
        FrameGrabber("/eye", names=names) as eye,
    ):
        assert kernel.asked == ["MJPG 4x2", "YUYV 4x2"]
        kernel.frames += [Frame(bytes.fromhex("51 5a 51 f0") * 4)] * 1000
        assert np.abs(eye.image().array[0, 0].astype(int) - (255, 0, 0)).max() <= 2


def test_pixels_that_it_has_not(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    kernel = kernel_at(monkeypatch, tmp_path, H264=(640, 480))
    with pytest.raises(OSError, match=r"in MJPG or YUYV, but in H264: .*opencv_grabber"):
        V4l2Camera(str(kernel.path))
    with pytest.raises(ValueError, match="MJPG or YUYV, not RGB3"):
        V4l2Camera(str(kernel.path), pixels="RGB3")


def test_what_goes_wrong(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    kernel = kernel_at(monkeypatch, tmp_path, MJPG=(64, 48))
    monkeypatch.setattr(v4l2, "_WAITED", 0.0)
    with V4l2Camera(str(kernel.path)) as camera:
        with pytest.raises(Timeout, match="is it plugged in"):
            camera.image()
        kernel.frames.append(Frame(b"\xff\xd8 no picture"))
        with pytest.raises(Exception, match="JPEG"):
            camera.image()
        kernel.refused[v4l2.STOP] = OSError(errno.ENODEV, "gone")  # closing does not mind
    kernel = kernel_at(monkeypatch, tmp_path, MJPG=(64, 48))
    kernel.refused[v4l2.SET_FORMAT] = OSError(errno.EBUSY, "busy")
    with pytest.raises(OSError, match="video0: another program has it"):
        V4l2Camera(str(kernel.path))
    kernel.capabilities = 0x0400_0000
    with pytest.raises(OSError, match="gives no pictures"):
        V4l2Camera(str(kernel.path))


def test_nothing_there(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"no camera at .*/video0: plug one in"):
        V4l2Camera(str(tmp_path / "video0"))
    (tmp_path / "video2").touch()
    with pytest.raises(FileNotFoundError, match=r"--d takes one of .*/video2$"):
        V4l2Camera(str(tmp_path / "video0"))
    with pytest.raises(OSError, match="video2: Inappropriate ioctl"):
        V4l2Camera(str(tmp_path / "video2"))

    def refused(path: str, flags: int) -> int:  # root may open everything
        raise PermissionError(13, "Permission denied", path)

    monkeypatch.setattr("yarpy.kits.devices.hardware.v4l2.os.open", refused)
    with pytest.raises(PermissionError, match="sudo usermod -aG video"):
        V4l2Camera(str(tmp_path / "video2"))


def test_parameters_that_are_wrong() -> None:
    with pytest.raises(ValueError, match="a width and a height"):
        usb_camera(Property(width=640))
