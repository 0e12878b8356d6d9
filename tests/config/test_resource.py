"""The resource search: the order of places was compared with C++ YARP's own debug output."""

import os
from pathlib import Path

import pytest

from yarpy.config.resource import Search, context_home, find_file, robot_home


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    listing, top = tmp_path / "dd/config/path.d", tmp_path.as_posix()
    listing.mkdir(parents=True)
    (listing / "b.ini").write_text(f"[search B]\npath {top}/b1 {top}/b2\n")
    (listing / "a.ini").write_text(f'[search A]\npath "{top}/a"\n[search none]\n')
    (listing / "broken.ini").mkdir()
    (listing / "c.txt").write_text("[search C]\npath /c\n")
    return {
        "YARP_CONFIG_HOME": f"{tmp_path}/ch",
        "YARP_DATA_HOME": f"{tmp_path}/dh",
        "YARP_CONFIG_DIRS": f"{top}/cd1{os.pathsep}{top}/cd2",
        "YARP_DATA_DIRS": f"{tmp_path}/dd",
        "YARP_ROBOT_NAME": "rob",
    }


BASES = ["ch", "dh", "cd1", "cd2", "dd", "a", "b1", "b2"]


def test_order(environment: dict[str, str], tmp_path: Path) -> None:
    places = Search(environment, tmp_path, ("ctx",)).candidates("x.ini")
    assert [place.relative_to(tmp_path).as_posix() for place in places] == [
        "x.ini",
        *(f"{base}/robots/rob/x.ini" for base in BASES),
        *(f"{base}/contexts/ctx/x.ini" for base in BASES),
        *(f"{base}/x.ini" for base in BASES),
    ]


def test_near_the_main_file_contexts_do_not_count(
    environment: dict[str, str], tmp_path: Path
) -> None:
    search = Search(environment, tmp_path, ("ctx",), near=tmp_path / "sub")
    places = [place.relative_to(tmp_path).as_posix() for place in search.candidates("x.ini")]
    assert places[:3] == ["x.ini", "sub/x.ini", "ch/robots/rob/x.ini"]
    assert not any("contexts" in place for place in places)


def test_the_first_that_exists(environment: dict[str, str], tmp_path: Path) -> None:
    search = Search(environment, tmp_path, ("one", "two"))
    assert search.find("x.ini") is None
    expected = []
    for place in ("dd", "b2", "ch", "dh/contexts/two", "cd1/contexts/one", "dd/robots/rob", "."):
        file = tmp_path / place / "x.ini"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("")
        expected.append(file)
        assert search.find("x.ini") == (file if place != "b2" else expected[0])
    assert len(search.find_all("x.ini")) == 7
    assert search.find_all("x.ini")[0] == tmp_path / "x.ini"


def test_directories_and_absolute_names(environment: dict[str, str], tmp_path: Path) -> None:
    search = Search(environment, tmp_path)
    (tmp_path / "ch/meshes").mkdir(parents=True)
    assert search.find("meshes") is None
    assert search.find_directory("meshes") == tmp_path / "ch/meshes"
    file = tmp_path / "abs.ini"
    file.write_text("")
    assert search.find(str(file)) == file
    assert search.find(str(tmp_path / "other.ini")) is None
    assert search.find("") is None


def test_an_option_redirects(environment: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "other.ini").write_text("")
    search = Search(environment, tmp_path, values={"from": "other.ini", "empty": None})
    assert search.find("from") == tmp_path / "other.ini"
    assert search.find("empty") is None


def test_robot(environment: dict[str, str], tmp_path: Path) -> None:
    places = [*Search(environment, tmp_path, robot="r2").candidates("x")]
    assert tmp_path / "ch/robots/r2/x" in places
    del environment["YARP_ROBOT_NAME"]
    places = [*Search(environment, tmp_path).candidates("x")]
    assert tmp_path / "ch/robots/default/x" in places


def test_homes() -> None:
    assert context_home({"YARP_DATA_HOME": "/x"}, "ctx") == Path("/x/contexts/ctx")
    assert robot_home({"YARP_DATA_HOME": "/x"}) == Path("/x/robots/default")
    assert robot_home({"YARP_DATA_HOME": "/x", "YARP_ROBOT_NAME": "r"}) == Path("/x/robots/r")


def test_find_file(
    environment: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert find_file("auth.conf", environment, tmp_path) is None
    file = tmp_path / "dh/contexts/c/auth.conf"
    file.parent.mkdir(parents=True)
    file.write_text("")
    assert find_file("auth.conf", environment, tmp_path, contexts=["c"]) == file
    for key, value in environment.items():
        monkeypatch.setenv(key, value)
    monkeypatch.chdir(tmp_path)
    assert find_file("auth.conf") is None
    (tmp_path / "auth.conf").write_text("")
    assert find_file("auth.conf") == Path("auth.conf")
