"""Lines that a person typed: what vanishes from them is told."""

import pytest

import yarpy
from yarpy.cli.typed import bottle


@pytest.mark.parametrize(
    ("line", "sent", "told"),
    [
        ("(1 2", "empty", 'a bracket "(" is not closed'),
        ("set ((1 2) 3", "set", 'a bracket "(" is not closed'),
        ('say "hello', "say", "a quotation mark is not closed"),
        ('(say "hello', "empty", "a quotation mark is not closed"),
        ("1 2)", "1", 'there is a bracket ")" too many'),
        ("(1) 2)", "(1)", 'there is a bracket ")" too many'),
    ],
)
def test_what_vanishes_is_told(
    line: str, sent: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert bottle(line) == yarpy.Bottle.from_text(line)
    assert capsys.readouterr().err == f"warning: {told}: what is sent is {sent}\n"


@pytest.mark.parametrize(
    "line", ["", "hello 1", "a (b (c))", 'say "(" x', 'say ")"', "it's (ok)", '"a \\" b"', "{1 2}"]
)
def test_what_is_whole_is_not_talked_about(line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert bottle(line) == yarpy.Bottle.from_text(line)
    assert capsys.readouterr().err == ""


def test_bounds() -> None:
    with pytest.raises(yarpy.DecodeError, match="deep"):
        bottle("(" * 10_000)
    assert len(bottle("(" * 90 + "x")) == 0
