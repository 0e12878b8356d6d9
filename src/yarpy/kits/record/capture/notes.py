"""Notes: what is to be said of a recording, until the thread that writes takes it.

Rules: any thread adds, one takes. A recorder that starts paused has no recording yet: what was
noted by then is dated to its beginning, so that a file lasts from there, whatever reads it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from typing import Any, Final, TypeAlias

MOST: Final = 1000  # that wait
Note: TypeAlias = tuple[dict[str, Any], int]  # with its time in nanoseconds


class Notes:
    """Those of a recorder; `now` is its clock. begun: the recording has begun already."""

    def __init__(self, now: Callable[[], int], begun: bool) -> None:
        self._now = now
        self._beginning: int | None = 0 if begun else None
        self._early: deque[dict[str, Any]] = deque(maxlen=MOST)
        self._waiting: deque[Note] = deque(maxlen=MOST)

    def add(self, what: str, ago: int = 0, /, **facts: Any) -> None:
        """Note something about this moment, or one so many nanoseconds ago."""
        note = {"what": what, **facts}
        if self._beginning is None:
            self._early.append(note)
        else:
            self._waiting.append((note, self._now() - ago))

    def begin(self) -> None:
        """The recording begins, if it has not."""
        if self._beginning is None:
            self._beginning = self._now()

    def take(self) -> Iterator[Note]:
        """Yield what waits; nothing before the beginning."""
        if self._beginning is None:
            return
        while self._early:
            yield self._early.popleft(), self._beginning
        while self._waiting:
            yield self._waiting.popleft()
