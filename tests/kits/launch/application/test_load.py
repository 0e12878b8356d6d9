"""Whole applications: nested ones, prefixes, labels, what only the whole shows."""

import os
from pathlib import Path

import pytest

from yarpy.errors import DecodeError, MissingFile
from yarpy.kits.launch.application.load import load

INNER = """<application><name>Inner</name>
<dependencies><port>/clock</port></dependencies>
<module><name>cam</name><prefix>/m</prefix></module>
<connection><from>/m/out</from><to external="true">/view</to></connection>
<connection><from>/clock</from><to>/view</to></connection>
</application>"""
OUTER = """<application><name>Outer</name><var name="v">7</var>
<module><name>cam</name></module><module><name>cam</name></module>
<application><name>Inner</name><prefix>/left</prefix></application>
<application><name>Inner</name><prefix>/right</prefix></application>
</application>"""


def write(folder: Path, **files: str) -> Path:
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text)
    return folder


def test_nested_applications_and_prefixes(tmp_path: Path) -> None:
    write(tmp_path, a_xml=OUTER, b_xml=INNER, c_xml="<module/>", d_xml="no XML")
    found = load(tmp_path / "a.xml")
    assert found.problems == []
    assert [(one.label, one.environment) for one in found.modules] == [
        ("cam", {}),
        ("cam-2", {}),
        ("cam-3", {"YARP_PORT_PREFIX": "/left/m"}),
        ("cam-4", {"YARP_PORT_PREFIX": "/right/m"}),
    ]
    assert [one.label for one in found.connections] == [
        "/left/m/out -> /view",
        "/clock -> /view",
        "/right/m/out -> /view",
        "/clock -> /view",
    ]
    assert [Path(file).name for file in found.files] == ["a.xml", "b.xml", "b.xml"]


def test_toml_takes_files_of_both_kinds(tmp_path: Path) -> None:
    write(tmp_path, b_xml=INNER, c_toml="[programs]\ncam = 'sleep 1'")
    write(tmp_path, a_toml="applications = [{file='b.xml', prefix='/p'}, 'c.toml']")
    found = load(tmp_path / "a.toml")
    assert [(one.label, one.prefix) for one in found.modules] == [("cam", "/p/m"), ("cam-2", "")]


def test_many_programs_of_one_name(tmp_path: Path) -> None:
    names = ["cam", "cam", "cam-3", "x/cam", "cam", "cam-2"]
    modules = "".join(f"<module><name>{name}</name></module>" for name in names)
    write(tmp_path, a_xml=f"<application>{modules}</application>")
    labels = [one.label for one in load(tmp_path / "a.xml").modules]
    assert labels == ["cam", "cam-4", "cam-3", "cam-5", "cam-6", "cam-2"]


def said(path: Path) -> list[str]:
    return [str(one).removeprefix(f"{path.parent}{os.sep}") for one in load(path).problems]


@pytest.mark.parametrize("name", ["a.toml", "a.xml"])
def test_one_with_nothing_in_it(tmp_path: Path, name: str) -> None:
    text = "name = 'a'" if name == "a.toml" else "<application><name>a</name></application>"
    (tmp_path / name).write_text(text)
    assert said(tmp_path / name) == [
        f"{name}: error: there are no programs and no connections in it"
    ]


def test_one_that_is_nowhere(tmp_path: Path) -> None:
    write(tmp_path, a_xml=OUTER.replace("Inner", "Iner"), b_xml=INNER)
    found = said(tmp_path / "a.xml")
    text = 'error: no file beside this one has the application "Iner": did you mean "Inner"?'
    assert found == [f"a.xml:{line}:1: {text}" for line in (3, 4)]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes in its folders")
def test_a_pipe_in_the_folder_is_no_application(tmp_path: Path) -> None:
    write(tmp_path, b_xml=OUTER, c_xml=INNER)
    os.mkfifo(tmp_path / "a.xml")  # opening it would wait for a writer
    assert load(tmp_path / "b.xml").problems == []


def test_circles_of_files_end(tmp_path: Path) -> None:
    other = "<application><name>{}</name><application><name>{}</name></application></application>"
    write(tmp_path, a_xml=other.format("A", "B"), b_xml=other.format("B", "A"))
    assert said(tmp_path / "a.xml") == ['b.xml:1:28: error: the application "A" contains itself']
    write(tmp_path, c_toml="applications = ['c.toml']")
    (problem,) = said(tmp_path / "c.toml")
    assert 'error: the application "c.toml" contains itself' in problem


def test_as_many_as_one_likes_are_refused(tmp_path: Path) -> None:
    """Twelve files, each of which takes the next one twice: four thousand applications."""
    for n in range(12):
        (tmp_path / f"{n}.toml").write_text(f"applications = ['{n + 1}.toml', '{n + 1}.toml']")
    (tmp_path / "12.toml").write_text("")
    with pytest.raises(DecodeError, match="more than 200 files"):
        load(tmp_path / "0.toml")


def test_what_only_the_whole_shows(tmp_path: Path) -> None:
    write(
        tmp_path,
        a_toml="""
connections = ["/a -> /b tpc", "/a -> /b", "c -> /d", "/e -> /f nonsense_carrier"]
[programs.x]
command = "x"
after = ["y"]
[programs.y]
command = "y"
after = ["x"]
[programs.z]
command = "z"
after = ["w"]
""",
    )
    assert said(tmp_path / "a.toml") == [
        'a.toml:9:1: error: "w", after which it starts, is no program',
        "a.toml:3:1: error: these wait for each other: x -> y -> x",
        'a.toml:2:17: warning: no carrier is called "tpc" here: did you mean "tcp"?',
        "a.toml:2:33: warning: /a -> /b is connected twice",
        'a.toml:2:45: warning: "c" begins with no slash: ports do',
        'a.toml:2:56: warning: no carrier is called "nonsense_carrier" here',
    ]


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(MissingFile, match="No such file"):
        load(tmp_path / "a.xml")
    write(tmp_path, m_xml="<module/>")
    with pytest.raises(DecodeError, match="no <application>"):
        load(tmp_path / "m.xml")
