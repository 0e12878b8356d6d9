"""Pictures that come to a port, shown by a device."""

from __future__ import annotations

import numpy as np
import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.devices.frame_grabber.writer import FrameWriterServer
from yarpy.kits.devices.simulated.frame_writer import SimulatedFrameWriter
from yarpy.nameserver.local import LocalNames


def test_pictures_are_shown_in_rgb(names: LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    screen = SimulatedFrameWriter()
    with (
        FrameWriterServer("/screen", screen, names=names),
        yarpy.Port("/eye", names=names) as port,
    ):
        port.connect("/screen")
        picture = yarpy.Image(np.arange(24, dtype="u1").reshape(2, 4, 3))
        port.write(picture)
        wait_until(lambda: screen.count == 1)
        assert screen.last == picture
        port.write(yarpy.Image(np.full((2, 4), 7, "u1")))
        wait_until(lambda: screen.count == 2)
        assert screen.last is not None and screen.last.code == "rgb"
        assert (screen.last.array == 7).all()
        port.write(yarpy.Image(np.zeros((3, 3, 3), "u1")))  # another size
        port.write(yarpy.Bottle([1]))
        port.write(picture)
        wait_until(lambda: screen.count == 3)
    assert "a picture of 3 x 3 on a screen of (4, 2)" in caplog.text
    assert "not an Image" in caplog.text or "a picture" in caplog.text


def test_nothing_can_be_asked(names: LocalNames) -> None:
    with (
        FrameWriterServer("/screen", SimulatedFrameWriter(), names=names),
        yarpy.RpcClient("/screen/rpc", names=names) as client,
    ):
        assert client.call(yarpy.Bottle(["help"]), timeout=HANG) == ["fail"]


def test_what_shows_nothing_is_refused(names: LocalNames) -> None:
    with pytest.raises(ValueError, match=r"needs show\(image\)"):
        FrameWriterServer("/x", object(), names=names)
