"""Web tokens in requests: where they are found, and that nobody sees them afterwards."""

from __future__ import annotations

import doctest

import pytest

from yarpy.carriers.web.http import token
from yarpy.carriers.web.http.token import Shown, claim, cookie, taken
from yarpy.wire.effects import Claim

GOOD = "4Zr2kXqyJtWm0v8N"


def test_examples_in_the_docstrings() -> None:
    assert doctest.testmod(token).failed == 0


@pytest.mark.parametrize(
    ("target", "rest", "found"),
    [
        ("/", "/", ""),
        ("/?", "/?", ""),
        ("/?token=x", "/", "x"),
        ("/?ws&read&token=x", "/?ws&read", "x"),
        ("/?a=1&token=x&token=y", "/?a=1", "x"),
        ("/r?tokens=x", "/r?tokens=x", ""),
        ("/?token", "/", ""),
    ],
)
def test_in_the_address(target: str, rest: str, found: str) -> None:
    assert taken(target) == (rest, found)


def judged(target: str, headers: dict[str, str], known: tuple[str, ...] | None) -> Shown:
    """What comes of a request where those tokens are known; None: none are."""
    steps = claim(target, headers)
    effect = next(steps)
    try:
        while True:
            assert isinstance(effect, Claim)
            effect = steps.send(None if known is None else effect.token in ("", *known))
    except StopIteration as stop:
        shown: Shown = stop.value
        return shown


@pytest.mark.parametrize(
    ("target", "headers", "expected"),
    [
        ("/?token=" + GOOD, {}, Shown("/", token=GOOD)),
        ("/a", {"authorization": f"Bearer {GOOD}"}, Shown("/a")),
        ("/a", {"authorization": f"bearer  {GOOD} "}, Shown("/a")),
        ("/a", {"authorization": "Basic xyz"}, Shown("/a")),
        ("/a", {"cookie": f"x=1; yarpy-token={GOOD}"}, Shown("/a")),
        ("/a", {"cookie": "yarpy-token=old"}, Shown("/a")),  # of another computer's port
        ("/a?token=bad", {"cookie": f"yarpy-token={GOOD}"}, Shown("/a", token.UNKNOWN)),
        ("/a", {"authorization": "Bearer bad"}, Shown("/a", token.UNKNOWN)),
        ("/a", {}, Shown("/a")),
    ],
)
def test_where_tokens_are_known(target: str, headers: dict[str, str], expected: Shown) -> None:
    assert judged(target, headers, (GOOD,)) == expected


def test_where_none_are_it_is_an_argument() -> None:
    assert judged("/?req=say+$token&token=x", {}, None) == Shown("/?req=say+$token&token=x")


def test_no_script_reads_the_cookie() -> None:
    name, value = cookie(GOOD, secure=False)
    assert name == "Set-Cookie"
    assert value == f"yarpy-token={GOOD}; Path=/; HttpOnly; SameSite=Strict"
    assert cookie(GOOD, secure=True)[1].endswith("; Secure")
