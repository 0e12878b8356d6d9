"""Long texts: reading takes time in proportion to their length, whatever they are made of.

Rules: a text grows until its time tells something, so a fast parser, of which most time would go
unnoticed, reads a long one. `QUADRATIC` are parsers that must be found out: each is fast, and goes
through all that is left with each piece.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable

import pytest
from fuzz.grammar import GRAMMARS, Grammar, Shape, spelled

SIZES = (400, 1_260, 4_000, 12_600, 40_000, 126_000, 400_000)  # bytes; two steps are ten times
SLOWER = 30  # times, for ten times the length: a quadratic parser takes a hundred
NOISE = 0.005  # seconds that say nothing
ENOUGH = 0.01  # seconds after which a text of `LONG` bytes is the last one
LONG = 40_000

CASES = [
    pytest.param(grammar, shape, id=f"{name}-{b'*'.join(shape)[:40]!r}")
    for name, grammar in GRAMMARS.items()
    for shape in grammar.shapes
]


def took(grammar: Grammar, shape: Shape, size: int) -> float:
    """Return the seconds of this thread, whatever else the computer does; the collector of garbage,
    who now and then looks at all objects of the process, has a rest."""
    data = spelled(shape, size)
    gc.disable()
    try:
        start = time.thread_time()
        grammar.refuses(data)
        return time.thread_time() - start
    finally:
        gc.enable()


def too_slow(grammar: Grammar, shape: Shape) -> str:
    """Return how long two texts take of which the longer one takes too long, "" if none does."""
    times: dict[int, float] = {}
    for at, size in enumerate(SIZES):
        long = times[size] = took(grammar, shape, size)
        tenth = SIZES[at - 2] if at > 1 else size
        if long > max(NOISE, SLOWER * times[tenth]):
            # Memory that is new to the process makes the first time slower.
            short, long = (min(took(grammar, shape, n) for _ in range(3)) for n in (tenth, size))
            if long > SLOWER * short:
                return f"{tenth} bytes take {short} s, {size} take {long} s"
        if long > ENOUGH and size >= LONG:
            break
    return ""


@pytest.mark.parametrize(("grammar", "shape"), CASES)
def test_time_grows_with_the_length(grammar: Grammar, shape: Shape) -> None:
    assert too_slow(grammar, shape) == ""


def _cut_off(data: bytes) -> None:
    while data:
        data = data[8:]


def _lines_counted(data: bytes) -> list[int]:
    return [data.count(b"\n", 0, at) for at in range(0, len(data), 40)]


def _taken_from_the_front(data: bytes) -> None:
    pieces = data.split(b" ")
    while pieces:
        pieces.pop(0)


QUADRATIC: tuple[Callable[[bytes], object], ...] = (_cut_off, _lines_counted, _taken_from_the_front)


@pytest.mark.parametrize("read", QUADRATIC)
def test_a_quadratic_parser_is_found(read: Callable[[bytes], object]) -> None:
    assert too_slow(Grammar(read, ()), (b"", b"a b\n", b"")) != ""
