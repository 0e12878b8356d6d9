"""Time: `delay` and `now`, as functions and under the older name `Time`.

Rules: the clock is that of the system; `useSystemClock` says so, other clocks are not there.
"""

from __future__ import annotations

import time

YARP_CLOCK_UNINITIALIZED = -1
YARP_CLOCK_DEFAULT = 0
YARP_CLOCK_SYSTEM = 1
YARP_CLOCK_NETWORK = 2
YARP_CLOCK_CUSTOM = 3


def delay(seconds: float) -> None:
    """Wait."""
    if seconds > 0:
        time.sleep(seconds)


def now() -> float:
    """Seconds since 1970."""
    return time.time()


def yield_c() -> None:
    """Let other threads run."""
    time.sleep(0)


def turboBoost() -> None:
    """Nothing to do."""


def isValid() -> bool:
    """Whether there is a time."""
    return True


def useSystemClock() -> None:
    """The clock that is used anyway."""


def isSystemClock() -> bool:
    return True


def isNetworkClock() -> bool:
    return False


def isCustomClock() -> bool:
    return False


def isClockInitialized() -> bool:
    return True


def getClockType() -> int:
    return YARP_CLOCK_SYSTEM


class Time:
    """The same as static methods: `Time.delay(1)`, `Time.now()`."""

    delay = staticmethod(delay)
    now = staticmethod(now)
    yield_c = staticmethod(yield_c)
    turboBoost = staticmethod(turboBoost)
    isValid = staticmethod(isValid)
    useSystemClock = staticmethod(useSystemClock)
    isSystemClock = staticmethod(isSystemClock)
    isNetworkClock = staticmethod(isNetworkClock)
