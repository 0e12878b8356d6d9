"""Reading ahead: a thread reads messages of a recording before they are due.

Rules: no more than `most` bytes wait. What the reading raises is raised to whoever takes the
messages, in its place. The thread ends with the messages or with `close`.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator
from typing import Final, Self

from yarpy.kits.record.recorded import Recorded

MOST: Final = 64 << 20  # bytes
_OVERHEAD: Final = 300  # bytes of a message besides its payload
_AT_ONCE: Final = 64  # messages that are handed over together


class ReadAhead:
    """Yields what `messages` yields, read ahead."""

    def __init__(self, messages: Iterator[Recorded], most: int = MOST) -> None:
        self._messages = messages
        self._most = most
        self._held = 0
        self._waiting: deque[Recorded] = deque()
        self._error: BaseException | None = None
        self._over = False
        self._closed = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._read, name="yarpy read ahead", daemon=True)
        self._thread.start()

    def _read(self) -> None:
        some: list[Recorded] = []
        try:
            for recorded in self._messages:
                some.append(recorded)
                if len(some) >= _AT_ONCE or recorded.size > _OVERHEAD:
                    if not self._hand_over(some):
                        return
                    some = []
        except BaseException as error:
            self._error = error
        self._hand_over(some)
        with self._changed:
            self._over = True
            self._changed.notify_all()

    def _hand_over(self, some: list[Recorded]) -> bool:
        """Wait for room; return whether anybody wants more."""
        size = sum(_size(one) for one in some)
        with self._changed:
            self._changed.wait_for(lambda: self._closed or self._held < self._most)
            self._waiting.extend(some)
            self._held += size
            self._changed.notify_all()
            return not self._closed

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> Recorded:
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._over)
            if not self._waiting:
                if self._error is not None:
                    raise self._error
                raise StopIteration
            found = self._waiting.popleft()
            full = self._held >= self._most
            self._held -= _size(found)
            if full and self._held < self._most:
                self._changed.notify_all()
            return found

    def close(self) -> None:
        """Read no more."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._thread.join()


def _size(recorded: Recorded) -> int:
    return recorded.size + _OVERHEAD
