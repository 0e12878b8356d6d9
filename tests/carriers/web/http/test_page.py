"""Pages of programs, as values; what ports make of them is tested with the ports."""

from __future__ import annotations

import pytest

from yarpy.carriers.web.http.page import HTML, Page


def test_what_travels() -> None:
    assert Page("<p>\u00e9").encoded() == b"<p>\xc3\xa9"
    assert Page(b"\x00\xff", "image/png").encoded() == b"\x00\xff"
    assert Page("caf\udce9").encoded() == b"caf?"
    assert (Page("x").kind, Page("x").status) == (HTML, 200)
    with pytest.raises(AttributeError):
        Page("x").body = "y"  # type: ignore[misc]
