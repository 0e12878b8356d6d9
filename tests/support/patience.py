"""Waiting for what happens soon, but not at once."""

import time
from collections.abc import Callable

PATIENCE = 5.0  # seconds; generous on a busy machine


def soon(condition: Callable[[], object], what: str, patience: float = PATIENCE) -> None:
    """Wait until `condition()` holds; AssertionError that says `what` was expected."""
    deadline = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < deadline, f"not within {patience} s: {what}"
        time.sleep(0.005)
