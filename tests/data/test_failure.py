"""Exceptions of handlers on their way to a client."""

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.failure import answer_of, error_of, marked, raised
from yarpy.data.value import Vocab
from yarpy.errors import RemoteError


@pytest.mark.parametrize(
    ("error", "kind", "text"),
    [
        (ZeroDivisionError("division by zero"), "ZeroDivisionError", "division by zero"),
        (ValueError("a: b"), "ValueError", "a: b"),
        (KeyError("name"), "KeyError", "'name'"),
        (RuntimeError(), "RuntimeError", ""),
        (RemoteError("no such joint", "IndexError"), "IndexError", "no such joint"),
        (RemoteError("said without a type"), "RemoteError", "said without a type"),
    ],
)
def test_an_exception_arrives_as_it_left(error, kind, text):
    answer = answer_of(error)
    assert answer[0] == Vocab("fail")  # what C++ looks at
    assert answer[1] == f"{kind}: {text}"
    for spelled in (Bottle.from_bytes(answer.to_bytes()), Bottle.from_text(answer.to_text())):
        found = error_of(spelled)
        assert found is not None
        assert (found.type, found.text) == (kind, text)


@pytest.mark.parametrize(
    "answer",
    [
        "[fail]",
        '[fail] "no such joint"',
        '[fail] "ValueError: x"',
        '[fail] "ValueError: x" raised ValueError',
        '[fail] "ValueError: x" (raised)',
        '[fail] "ValueError: x" (raised ValueError 1)',
        '[fail] "ValueError: x" (other ValueError)',
        "[fail] 1 (raised ValueError)",
        '[ok] "ValueError: x" (raised ValueError)',
        '[fail] "ValueError: x" (raised ValueError) 1',
        "",
    ],
)
def test_other_answers_are_values(answer):
    assert error_of(Bottle.from_text(answer)) is None


def test_what_is_no_list_is_a_value():
    assert error_of("[fail]") is None
    assert marked("raised") == ""
    assert marked(raised("A", "b")[2]) == "A"
