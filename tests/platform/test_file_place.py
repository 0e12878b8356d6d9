"""A file in the place of another one that is read."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from support.wait import inside

from yarpy.platform import file_place


def test_a_file_is_replaced_and_removed(tmp_path: Path) -> None:
    path, draft = tmp_path / "it", tmp_path / "draft"
    for text in ("first", "second"):
        draft.write_text(text, "utf-8")
        file_place.replace(draft, path)
        assert path.read_text("utf-8") == text and not draft.exists()
    file_place.remove(path)
    assert not path.exists()
    file_place.remove(path)  # nothing is there


@pytest.mark.parametrize("what", ["replace", "remove"])
def test_who_reads_it_just_now_is_waited_for(tmp_path: Path, what: str) -> None:
    path, draft = tmp_path / "it", tmp_path / "draft"
    path.write_text("first", "utf-8")
    draft.write_text("second", "utf-8")
    reader = path.open(encoding="utf-8")
    # Elsewhere nobody is waited for.
    thread = inside("_tried", reader.close) if sys.platform == "win32" else None
    if what == "replace":
        file_place.replace(draft, path)
        assert path.read_text("utf-8") == "second"
    else:
        file_place.remove(path)
        assert not path.exists()
    reader.close()
    if thread is not None:
        thread.join()


def test_an_error_that_lasts_is_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_place, "MOMENT", 0.05)
    with pytest.raises(FileNotFoundError):
        file_place.replace(tmp_path / "none", tmp_path / "it")
    if sys.platform == "win32":
        path = tmp_path / "it"
        with path.open("w", encoding="utf-8"), pytest.raises(PermissionError):
            file_place.remove(path)
