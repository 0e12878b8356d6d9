"""The words of commands and environments."""

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.run.command_line import joined, variables_of, words_of
from yarpy.limit import RUN_COMMAND


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("sleep 60", ["sleep", "60"]),
        ('  yarpdev  --name "/my cam" ', ["yarpdev", "--name", "/my cam"]),
        ("echo 'a b' $HOME; rm \\x # y", ["echo", "'a", "b'", "$HOME;", "rm", "\\x", "#", "y"]),
        ('x --name="a b"', ["x", "--name=a b"]),
    ],
)
def test_words(command: str, words: list[str]) -> None:
    assert words_of(command) == words


@pytest.mark.parametrize("command", ["", '""', "  ", 'x "y', "x\0y", "x" * (RUN_COMMAND + 1)])
def test_what_is_no_command(command: str) -> None:
    with pytest.raises(LocalProtocolError):
        words_of(command)


def test_words_come_back() -> None:
    words = ["a", "b c", "", "'d'", "$e"]
    assert words_of(joined(words)) == words
    with pytest.raises(LocalProtocolError, match="quote"):
        joined(['a"b'])


def test_variables() -> None:
    assert variables_of("FOO=bar;BAZ=a=b; ;") == {"FOO": "bar", "BAZ": "a=b"}
    for text in ("FOO", "=x", "A=\0", "A=" + "x" * RUN_COMMAND):
        with pytest.raises(LocalProtocolError):
            variables_of(text)
