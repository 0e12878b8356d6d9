"""Random programs that failed once, each again; `property.py` says how they are judged."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from life.property import Run

HERE = Path(__file__).parent
SEEDS = [
    int(line.split()[0])
    for line in (HERE / "seeds.txt").read_text("utf-8").splitlines()
    if re.match(r"\d", line)
]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="these programs fork")
@pytest.mark.parametrize("seed", SEEDS)
def test_a_program_that_failed_once(seed: int) -> None:
    run = Run(300, seed)
    run.batch(seed, 1)
    assert (run.programs, run.failed) == (1, {})


def test_they_stay_few() -> None:
    """Each takes a second or three; whoever adds one takes out one that says the same."""
    assert 0 < len(SEEDS) <= 16
    assert len(set(SEEDS)) == len(SEEDS)
