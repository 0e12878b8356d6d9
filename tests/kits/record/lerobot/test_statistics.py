"""What is said of features: of one episode, and of all."""

import numpy as np
import pytest

from yarpy.kits.record.lerobot.statistics import (
    SMALL,
    every,
    of_numbers,
    of_pictures,
    small,
    together,
)


def test_numbers() -> None:
    found = of_numbers([[0, 10], [1, 10], [2, 10]])
    assert found["min"].tolist() == [0, 10] and found["max"].tolist() == [2, 10]
    assert found["mean"].tolist() == [1, 10] and found["count"].tolist() == [3]
    assert found["std"].tolist() == pytest.approx([np.sqrt(2 / 3), 0])
    assert found["q50"].tolist() == [1, 10] and found["q01"][0] == pytest.approx(0.02)


def test_pictures() -> None:
    pictures = [np.full((2, 4, 3), level, "u1") for level in (0, 255)]
    pictures[1][..., 2] = 0
    found = of_pictures(pictures)
    assert found["mean"].shape == (3, 1, 1) and found["count"].tolist() == [2]
    assert found["max"].ravel().tolist() == [1, 1, 0]
    assert found["mean"].ravel().tolist() == [0.5, 0.5, 0]


def test_all_episodes_are_as_one() -> None:
    rows = np.random.default_rng(1).normal(size=(50, 3))
    found = together([of_numbers(rows[:10]), of_numbers(rows[10:])])
    whole = of_numbers(rows)
    for name in ("min", "max", "mean", "std", "count"):
        assert found[name] == pytest.approx(whole[name]), name


def test_how_much_is_looked_at() -> None:
    assert every(50) == every(100) == 1 and every(1000) == 5
    assert small(np.zeros((480, 640, 3), "u1")).shape == (120, 160, 3)
    assert small(np.zeros((SMALL, 20, 3), "u1")).shape == (SMALL, 20, 3)
