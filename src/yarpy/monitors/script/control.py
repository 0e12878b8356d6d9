"""Control: what a script may do besides handling messages - events, a constraint, a timer.

Rules: any thread may call. Everything a script has set here ends when its monitor closes.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final

from yarpy.errors import LocalProtocolError
from yarpy.monitors.constraint import Constraint
from yarpy.monitors.event import EVENTS, Events
from yarpy.threads import Thread

_LEAST: Final = 0.001  # seconds between two triggers
_MOST: Final = 1e6


class Control:
    """The control of one script. Its timer, a thread called `name`, calls `trigger`."""

    def __init__(
        self,
        constraint: str = "",
        trigger: Callable[[], None] = lambda: None,
        name: str = "",
        events: Events = EVENTS,
    ) -> None:
        self._constraint = Constraint(constraint)
        self._trigger = trigger
        self._name = name
        self._events = events
        self._timer: threading.Thread | None = None
        self._interval = 0.0
        self._changed = threading.Event()
        self._closed = False
        self._lock = threading.Lock()  # one timer only

    # -- for scripts ------------------------------------------------------------------------------

    def set_event(self, name: str, lifetime: float | None = None) -> None:
        """Set or renew an event for `lifetime` seconds, or until it is unset."""
        if not self._closed:
            self._events.set(self, name, lifetime)

    def unset_event(self, name: str) -> None:
        """Remove an event that this monitor has set."""
        self._events.unset(self, name)

    def set_constraint(self, text: str) -> None:
        """From now on messages pass only while this is true; "" lets all pass.

        Raises LocalProtocolError if it is not a constraint.
        """
        self._constraint = Constraint(text)

    def get_constraint(self) -> str:
        """The constraint as it was set. (C++ YARP returns nothing.)"""
        return self._constraint.text

    def set_trig_interval(self, seconds: float) -> None:
        """Call `trig` every `seconds`; 0 stops it. (C++ YARP takes one second for a thousand.)

        Raises LocalProtocolError below a millisecond.
        """
        if seconds != 0 and not _LEAST <= seconds <= _MOST:
            raise LocalProtocolError(
                f"the interval of trig must be 0, or {_LEAST:g} to {_MOST:g} seconds: {seconds:g}"
            )
        with self._lock:
            self._interval = seconds
            self._changed.set()
            if seconds and self._timer is None and not self._closed:
                self._timer = Thread(target=self._run, name=f"yarpy trig {self._name}", daemon=True)
                self._timer.start()

    def unset_trig_interval(self) -> None:
        """Stop calling `trig` on a timer."""
        self.set_trig_interval(0)

    # The names in scripts of C++ YARP.
    setEvent = set_event  # noqa: N815
    unsetEvent = unset_event  # noqa: N815
    setConstraint = set_constraint  # noqa: N815
    getConstraint = get_constraint  # noqa: N815
    setTrigInterval = set_trig_interval  # noqa: N815
    unsetTrigInterval = unset_trig_interval  # noqa: N815

    # -- for the monitor --------------------------------------------------------------------------

    def allows(self) -> bool:
        """Return whether the constraint is true now."""
        return self._constraint.holds(self._events.has)

    def close(self) -> None:
        """End the timer and remove all events."""
        with self._lock:
            self._closed = True
            self._changed.set()
        self._events.clear(self)

    def _run(self) -> None:
        due = time.monotonic()
        while True:
            with self._lock:
                self._changed.clear()
                interval = self._interval
                if self._closed or not interval:
                    self._timer = None
                    return
            due = max(due + interval, time.monotonic())  # missed ones are skipped
            if not self._changed.wait(due - time.monotonic()):
                self._trigger()
            else:
                due = time.monotonic()
