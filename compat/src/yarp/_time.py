"""Time: `delay` and `now`, as functions and under the older name `Time`.

Rules: the clock is that of the program, `yarpy.clock`: the system's, or with YARP_CLOCK that of the
network. An object with `now`, `delay` and `isValid` may be one, too.
"""

from __future__ import annotations

import threading
import time
from typing import Any

from yarp import _names
from yarp._log import say
from yarpy import YarpError, clock

YARP_CLOCK_UNINITIALIZED = -1
YARP_CLOCK_DEFAULT = 0
YARP_CLOCK_SYSTEM = 1
YARP_CLOCK_NETWORK = 2
YARP_CLOCK_CUSTOM = 3

_SLICE = 0.05  # seconds after which an event that ends a wait is seen


class _Custom:
    """An object of the user's as a clock of yarpy."""

    def __init__(self, made: Any) -> None:
        self.made = made

    def now(self) -> float:
        return float(self.made.now())

    def monotonic(self) -> float:
        return self.now()

    def wait(self, event: threading.Event, seconds: float) -> bool:
        over = self.now() + seconds
        while not event.is_set() and (left := over - self.now()) > 0:
            self.made.delay(min(left, _SLICE))
        return event.is_set()


def delay(seconds: float) -> None:
    """Wait."""
    if seconds > 0:
        clock.sleep(seconds)


def now() -> float:
    """Seconds since 1970, or what another clock says."""
    return clock.now()


def yield_c() -> None:
    """Let other threads run."""
    time.sleep(0)


def turboBoost() -> None:
    """Nothing to do."""


def isValid() -> bool:
    """Return whether there is a time."""
    current = clock.current()
    if isinstance(current, _Custom):
        return bool(current.made.isValid())
    return not isinstance(current, clock.NetworkClock) or current.valid


def useSystemClock() -> None:
    """From now on the time is that of the system."""
    _change(None)


def useNetworkClock(clockSourcePortName: str, localPortName: str = "") -> bool:
    """From now on the time is what a port of the network sends."""
    try:
        made = clock.NetworkClock(clockSourcePortName, name=localPortName, names=_names.names())
    except YarpError as error:
        say("ERROR", str(error))
        return False
    _change(made)
    return True


def useCustomClock(made: Any) -> bool:
    """From now on the time is what `made.now()` says, and `made.delay(seconds)` waits."""
    if not made.isValid():
        say("ERROR", "a clock has to be valid before it is used")
        return False
    _change(_Custom(made))
    return True


def _change(made: Any) -> None:
    before = clock.current()
    clock.use(made)
    if isinstance(before, clock.NetworkClock):
        before.close()


def isSystemClock() -> bool:
    return getClockType() == YARP_CLOCK_SYSTEM


def isNetworkClock() -> bool:
    return getClockType() == YARP_CLOCK_NETWORK


def isCustomClock() -> bool:
    return getClockType() == YARP_CLOCK_CUSTOM


def isClockInitialized() -> bool:
    return True


def getClockType() -> int:
    current = clock.current()
    if isinstance(current, _Custom):
        return YARP_CLOCK_CUSTOM
    if isinstance(current, clock.NetworkClock):
        return YARP_CLOCK_NETWORK
    return YARP_CLOCK_SYSTEM


class Time:
    """The same as static methods: `Time.delay(1)`, `Time.now()`."""

    delay = staticmethod(delay)
    now = staticmethod(now)
    yield_c = staticmethod(yield_c)
    turboBoost = staticmethod(turboBoost)
    isValid = staticmethod(isValid)
    useSystemClock = staticmethod(useSystemClock)
    useNetworkClock = staticmethod(useNetworkClock)
    useCustomClock = staticmethod(useCustomClock)
    isSystemClock = staticmethod(isSystemClock)
    isNetworkClock = staticmethod(isNetworkClock)
    isCustomClock = staticmethod(isCustomClock)
    isClockInitialized = staticmethod(isClockInitialized)
    getClockType = staticmethod(getClockType)


def clockTypeToString(type: int = -1) -> str:
    """The name of a clock; without an argument, of the one in use."""
    names = {
        YARP_CLOCK_SYSTEM: "System clock",
        YARP_CLOCK_NETWORK: "Network clock",
        YARP_CLOCK_CUSTOM: "Custom clock",
    }
    return names.get(getClockType() if type == -1 else type, "Clock not initialized")
