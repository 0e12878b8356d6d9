"""Videos by the program ffmpeg."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from support.peer import program

from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.kits.record.lerobot.video import Video


def test_without_the_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(UnknownPlugin, match="install the program ffmpeg"):
        Video(tmp_path / "x.mp4", 64, 48, 30)


def test_odd_sizes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: "/bin/true")
    with pytest.raises(LocalProtocolError, match="an even number"):
        Video(tmp_path / "x.mp4", 63, 48, 30)
    assert not [*tmp_path.iterdir()]


@pytest.mark.peer("ffmpeg")
def test_a_video(tmp_path: Path) -> None:
    program("ffmpeg")
    video = Video(tmp_path / "v" / "x.mp4", 64, 48, 30)
    try:
        for level in range(5):
            video.add(np.full((48, 64, 3), level * 20, "u1"))
        with pytest.raises(LocalProtocolError, match="a picture of 32x48 pixels"):
            video.add(np.zeros((48, 32, 3), "u1"))
        video.finish()
    finally:
        video.close()
    assert video.path.read_bytes()[4:8] == b"ftyp"
