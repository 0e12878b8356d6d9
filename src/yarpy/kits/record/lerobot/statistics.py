"""Statistics of a data set of LeRobot, by which policies scale what they see: min, max, mean, std,
count and five quantiles of each feature, of each episode and of all.

Rules: pure. Numbers are taken one by one of a vector; pictures by channel, from 0 to 1, of some
frames that are made small.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

QUANTILES: Final = {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}
SAMPLES: Final = 100  # pictures of an episode that are looked at, at least
SMALL: Final = 150  # pixels of a picture that is looked at

Statistics = dict[str, Any]  # arrays by their names


def of_numbers(rows: Any) -> Statistics:
    """Return those of an array of shape (frames, width)."""
    rows = np.asarray(rows, "f8")
    found = {
        "min": rows.min(axis=0),
        "max": rows.max(axis=0),
        "mean": rows.mean(axis=0),
        "std": rows.std(axis=0),
        "count": np.array([len(rows)]),
    }
    return found | {name: np.quantile(rows, q, axis=0) for name, q in QUANTILES.items()}


def every(frames: int) -> int:
    """Return of how many pictures one is looked at."""
    return max(1, frames // max(SAMPLES, int(frames**0.75)))


def small(picture: Any) -> Any:
    """Return some of the pixels of a picture."""
    step = max(1, max(picture.shape[:2]) // SMALL)
    return picture[::step, ::step].copy()


def of_pictures(pictures: Sequence[Any]) -> Statistics:
    """Return those of pictures of shape (height, width, 3), uint8."""
    pixels = np.concatenate([one.reshape(-1, one.shape[-1]) for one in pictures]) / 255
    found = of_numbers(pixels)
    found = {name: value.reshape(-1, 1, 1) for name, value in found.items()}
    return found | {"count": np.array([len(pictures)])}


def together(episodes: Sequence[Statistics]) -> Statistics:
    """Return those of all episodes: quantiles are the means of theirs, by their lengths."""
    counts = np.array([one["count"][0] for one in episodes], "f8")
    weights = counts / counts.sum()

    def mean(name: str) -> Any:
        return np.tensordot(weights, np.stack([one[name] for one in episodes]), 1)

    middle = mean("mean")
    squares = [one["std"] ** 2 + (one["mean"] - middle) ** 2 for one in episodes]
    return {
        "min": np.min([one["min"] for one in episodes], axis=0),
        "max": np.max([one["max"] for one in episodes], axis=0),
        "mean": middle,
        "std": np.sqrt(np.tensordot(weights, np.stack(squares), 1)),
        "count": np.array([int(counts.sum())]),
        **{name: mean(name) for name in QUANTILES},
    }
