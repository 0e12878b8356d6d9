"""A test of many small rows, as one test: what pytest and its workers do for each test takes longer
than most rows of recorded bytes.

    @for_each(rows("bottle"))
    def test_golden_texts(row): ...

Rules: every row runs, whatever became of the others, and what fails says which row it was. Rows
that wait, take fixtures or may be skipped are `pytest.mark.parametrize`'s.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from typing import Any


def for_each(*tables: Iterable[Any]) -> Callable[[Callable[..., None]], Callable[[], None]]:
    """Decorate a test, to run it with each row, or with each combination of rows of some tables."""
    rows = [*product(*tables)]
    assert rows

    def decorate(test: Callable[..., None]) -> Callable[[], None]:
        def run() -> None:
            failed = []
            for row in rows:
                try:
                    test(*row)
                except Exception as error:
                    error.add_note(f"with {', '.join(map(repr, row)):.500}")
                    failed.append(error)
            if failed:
                raise ExceptionGroup(f"{len(failed)} of {len(rows)} rows", failed)

        run.__name__, run.__qualname__ = test.__name__, test.__qualname__
        run.__module__, run.__doc__ = test.__module__, test.__doc__
        return run

    return decorate
