"""Values as JSON."""

import json
import sys

import pytest

import yarpy
from yarpy.cli.output import jsonable, print_json, print_line


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (yarpy.Bottle([1, 2.5, "x", True, yarpy.Vocab("ok")]), '[1, 2.5, "x", true, "[ok]"]'),
        (yarpy.Bottle([["a", 1], {"k": (2,)}]), '[["a", 1], {"k": [2]}]'),
        (yarpy.Int64(7), "7"),
        (yarpy.Float32(0.5), "0.5"),
        (b"\0\1", '{"type": "blob", "base64": "AAE="}'),
        (float("inf"), '"inf"'),
        (float("-inf"), '"-inf"'),
        (float("nan"), '"nan"'),
        (None, "null"),
        ("caf\udce9 é", '"caf� é"'),
    ],
)
def test_jsonable(value, expected):
    text = json.dumps(jsonable(value), ensure_ascii=False)
    assert text == expected
    assert json.loads(text) == json.loads(expected)


def test_one_object_is_one_line(capsys):
    print_json({"text": "two\nlines", "list": [1]})
    print_line("x")
    assert capsys.readouterr().out == '{"text": "two\\nlines", "list": [1]}\nx\n'


def test_a_terminal_is_told_nothing_that_it_would_obey(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    print_line("name \x1b[2J\tend")
    assert capsys.readouterr().out == "name \x1b[2J\tend\n"
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    print_line("name \x1b[2J\tend")
    assert capsys.readouterr().out == "name \\x1b[2J\tend\n"
