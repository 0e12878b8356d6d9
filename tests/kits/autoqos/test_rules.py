"""Rules of autoqos: what they match, and what is told of mistakes."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import LocalProtocolError
from yarpy.kits.autoqos.rules import Rules, load, parse

GOOD = """\
# what matters
[[critical]]
connections = ["/icub/*/command:i", "/control -> /motors"]
deadline = 0.01
rate = 100

[[best-effort]]
connections = ["/cam/*"]
least = 2
carrier = "tcp+send.adaptive+recv.image_compression_jpeg"
"""


def kinds(rules: Rules, source: str, target: str) -> list[str]:
    return [rule.kind for rule in rules.of(source, target)]


def test_what_matches() -> None:
    rules = parse(GOOD)
    first, second = rules.rules
    assert (first.deadline, first.rate, first.line) == (0.01, 100, 2)
    assert (second.least, second.line) == (2, 7)
    assert second.carrier.startswith("tcp+send.adaptive")
    assert kinds(rules, "/me", "/icub/head/command:i") == ["critical"]
    assert kinds(rules, "/control", "/motors") == ["critical"]
    assert kinds(rules, "/motors", "/control") == []
    assert kinds(rules, "/cam/left", "/viewer") == ["best-effort"]
    assert kinds(rules, "/cam/left", "/icub/arm/command:i") == ["critical", "best-effort"]


def test_the_first_of_a_kind_counts() -> None:
    rules = parse(
        '[[critical]]\nconnections=["/a"]\ndeadline=1\n[[critical]]\nconnections=["/*"]\ndeadline=2'
    )
    assert [rule.deadline for rule in rules.of("/a", "/b")] == [1]
    assert [rule.deadline for rule in rules.of("/c", "/b")] == [2]


@pytest.mark.parametrize(
    ("text", "line", "told"),
    [
        ("", 1, "at least one table"),
        ("[[important]]\nx = 1", 1, r"expected \[\[critical\]\] or"),
        ("critical = 3", 1, "expected tables"),
        ("\n[critical]\ndeadline = 1", 2, "expected tables"),
        ('[[critical]]\nconnections = ["/a"]', 1, "expected a deadline"),
        ('[[critical]]\nconnections = "/a"\ndeadline = 1', 2, "a list of patterns"),
        ("[[critical]]\nconnections = []\ndeadline = 1", 2, "a list of patterns"),
        ('[[critical]]\ndeadline = 1\nconnections = ["a b"]', 3, "no pattern"),
        ('[[critical]]\ndeadline = 1\nconnections = ["/a -> /b -> /c"]', 3, "no pattern"),
        ('[[critical]]\nconnections = ["/a"]\ndeadline = 0', 3, "a number 0.0001 to 3600"),
        ('[[critical]]\nconnections = ["/a"]\ndeadline = true', 3, "expected a number"),
        ('[[critical]]\nconnections = ["/a"]\ndeadline = 1\nrate = "fast"', 4, "expected a number"),
        ('[[critical]]\nconnections = ["/a"]\ndeadline = nan', 3, "expected a number"),
        ('[[critical]]\nconnections = ["/a"]\ndeadline = 1\nleast = 3', 4, "expected connections"),
        ('[[best-effort]]\nconnections = ["/a"]\nleast = -1', 3, "expected a number"),
        ('[[best-effort]]\nconnections = ["/a"]\ncarrier = 3', 3, "text in quotes"),
        ('[[best-effort]]\nconnections = ["/a"]\ncarrier = "no such"', 3, "one such as"),
        (
            '[[critical]]\nconnections = ["/a"]\ndeadline = 1\n'
            '[[best-effort]]\nconnections = ["/a"]',
            4,
            "stands in line 1 already, as critical",
        ),
    ],
)
def test_mistakes(text: str, line: int, told: str) -> None:
    with pytest.raises(LocalProtocolError, match=told) as caught:
        parse(text, "rules.toml")
    assert str(caught.value).startswith(f"rules.toml, line {line}: ")


def test_what_is_no_toml_is_told_with_its_line() -> None:
    with pytest.raises(LocalProtocolError, match=r"rules.toml: this is not TOML: .*line 2"):
        parse("[[critical]]\nconnections = x\n", "rules.toml")


def test_files(tmp_path: Path) -> None:
    file = tmp_path / "rules.toml"
    with pytest.raises(LocalProtocolError, match="cannot be read"):
        load(file)
    file.write_bytes(b"\xff\xfe")
    with pytest.raises(LocalProtocolError, match="cannot be read"):
        load(file)
    file.write_text(GOOD)
    assert load(file).where == str(file)


@given(st.text(max_size=60))
def test_any_text_is_rules_or_a_mistake(text: str) -> None:
    for whole in (text, f"[[critical]]\ndeadline = 1\nconnections = [{text!r}]"):
        try:
            parse(whole).of("/a", "/b")
        except LocalProtocolError:
            pass
