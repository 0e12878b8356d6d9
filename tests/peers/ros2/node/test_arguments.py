"""The command line of nodes: names, remappings, parameters, and what is not ours."""

import sys
from pathlib import Path

import pytest

from yarpy.errors import AddressError, UnknownPlugin
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.node.arguments import Arguments, parse_arguments, parse_value, read_file

ARM = Node("/robot", "arm")


def test_what_is_the_programs_own() -> None:
    found = parse_arguments(["me", "-v", "--ros-args", "-r", "a:=b", "--", "file", "--ros-args"])
    assert found.rest == ("me", "-v", "file")
    assert parse_arguments([]) == Arguments()
    assert parse_arguments(["-r", "a:=b"]).rules == ()  # not of ROS


@pytest.mark.parametrize(
    ("rules", "name"),
    [
        (["__node:=left"], "/robot/left"),
        (["__name:=left"], "/robot/left"),
        (["__ns:=/lab/two"], "/lab/two/arm"),
        (["__ns:=/", "__node:=left"], "/left"),
        (["other:__node:=left"], "/robot/arm"),
        (["arm:__node:=left", "__node:=right"], "/robot/left"),
    ],
)
def test_the_name_of_the_node(rules: list[str], name: str) -> None:
    words = [word for rule in rules for word in ("-r", rule)]
    assert str(parse_arguments(["--ros-args", *words]).node(ARM)) == name


@pytest.mark.parametrize(
    ("rule", "name", "found"),
    [
        ("chatter:=/news", "/robot/chatter", "/news"),
        ("chatter:=news", "/robot/chatter", "/robot/news"),
        ("/robot/chatter:=~/mine", "/robot/chatter", "/robot/arm/mine"),
        ("~/goal:=/goal", "/robot/arm/goal", "/goal"),
        ("chatter:=/news", "/chatter", "/chatter"),
        ("other:chatter:=/news", "/robot/chatter", "/robot/chatter"),
        ("arm:chatter:=/news", "/robot/chatter", "/news"),
        ("rosservice://chatter:=/news", "/robot/chatter", "/robot/chatter"),
        ("rostopic://chatter:=/news", "/robot/chatter", "/news"),
    ],
)
def test_remappings(rule: str, name: str, found: str) -> None:
    assert parse_arguments(["--ros-args", "--remap", rule]).remap(name, ARM) == found


def test_parameters() -> None:
    said = ["-p", "gain:=2", "-p", "arm:gain:=3.5", "-p", "leg:gain:=4", "-p", "on:=yes"]
    found = parse_arguments(["--ros-args", *said])
    assert found.parameters_of(ARM) == {"gain": 3.5, "on": True}
    assert found.parameters_of(Node("/", "leg")) == {"gain": 4, "on": True}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3),
        ("-0x10", -16),
        ("3.", 3.0),
        ("1e3", 1000.0),
        ("-.inf", float("-inf")),
        ("'3'", "3"),
        ("true", True),
        ("off", False),
        ("hello", "hello"),
        ("[1, 2]", [1, 2]),
        ("[1, 2.5]", [1.0, 2.5]),
        ("[a, 'b']", ["a", "b"]),
        ("", ""),
        ("99999999999999999999", 1e20),
    ],
)
def test_values(text: str, value: object) -> None:
    found = parse_value(text)
    assert found == value and type(found) is type(value)


def test_a_file(tmp_path: Path) -> None:
    path = tmp_path / "params.yaml"
    path.write_text(
        "/**:\n  ros__parameters:\n    rate: 10\n    pid: {p: 1.5, i: 0.0}\n"
        "robot:\n  arm:\n    ros__parameters: {rate: 20}\n"
        "/robot/leg:\n  ros__parameters: {rate: 30}\n"
        "/*/eye:\n  ros__parameters: {rate: 40}\n"
    )
    found = parse_arguments(["--ros-args", "--params-file", str(path)])
    assert found.parameters_of(ARM) == {"rate": 20, "pid.p": 1.5, "pid.i": 0.0}
    assert [found.parameters_of(Node("/robot", name))["rate"] for name in ("leg", "eye", "x")] == [
        30,
        40,
        10,
    ]


@pytest.mark.parametrize("text", ["a: [1", "3", "n:\n  ros__parameters: 3", "[1, a]: 3", "\0"])
def test_files_that_are_none(tmp_path: Path, text: str) -> None:
    path = tmp_path / "params.yaml"
    path.write_text(text)
    with pytest.raises(AddressError, match=r"params\.yaml"):
        read_file(str(path))
    with pytest.raises(AddressError, match="no file here"):
        read_file("/no file here")


@pytest.mark.parametrize(
    "words", [["-r"], ["-r", "a"], ["-r", ":=b"], ["-p", "a"], ["--bla"], ["-p", "a:=[1, b]"]]
)
def test_what_is_wrong(words: list[str]) -> None:
    with pytest.raises(AddressError):
        parse_arguments(["--ros-args", *words])


def test_logs() -> None:
    said = ["--log-level", "x:=debug", "--disable-rosout-logs", "--enable-stdout-logs", "-e", "/e"]
    found = parse_arguments(["--ros-args", *said])
    assert (found.log_level, found.rosout) == ("debug", False)


def test_without_a_reader_of_yaml(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "yaml", None)
    with pytest.raises(UnknownPlugin, match=r"yarpy\[ros2\]"):
        parse_value("3")
