"""ResourceFinder: what wins, where files are found, what is said about missing ones."""

from __future__ import annotations

from pathlib import Path

import pytest

import yarpy
from yarpy.resource import ResourceFinder


@pytest.fixture
def home(tmp_path: Path) -> dict[str, str]:
    """The environment of a user with a context `lab` and a robot."""
    files = {
        "contexts/lab/tracker.ini": "rate 30\nname /tracker\nmodel model.txt\n"
        '[left]\ngain 2\n[include "more.ini"]\n[import base "shared.ini"]\n',
        "contexts/lab/more.ini": "more $LAB_WORD\n",
        "contexts/base/shared.ini": "shared 1\n",
        "contexts/lab/model.txt": "of the lab",
        "contexts/other/tracker.ini": "rate 5\n",
        "robots/tiny/model.txt": "of the robot",
        "plain.txt": "",
    }
    for name, text in files.items():
        path = tmp_path / "data" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return {
        "YARP_DATA_HOME": str(tmp_path / "data"),
        "YARP_CONFIG_HOME": str(tmp_path / "config"),
        "YARP_DATA_DIRS": "",
        "YARP_CONFIG_DIRS": "",
        "LAB_WORD": "word",
    }


def finder(
    home: dict[str, str], tmp_path: Path, *arguments: str, file: str = "tracker.ini"
) -> ResourceFinder:
    work = tmp_path / "work"
    work.mkdir(exist_ok=True)
    return ResourceFinder(
        arguments,
        context="lab",
        file=file,
        defaults={"rate": 1, "depth": 7},
        environment=home,
        directory=work,
    )


def test_command_line_wins_over_file_and_file_over_defaults(home: dict[str, str], tmp_path: Path):
    found = finder(home, tmp_path, "--name", "/mine", "--verbose")
    assert found.find("name") == "/mine"
    assert found.find("rate") == 30
    assert found.find("depth") == 7
    assert found.find("nothing", "something") == "something"
    assert found.check("verbose") and found.find("verbose") is None
    assert not found.check("nothing")
    assert found.path == tmp_path / "data/contexts/lab/tracker.ini"


def test_sections_includes_and_variables(home: dict[str, str], tmp_path: Path):
    found = finder(home, tmp_path)
    group = found.group("left")
    assert group is not None and group.find("gain") == 2
    assert found.section("left").find("gain") == 2
    assert found.section("left").file("model.txt") is not None
    assert found.section("right").find("gain") is None
    assert found.find("more") == "word"
    assert found.find("shared") == 1


def test_context_and_from_choose_another_file(home: dict[str, str], tmp_path: Path):
    assert finder(home, tmp_path, "--context", "other").find("rate") == 5
    (tmp_path / "own.ini").write_text("rate 99\n")
    found = finder(home, tmp_path, "--from", str(tmp_path / "own.ini"))
    assert found.find("rate") == 99
    assert found.contexts == ["lab"]


def test_files_are_found_by_name_and_by_option(home: dict[str, str], tmp_path: Path):
    found = finder(home, tmp_path)
    lab = tmp_path / "data/contexts/lab/model.txt"
    assert found.file("model.txt") == lab
    assert found.file("model") == lab  # the option of that name
    assert found.file("nowhere.txt") is None
    robot = tmp_path / "data/robots/tiny/model.txt"
    tiny = finder({**home, "YARP_ROBOT_NAME": "tiny"}, tmp_path)
    assert tiny.files("model.txt") == [robot, lab]
    assert tiny.robot_home() == robot.parent
    assert found.directory("contexts") == tmp_path / "data/contexts"
    assert found.home() == lab.parent
    assert found.home("new") == tmp_path / "data/contexts/new"


def test_file_of_the_working_directory_hides_the_context(home: dict[str, str], tmp_path: Path):
    finder(home, tmp_path)
    (tmp_path / "work/tracker.ini").write_text("rate 2\n")
    found = finder(home, tmp_path)
    assert found.find("rate") == 2
    assert found.file("model.txt") is None  # of the context; that of plain names is found
    assert found.file("plain.txt") == tmp_path / "data/plain.txt"


def test_file_that_was_asked_for_must_be_there(home: dict[str, str], tmp_path: Path):
    with pytest.raises(yarpy.MissingFile, match=r'"no.ini" \(--from\) is nowhere; looked in'):
        finder(home, tmp_path, "--from", "no.ini")
    assert finder(home, tmp_path, file="no.ini").path is None


def test_file_that_cannot_be_read(
    home: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    def refuse(*arguments: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("yarpy.resource.read_ini", refuse)
    with pytest.raises(yarpy.MissingFile, match="Permission denied"):
        finder(home, tmp_path, "--from", "tracker.ini")
    assert finder(home, tmp_path).find("rate") == 1
