"""Cameras and films that OpenCV opens, with a film made here."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from yarpy import Property
from yarpy.errors import UnknownPlugin
from yarpy.kits.devices import FrameGrabber, FrameGrabberServer
from yarpy.kits.devices.hardware.opencv import OpencvCamera, camera
from yarpy.nameserver.local import LocalNames


@pytest.fixture
def film(tmp_path: Path) -> str:
    """Three pictures: red, green, blue."""
    cv2: Any = pytest.importorskip("cv2")
    path = str(tmp_path / "film.avi")
    writer = cv2.VideoWriter(path, cv2.VideoWriter_fourcc(*"MJPG"), 10.0, (64, 48))
    assert writer.isOpened()
    for colour in range(3):
        picture = np.zeros((48, 64, 3), "u1")
        picture[:, :, 2 - colour] = 255  # of OpenCV: blue, green, red
        writer.write(picture)
    writer.release()
    return path


def colour(picture: Any) -> int:
    """The strongest of red, green and blue."""
    assert picture.shape == (48, 64, 3)
    return int(np.argmax(picture.mean(axis=(0, 1))))


def test_a_film_is_shown_once(film: str) -> None:
    with OpencvCamera(film) as shown:
        assert shown.resolution == (64, 48)
        assert [colour(shown.image()) for _ in range(3)] == [0, 1, 2]
        assert shown.timestamp() > 1e9
        assert shown.image() is None


def test_a_film_that_loops(film: str) -> None:
    made: Any = camera(Property(movie=film, loop=1))
    with made:
        assert [colour(made.image()) for _ in range(7)] == [0, 1, 2, 0, 1, 2, 0]


def test_on_ports(film: str, names: LocalNames) -> None:
    with (
        OpencvCamera(film, loop=True) as shown,
        FrameGrabberServer("/eye", shown, 0.01, names=names),
        FrameGrabber("/eye", names=names) as eye,
    ):
        picture = eye.image()
        assert (picture.width, picture.height) == (64, 48)
        assert eye.resolution == (64, 48)


def test_nothing_there(tmp_path: Path) -> None:
    pytest.importorskip("cv2")
    with pytest.raises(OSError, match="opens no"):
        OpencvCamera(str(tmp_path / "none.avi"))


def test_without_opencv(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(UnknownPlugin, match=r"yarpy\[vision\]"):
        OpencvCamera(0)


def test_parameters_that_are_wrong() -> None:
    for text, why in (
        ("(camera front)", "camera front is no number"),
        ("(camera 0) (width 640)", "a width and a height"),
        ("(camera 0) (w 640) (h high)", "a width and a height"),
    ):
        with pytest.raises(ValueError, match=why):
            camera(Property.from_text(text))
