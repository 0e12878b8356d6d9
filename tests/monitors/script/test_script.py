"""Scripts: where they are found, and when they have changed."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.monitors.base import Place
from yarpy.monitors.script import script
from yarpy.monitors.script.script import Watch, find_script, read_script


@pytest.fixture
def place(tmp_path: Path) -> Place:
    def look(name: str, contexts: Sequence[str]) -> Iterable[Path]:
        yield tmp_path / "first" / name
        yield from (tmp_path / "contexts" / context / name for context in contexts)

    (tmp_path / "first").mkdir()
    (tmp_path / "contexts" / "app").mkdir(parents=True)
    return Place("/a", "/b", look=look)


ENDINGS = ("", ".lua")


def test_script_is_found_with_and_without_its_ending(place: Place, tmp_path: Path) -> None:
    (tmp_path / "first" / "one.lua").touch()
    (tmp_path / "contexts" / "app" / "two.lua").touch()
    (tmp_path / "contexts" / "app" / "three").mkdir()
    (tmp_path / "contexts" / "app" / "three.lua").touch()
    assert find_script(place, "one", "", ENDINGS) == tmp_path / "first" / "one.lua"
    assert find_script(place, "one.lua", "", ENDINGS) == tmp_path / "first" / "one.lua"
    app = tmp_path / "contexts" / "app"
    assert find_script(place, "two", "app", ENDINGS) == app / "two.lua"
    assert find_script(place, "three", "app", ENDINGS) == app / "three.lua"


def test_missing_script_says_where_it_was_looked_for(place: Place, tmp_path: Path) -> None:
    with pytest.raises(LocalProtocolError) as caught:
        find_script(place, "gone", "app", ENDINGS)
    text = str(caught.value)
    assert '"gone" or "gone.lua"' in text
    assert f"{tmp_path / 'first'}, {tmp_path / 'contexts' / 'app'}" in text
    with pytest.raises(LocalProtocolError, match=r"\+context\.NAME"):
        find_script(place, "two", "", ENDINGS)


def test_without_a_port_files_are_taken_by_their_path(tmp_path: Path) -> None:
    (tmp_path / "own.lua").touch()
    assert find_script(Place("/a", "/b"), str(tmp_path / "own"), "", ENDINGS).name == "own.lua"


def test_unreadable_and_huge_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(LocalProtocolError, match="cannot be read"):
        read_script(tmp_path)
    monkeypatch.setattr(script, "SCRIPT_FILE", 10)
    (tmp_path / "small").write_bytes(b"x" * 10)
    (tmp_path / "large").write_bytes(b"x" * 11)
    assert read_script(tmp_path / "small") == b"x" * 10
    with pytest.raises(LocalProtocolError, match="over 10 bytes"):
        read_script(tmp_path / "large")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no FIFOs")
def test_what_is_no_file_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "gate.lua")
    (tmp_path / "endless.lua").symlink_to("/dev/zero")
    for name in ("gate.lua", "endless.lua"):
        with pytest.raises(LocalProtocolError, match="cannot be read: it is no regular file"):
            read_script(tmp_path / name)


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def test_watch_asks_the_disk_now_and_then(tmp_path: Path) -> None:
    path, clock = tmp_path / "a.lua", Clock()
    path.write_text("1")
    watch = Watch(path, clock)
    path.write_text("22")
    assert not watch.changed()
    clock.now = 0.6
    assert [watch.changed(), watch.changed()] == [True, False]
    clock.now = 1.2
    assert not watch.changed()
    os.utime(path, (1, 1))
    clock.now = 1.8
    assert watch.changed()
    path.unlink()
    clock.now = 2.4
    assert not watch.changed()
    path.write_text("333")
    clock.now = 3.0
    assert watch.changed()
