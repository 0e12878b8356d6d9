"""How long something has taken, less the time in which this process was not let run.

    begun = time.monotonic()
    with pytest.raises(Timeout):
        port.read(timeout=0.05)
    assert lasted(begun) < 2

Rules: it tells what comes back from what waits for seconds, on a machine that is busy with other
programs, too. A thread that has nothing else to do sees how late it wakes: so long did others have
the processors.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from typing import Final

_PULSE: Final = 0.01  # seconds between looks
_LATE: Final = 0.005  # seconds that are none: what a timer and the interpreter's lock take
_stalls: Final[deque[tuple[float, float]]] = deque(maxlen=4096)  # when each ended, and its seconds
_seen = time.monotonic()


def _watch() -> None:
    global _seen
    while True:
        time.sleep(_PULSE)
        now = time.monotonic()
        late = now - _seen - _PULSE
        if late > _LATE:
            _stalls.append((now, late))
        _seen = now


threading.Thread(target=_watch, name="stalls", daemon=True).start()


def lasted(begun: float) -> float:
    """Return the seconds since `begun`, by time.monotonic()."""
    now = time.monotonic()
    stalled = sum(seconds for ended, seconds in [*_stalls] if ended > begun)
    return now - begun - stalled - max(0.0, now - _seen - _PULSE - _LATE)
