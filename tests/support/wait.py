"""Waiting for what other threads do."""

from __future__ import annotations

import time
from collections.abc import Callable

from support.patience import patience


def wait_until(
    condition: Callable[[], object], timeout: float = patience(5.0), what: str = ""
) -> None:
    """Return as soon as `condition` holds; AssertionError if it does not in time."""
    deadline = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"after {timeout} s still not: {what or condition}")
        time.sleep(0.002)
