"""Waiting for what other threads do."""

from __future__ import annotations

import time
from collections.abc import Callable


def wait_until(condition: Callable[[], object], patience: float = 5.0, what: str = "") -> None:
    """Return as soon as `condition` holds; AssertionError if it does not in time."""
    deadline = time.monotonic() + patience
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"after {patience} s still not: {what or condition}")
        time.sleep(0.002)
