"""Command lines; the rows were printed by C++ YARP for the same arguments."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.config.command_line import parse_options, parse_value

ROWS = [
    (["--a", "1", "2"], "(a 1 2)"),
    (["--flag"], "(flag)"),
    (["--n", "-5", "--m", "-x", "-y"], '(m 0 "-y") (n -5)'),
    (["--l", "(1 2 3)"], "(l (1 2 3))"),
    (["--s", "a b"], '(s "a b")'),
    (["--a::b", "3"], "(a (b 3))"),
    (["--a::b", "3", "--a::c", "4"], "(a (b 3) (c 4))"),
    (["--a::b::c", "3", "--a::b::d", "4"], "(a (b (c 3) (d 4)))"),
    (["--a::b", "3", "--a::b", "4"], "(a (b 4))"),
    (["--a", "1", "--a", "2"], "(a 2)"),
    (["--a", "1", "--a::b", "2"], "(a 1 (b 2))"),
    (["--a::b", "2", "--a", "1"], "(a 1)"),
    (["--::b", "3"], '("" (b 3))'),
    (["x", "--a", "1"], "(a 1)"),
    (["--", "x"], ""),
    (["--a", "a\\b", "\\"], '(a "a\\\\b" "\\\\")'),
    (["--v", "[abc]", "true", "1.5", "0x10"], "(v [abc] true 1.5 16)"),
    (["--q", '"x y"'], '(q "x y")'),
    (["--p", "/a//b", "http://x", "a=b"], '(p "/a//b" "http://x" "a=b")'),
    (["--k", "a,b", "a;b"], '(k "a,b" "a;b")'),
    (["--$HOME", "$HOME"], '("$HOME" "$HOME")'),
    (["--k", "{1 2}"], "(k {1 2})"),
    (["--k", "(a 1)", "(b 2)"], "(k (a 1) (b 2))"),
]


@pytest.mark.parametrize(("arguments", "expected"), ROWS)
def test_options(arguments: list[str], expected: str) -> None:
    assert parse_options(arguments).to_text() == expected


@pytest.mark.parametrize("text", ["", "(a", 'a"b', "a b", "(" * 500 + ")" * 500])
def test_what_is_no_value_stays_text(text: str) -> None:
    """C++ loses the unfinished ones; nobody means that."""
    assert parse_value(text) == text


@given(st.lists(st.text(max_size=12), max_size=8))
def test_any_command_line(arguments: list[str]) -> None:
    parse_options(arguments)
    parse_options([f"--{argument}" for argument in arguments])
