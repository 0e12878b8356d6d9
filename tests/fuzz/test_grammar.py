"""Long texts: reading takes time in proportion to their length, whatever they are made of."""

from __future__ import annotations

import gc
import time

import pytest
from fuzz.grammar import GRAMMARS, Grammar, Shape, spelled

SHORT, LONG = 6_000, 60_000
SLOWER = 30  # times, for ten times the length: a quadratic parser takes a hundred
AT_ONCE = 0.1  # seconds that say nothing: a quadratic parser takes longer

CASES = [
    pytest.param(grammar, shape, id=f"{name}-{b'*'.join(shape)[:40]!r}")
    for name, grammar in GRAMMARS.items()
    for shape in grammar.shapes
]


def took(grammar: Grammar, shape: Shape, size: int) -> float:
    """Seconds of this thread, whatever else the computer does; the collector of garbage, who now
    and then looks at all objects of the process, has a rest."""
    data = spelled(shape, size)
    gc.disable()
    try:
        start = time.thread_time()
        grammar.refuses(data)
        return time.thread_time() - start
    finally:
        gc.enable()


@pytest.mark.parametrize(("grammar", "shape"), CASES)
def test_time_grows_with_the_length(grammar: Grammar, shape: Shape) -> None:
    # A quadratic parser would need minutes for what is tried last.
    for size in (SHORT // 4, SHORT):
        assert took(grammar, shape, size) < 2.0, f"{size} bytes take seconds"
    long = took(grammar, shape, LONG)
    if long > AT_ONCE:
        short = min(took(grammar, shape, SHORT) for _ in range(3))
        # Memory that is new to the process makes the first time slower.
        assert min(long, took(grammar, shape, LONG)) < SLOWER * short
