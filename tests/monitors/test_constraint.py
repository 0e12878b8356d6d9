"""Constraints: what they mean, and that no text breaks them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import LocalProtocolError
from yarpy.monitors.constraint import Constraint


def holds(text: str, *events: str) -> bool:
    return Constraint(text).holds(lambda name: name in events)


@pytest.mark.parametrize(
    ("text", "events", "expected"),
    [
        ("", "", True),
        ("  ", "", True),
        ("true", "", True),
        ("false", "", False),
        ("a", "a", True),
        ("a", "b", False),
        ("not a", "", True),
        ("not not a", "a", True),
        ("a and b", "a", False),
        ("a and b", "a b", True),
        ("a or b", "b", True),
        ("a or b and c", "a", True),
        ("(a or b) and c", "a", False),
        ("not a or b", "b", True),
        ("not (a or b)", "b", False),
        ("not(a)and(b)", "b", True),
        ("e_ball", "e_ball2", False),
        ("e_ball2", "e_ball", False),
        ("true and e", "e", True),
        ("nothing or android", "android", True),
        ("a\tor\nb", "b", True),
        ("\u00e9v\u00e9nement-1", "\u00e9v\u00e9nement-1", True),
    ],
)
def test_meaning(text: str, events: str, expected: bool) -> None:
    assert holds(text, *events.split()) is expected


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("and", "an event is missing"),
        ("not", 'an event is missing after "not"'),
        ("a or", 'missing after "or"'),
        ("a b", '"b" is superfluous'),
        ("(a", r'a "\)" is missing'),
        ("a)", r'"\)" is superfluous'),
        ("()", r'an event is missing after "\("'),
        ("(" * 200 + "a" + ")" * 200, "levels"),
        ("not " * 200 + "a", "levels"),
        ("a " * 10_000, "at most"),
    ],
)
def test_what_is_none_says_why(text: str, what: str) -> None:
    with pytest.raises(LocalProtocolError, match=what):
        Constraint(text)


WORDS = st.sampled_from(["a", "b", "c", "true", "false"])
EXPRESSION = st.recursive(
    WORDS,
    lambda inner: st.one_of(
        st.builds("not {}".format, inner),
        st.builds("({})".format, inner),
        st.builds("{} and {}".format, inner, inner),
        st.builds("{} or {}".format, inner, inner),
    ),
    max_leaves=12,
)


@given(EXPRESSION, st.sets(st.sampled_from("abc")))
def test_means_what_it_means_in_python(text: str, events: set[str]) -> None:
    """Its words bind as those of Python do."""
    values = {"true": True, "false": False, **{name: name in events for name in "abc"}}
    assert holds(text, *events) is eval(text, {}, values)


@given(st.text(alphabet="ab ()", max_size=30) | st.text(max_size=20))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        Constraint(text).holds(lambda name: True)
    except LocalProtocolError:
        pass
