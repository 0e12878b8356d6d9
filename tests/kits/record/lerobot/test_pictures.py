"""Pictures of videos by the program ffmpeg."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from support.peer import program

from yarpy.errors import DecodeError, UnknownPlugin
from yarpy.kits.record.lerobot.pictures import pictures
from yarpy.kits.record.lerobot.video import Video


@pytest.fixture
def video(tmp_path: Path) -> Path:
    """Twenty pictures, each brighter than the one before, at 10 a second."""
    program("ffmpeg")
    made = Video(tmp_path / "x.mp4", 64, 48, 10)
    try:
        for level in range(20):
            made.add(np.full((48, 64, 3), 10 * level, "u1"))
        made.finish()
    finally:
        made.close()
    return made.path


def test_without_the_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(UnknownPlugin, match="install the program ffmpeg"):
        next(pictures(tmp_path / "x.mp4", 0, 1, 10))


@pytest.mark.peer("ffmpeg")
@pytest.mark.parametrize("first", [0, 1, 7, 19])
@pytest.mark.parametrize("grey", [False, True])
def test_pictures_from_a_moment_on(video: Path, first: int, grey: bool) -> None:
    found = [*pictures(video, first / 10, 20 - first, 10, grey)]
    assert [str(one.code) for one in found] == ["mono" if grey else "rgb"] * (20 - first)
    levels = [one.array.mean() for one in found]
    assert levels == pytest.approx([10 * level for level in range(first, 20)], abs=4)


@pytest.mark.peer("ffmpeg")
def test_fewer_than_are_wanted(video: Path) -> None:
    found = pictures(video, 1.5, 10, 10)
    assert len([next(found) for _ in range(5)]) == 5
    with pytest.raises(DecodeError, match=r"has 5 of 10 pictures from 1\.500 s on"):
        next(found)


@pytest.mark.peer("ffmpeg")
def test_files_that_are_none(video: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(DecodeError, match="is not there"):
        next(pictures(tmp_path / "y.mp4", 0, 1, 10))
    data = video.read_bytes()
    list_ = tmp_path / "list.mp4"
    list_.write_text(f"#EXTM3U\n#EXTINF:1,\nfile:{video}\n", encoding="utf-8")
    with pytest.raises(DecodeError, match="has 0 of 1 pictures"):
        next(pictures(list_, 0, 1, 10))
    for cut in (0, 10, len(data) // 2, len(data) - 100):
        list_.write_bytes(data[:cut])
        with pytest.raises(DecodeError, match="has 0 of 20 pictures"):
            [*pictures(list_, 0, 20, 10)]
    monkeypatch.setenv("YARPY_MAX_PICTURE", "1000")
    with pytest.raises(DecodeError, match="has 0 of 1 pictures"):
        next(pictures(video, 0, 1, 10))
