"""Pace: how fast datagrams may leave, so that their receiver can keep up.

Rules: datagrams have no backpressure, so the sender assumes a typical receiver: a buffer of 208 kB,
the default of Linux, which C++ YARP leaves alone, holds three datagrams of the largest size;
reading one takes some 0.6 ms, as long as a gigabit network takes to bring it. So one may leave at
once, and the next when the receiver has likely read it. Small messages hardly ever wait: a hundred
megabytes of them may leave in a second.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

BURST: Final = 65507  # bytes that may leave at once: one datagram of the largest size
RATE: Final = 1e8  # bytes a second that a receiver is assumed to read


class Pace:
    """Holds back what would overrun a receiver. `clock` and `sleep` are in seconds."""

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._clock = clock
        self._sleep = sleep
        self._read_at = 0.0  # when the receiver has likely read all that has left

    def wait(self, size: int) -> None:
        """Wait until `size` more bytes may leave, which the caller then sends."""
        now = self._clock()
        read_at = max(self._read_at, now) + size / RATE
        if read_at - now > BURST / RATE:
            self._sleep(read_at - now - BURST / RATE)
            read_at = max(read_at, self._clock() + size / RATE)  # time overslept is not made up for
        self._read_at = read_at
