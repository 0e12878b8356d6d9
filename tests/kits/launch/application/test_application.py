"""The model of an application: command lines, places, circles."""

import pytest

from yarpy.kits.launch.application.application import Connection, Module, circle, split_words


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", []),
        ("  ", []),
        ("a b", ["a", "b"]),
        (' a  "b c" d ', ["a", "b c", "d"]),
        ('--name="my port" x', ["--name=my port", "x"]),
        ('"" a', ["", "a"]),
        ('a"b"c', ["abc"]),
        ('"a" "b"', ["a", "b"]),
        ('"open end', ["open end"]),
        ("it's", ["it's"]),
    ],
)
def test_words_of_a_command_line(text: str, words: list[str]) -> None:
    assert split_words(text) == words


@pytest.mark.parametrize(
    ("deployer", "command"),
    [
        ("", ["grabber", "--mode", "line"]),
        ("yarpdev", ["yarpdev", "--device", "grabber", "--mode", "line"]),
        ("python3 -u", ["python3", "-u", "grabber", "--mode", "line"]),
    ],
)
def test_command_of_a_module(deployer: str, command: list[str]) -> None:
    module = Module("x", "grabber", "--mode line", deployer=deployer)
    assert module.command == command


def test_a_connection_reads_well() -> None:
    assert Connection("/a", "/b").label == "/a -> /b"


def test_circles() -> None:
    def modules(**after: str) -> list[Module]:
        return [Module(name, name, after=others.split()) for name, others in after.items()]

    assert circle(modules(a="", b="a", c="a b")) == []
    assert circle(modules(a="b", b="c", c="b")) == ["b", "c", "b"]
    assert circle(modules(a="a")) == ["a", "a"]
    assert circle(modules(a="nobody")) == []
    chain = {f"m{n}": f"m{n + 1}" for n in range(5000)}
    assert circle(modules(**chain)) == []
