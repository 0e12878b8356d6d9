"""What others have written down at a port."""

from __future__ import annotations

from yarpy import limit
from yarpy.port.properties import Properties


def test_values_are_kept_by_key() -> None:
    properties = Properties()
    assert properties.get("b") is None
    assert properties.keep("b", 1) and properties.keep("a", [2, "three"])
    assert properties.keep("b", 4)
    assert properties.get("b") == 4
    assert properties.sorted() == [("a", [2, "three"]), ("b", 4)]


def test_all_together_take_no_more_than_is_allowed() -> None:
    properties = Properties()
    half = "x" * (limit.PROPERTIES // 2)
    assert properties.keep("a", half)
    assert not properties.keep("b", half) and properties.get("b") is None
    assert properties.keep("a", "short") and properties.keep("b", half)  # there is room again
