"""Window: how far a sender may be ahead of its reader's acknowledgements.

Rules: the sender's lock is held. Acknowledgements are read late: up to `WINDOW` messages may be on
their way unconfirmed, for a time, then the next one waits. So a slow reader holds its sender up
(backpressure), as in C++, instead of getting old data. Times are those of `time.monotonic`; where
`until` comes before the acknowledgement, Timeout is raised and nothing is lost.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from yarpy.errors import Timeout, YarpError
from yarpy.log import logger

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.link.driver import Driver
    from yarpy.wire.steps import Steps

log = logger("yarpy.link")

# In messages, bytes, seconds.
WINDOW: Final = 256
WINDOW_BYTES: Final = 1 << 16
WINDOW_SECONDS: Final = 0.005
ASK_EVERY: Final = 32  # messages after which acknowledgements are looked for


class Window:
    """Of one connection. `open`: messages without an acknowledgement; beyond `until` (of
    time.perf_counter) or `reach` (of the driver's bytes_out) the next one has to `wait`.

    `flush` sends what waits for others of its burst: it is not acknowledged before.
    """

    def __init__(
        self, driver: Driver, carrier: Carrier, flush: Callable[[float | None], None]
    ) -> None:
        self.open = 0
        self.mute = False  # the peer does not acknowledge: nothing waits for it to
        self._driver = driver
        self._carrier = carrier
        self._flush = flush
        self._steps: Steps[None] | None = None
        self.until = self._ahead_since = 0.0  # of time.perf_counter
        self.reach = 0

    def count(self, now: float) -> bool:
        """A message has left at time `now` (time.perf_counter); whether to `look`."""
        if not self.open:
            self._open(now)
        elif self._driver.aside:  # what lies in shared memory is not under way
            self.reach += self._driver.aside
            self._driver.aside = 0
        self.open += 1
        return self.open % ASK_EVERY == 0

    def _open(self, now: float) -> None:
        """From now on, and from here, the sender is ahead."""
        self._ahead_since = now
        alone = self._carrier.limits.ack_timeout is not None  # each message waits for the last
        self.until = 0.0 if alone else now + WINDOW_SECONDS
        self.reach = self._driver.bytes_out + WINDOW_BYTES
        self._driver.aside = 0

    def wait(self, until: float | None) -> None:
        """Wait until the next message may go. Raises Timeout, LinkClosed."""
        limit = self._carrier.limits.ack_timeout
        if limit is not None:
            self._confirm(limit, until)
        else:
            self.collect(wait=True, all_=True, until=until)

    def look(self, until: float | None) -> None:
        """Take in what has come; when the window is full, wait until half of it is free. Raises
        LinkClosed."""
        wait = self.open >= WINDOW and not self.mute
        try:
            self.collect(wait, until=until)
        except Timeout:
            if until is None:
                raise  # otherwise the next message waits

    def collect(self, wait: bool, all_: bool = False, until: float | None = None) -> None:
        """Read acknowledgements: those that are there; with `wait`, until half the window is
        free, or all of it."""
        target = 0 if all_ or (wait and self.open < WINDOW) else WINDOW // 2
        driver, limited = self._driver, False
        before = self.open
        try:
            if wait:
                self._flush(until)
            else:
                self._flush_at_once()
            while self.open > (target if wait else 0):
                if self._steps is None:
                    found = self._carrier.parse_acks(driver.stream, self.open)
                    if found:
                        self.open -= found
                        continue
                    self._steps = self._carrier.expect_ack(driver.stream)
                try:
                    next(self._steps)
                except StopIteration:
                    self._steps = None
                    self.open -= 1
                    continue
                except YarpError:
                    self._steps = None  # one that has failed looks like one that is done
                    raise
                if wait and until is None:
                    driver.fill()
                elif not driver.try_fill():
                    if not wait:
                        break
                    limited = True
                    driver.fill(until)
        finally:
            if limited and until:
                driver.transport.limit_waiting(None)
        if self.open < before:
            self._open(time.perf_counter())
        if not self.open:
            self.mute = False

    def _flush_at_once(self) -> None:
        try:
            self._flush(0.0)
        except Timeout:
            pass  # the rest another time

    def _confirm(self, limit: float, until: float | None) -> None:
        """Wait for the acknowledgement of the last message before the next one goes, `limit`
        seconds at most."""
        if self.mute:
            self.collect(wait=False)
            return
        own = time.monotonic() + limit
        if until is not None and until < own:
            self.collect(wait=True, all_=True, until=until)
            return
        try:
            self.collect(wait=True, all_=True, until=own)
        except Timeout:
            self._fall_mute(limit)

    def free(self) -> bool:
        """Whether the reader has taken the last message, as far as is known, or does not
        acknowledge."""
        if not self.open or self.mute:
            return True
        limit = self._carrier.limits.ack_timeout
        if limit is not None and time.perf_counter() - self._ahead_since > limit:
            self._fall_mute(limit)
        return self.mute

    def _fall_mute(self, limit: float) -> None:
        self.mute = True
        route = self._carrier.route
        log.warning(
            '%s: "%s" does not respond to messages over %s within %g s; from now on '
            "acknowledgements are not waited for, and messages without one count as unconfirmed "
            "when the connection ends. Connect with tcp if you can",
            route.source,
            route.target,
            self._carrier.name,
            limit,
        )
