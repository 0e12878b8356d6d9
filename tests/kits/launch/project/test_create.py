"""Projects: their files, and names that are none."""

import errno
import sys
import tomllib
from pathlib import Path

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.application.load import load
from yarpy.kits.launch.project.create import create


def test_files_are_whole(tmp_path: Path) -> None:
    written = create("ball-tracker", tmp_path)
    place = tmp_path / "ball-tracker"
    assert {path.relative_to(place).as_posix() for path in written} == {
        *("pyproject.toml", "README.md", "ball-tracker.ini", "ball-tracker.toml"),
        *("ball_tracker/__init__.py", "ball_tracker/module.py", "tests/test_module.py"),
    }
    for path in written:
        text = path.read_text()
        assert "$" not in text, path
        if path.suffix == ".py":
            compile(text, path, "exec")
    said = tomllib.loads((place / "pyproject.toml").read_text())
    assert said["project"]["scripts"] == {"ball-tracker": "ball_tracker.module:main"}
    application = load(place / "ball-tracker.toml")
    assert application.problems == [] and len(application.modules) == 3


@pytest.mark.parametrize("python", [r"C:\Program Files\new\python.exe", "/opt/a 'b'/python"])
def test_programs_are_called_as_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, python: str
) -> None:
    """Whatever is in the path of Python."""
    python = str(Path(python))
    monkeypatch.setattr(sys, "executable", python)
    create("mine", tmp_path)
    said = tomllib.loads((tmp_path / "mine" / "mine.toml").read_text("utf-8"))["programs"]
    assert said["module"]["command"] == [python, "-m", "mine.module", "--from", "mine.ini"]
    assert said["sink"]["command"] == [python, "-m", "yarpy", "read", "/mine/sink"]
    words = said["source"]["command"]
    assert words[:2] == [python, "-c"]
    compile(words[2], "source", "exec")


@pytest.mark.parametrize(
    ("name", "why"),
    [
        *((name, "write small letters") for name in ("", "Ball", "../x", "a b", "1a", "a" * 51)),
        *((name, "take another name") for name in ("json", "yarpy", "tests", "class")),
    ],
)
def test_names_that_are_none(tmp_path: Path, name: str, why: str) -> None:
    with pytest.raises(LocalProtocolError, match=why):
        create(name, tmp_path)
    assert [*tmp_path.iterdir()] == []


def test_what_is_there_is_not_touched(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    with pytest.raises(LocalProtocolError, match="is there already"):
        create("mine", tmp_path)
    assert [*(tmp_path / "mine").iterdir()] == []


def test_nothing_is_left_where_there_is_no_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The next attempt would find a folder of that name."""
    write = Path.write_text

    def fill(path: Path, text: str, encoding: str) -> int:
        if path.name == "module.py":
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, text, encoding)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "write_text", fill)
        with pytest.raises(OSError, match=r"No space left on device: .*mine"):
            create("mine", tmp_path)
    assert [*tmp_path.iterdir()] == []
    create("mine", tmp_path)
