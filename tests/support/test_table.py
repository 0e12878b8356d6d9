"""All rows run, and those that fail are named."""

from __future__ import annotations

import pytest
from support.table import for_each


def test_every_row_runs_and_those_that_fail_are_named() -> None:
    seen = []

    @for_each((1, 2), "ab")
    def test(number: int, letter: str) -> None:
        seen.append((number, letter))
        assert letter != "a"

    with pytest.raises(ExceptionGroup, match="2 of 4 rows") as caught:
        test()
    assert seen == [(1, "a"), (1, "b"), (2, "a"), (2, "b")]
    assert [error.__notes__ for error in caught.value.exceptions] == [
        ["with 1, 'a'"],
        ["with 2, 'a'"],
    ]


def test_what_holds_for_all_rows_passes() -> None:
    @for_each((1, 2))
    def test(number: int) -> None:
        assert number

    test()


def test_a_table_without_rows_is_a_mistake() -> None:
    with pytest.raises(AssertionError):
        for_each(())
