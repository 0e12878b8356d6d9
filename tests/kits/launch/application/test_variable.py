"""Variables of applications."""

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.launch.application.variable import expand


@pytest.mark.parametrize(
    ("text", "expected", "missing"),
    [
        ("plain", "plain", []),
        ("/${a}/x", "/1/x", []),
        ("${a}${a}", "11", []),
        ("$ENV{HOME}/y", "/home/y", []),
        ("${b}", "", ["${b}"]),
        ("$ENV{NO}", "", ["$ENV{NO}"]),
        ("${${name}}", "1", []),
        ("$ENV{WITH}", "1", []),
        ("5 $ and $x", "5 $ and $x", ["$"]),
    ],
)
def test_expansion(text: str, expected: str, missing: list[str]) -> None:
    variables = {"a": "1", "name": "a"}
    assert expand(text, variables, {"HOME": "/home", "WITH": "${a}"}) == (expected, missing)


def test_growth_is_bounded() -> None:
    text, variables = "x" * 100, {}
    with pytest.raises(DecodeError, match="longer than"):
        for n in range(64):
            variables[f"v{n}"] = text
            text, _ = expand(f"${{v{n}}}" * 2, variables, {})


def test_what_makes_itself_again_ends() -> None:
    text, _ = expand("${a}{a}", {"a": "${a}$"}, {})
    assert len(text) < 100
