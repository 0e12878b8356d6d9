"""Random: numbers between 0 and 1, or around 0."""

from __future__ import annotations

import random

_generator = random.Random()


class Random:
    """`Random.seed_c(1)`, `Random.uniform()`, `Random.normal()`."""

    @staticmethod
    def seed_c(seed: int) -> None:
        _generator.seed(seed)

    seed = seed_c

    @staticmethod
    def uniform(min: int | None = None, max: int | None = None) -> float:
        """A number between 0 and 1, or a whole one between two, both included."""
        if min is None or max is None:
            return _generator.random()
        return _generator.randint(min, max)

    @staticmethod
    def normal(m: float = 0.0, s: float = 1.0) -> float:
        """A number of the normal distribution."""
        return _generator.gauss(m, s)
