"""Dialling: of one port's attempts to connect to one target, a single one at a time.

Rules: a receiver takes a second connection from the same port for the successor of the first and
closes that. So a repair that dials while a program connects by itself would break what the program
has just got.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager


class Dialling:
    """The targets that a port is connecting to right now."""

    def __init__(self) -> None:
        self._targets: set[str] = set()
        self._changed = threading.Condition()

    @contextmanager
    def alone(self, target: str, wait: bool = True) -> Iterator[bool]:
        """Be the only one to dial `target` while the block runs.

        True inside if so. With `wait` False it may be False: another one is at it, leave it alone.
        """
        with self._changed:
            while wait and target in self._targets:
                self._changed.wait()
            mine = target not in self._targets
            if mine:
                self._targets.add(target)
        try:
            yield mine
        finally:
            if mine:
                with self._changed:
                    self._targets.discard(target)
                    self._changed.notify_all()
