"""Window: how far a sender may be ahead of its reader's acknowledgements.

Rules: the sender's lock is held. Acknowledgements are read late: up to `ahead` messages may be on
their way unconfirmed, for a time, then the next one waits. So a slow reader holds its sender up
(backpressure), as in C++, instead of getting old data. Where the newest message wins, one is on its
way at a time, and twice as many each time when the last of them was acknowledged soon: a reader
that is slow gets nothing old. Time limits are moments of `time.monotonic`; when one comes first
nothing is lost.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from yarpy.errors import YarpError
from yarpy.link.ending import NOW
from yarpy.log import logger
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.link.driver import Driver
    from yarpy.wire.steps import Steps

log = logger("yarpy.link")

# In messages, bytes, seconds.
WINDOW_BYTES: Final = 1 << 16
WINDOW_SECONDS = 0.005
ASK_EVERY: Final = 32  # messages after which acknowledgements are looked for
MOST: Final = 128  # messages at a time to a reader that takes the newest at once


class Window:
    """Of one connection. `open`: messages without an acknowledgement; beyond `until` (of
    time.perf_counter) or `reach` (of the driver's bytes_out) the next one has to `wait`.

    `flush` sends what waits for others of its burst: it is not acknowledged before. `answer` sends
    what the protocol says to an acknowledgement.
    """

    def __init__(
        self,
        driver: Driver,
        carrier: Carrier,
        flush: Callable[[float | None], bool],
        answer: Callable[[float | None], bool],
    ) -> None:
        self.open = 0
        self.size = carrier.limits.ahead  # messages
        self.mute = False  # the peer does not acknowledge: nothing waits for it to
        self._driver = driver
        self._carrier = carrier
        self._flush = flush
        self._answer = answer
        self._steps: Steps[None] | None = None
        self.until = self._ahead_since = 0.0  # of time.perf_counter
        self.reach = 0
        self._most = 1  # of `free`: so many may be on their way

    def note(self, now: float) -> bool:
        """Note that a message left at time `now` (time.perf_counter), which is one of those that
        are `open`; return whether to `look`."""
        if self.open == 1:
            self._open(now)
        elif self._driver.aside:  # what lies in shared memory is not under way
            self.reach += self._driver.aside
            self._driver.aside = 0
        return self.open % ASK_EVERY == 0

    def _open(self, now: float) -> None:
        """From now on, and from here, the sender is ahead."""
        self._ahead_since = now
        alone = self._carrier.limits.ack_timeout is not None  # each message waits for the last
        self.until = 0.0 if alone else now + WINDOW_SECONDS
        self.reach = self._driver.bytes_out + WINDOW_BYTES
        self._driver.aside = 0

    def wait(self, until: float | None) -> bool:
        """Wait until the next message may go; return False if `until` comes first. Raises
        LinkClosed."""
        limit = self._carrier.limits.ack_timeout
        if limit is None:
            return self.collect(wait=True, all_=True, until=until)
        if self.mute:
            self.collect(wait=False)
            return True
        own = time.monotonic() + limit
        if until is not None and until < own:
            return self.collect(wait=True, all_=True, until=until)
        if self.collect(wait=True, all_=True, until=own):
            return True
        if time.monotonic() < own:
            return False  # the port has ended
        self._fall_mute(limit)
        return True

    def look(self, until: float | None) -> bool:
        """Take in what has come; when the window is full, wait until half of it is free, or the
        next message waits. Return False if `until` comes first. Raises LinkClosed."""
        return self.collect(self.open >= self.size and not self.mute, until=until)

    def collect(self, wait: bool, all_: bool = False, until: float | None = None) -> bool:
        """Read acknowledgements: those that are there; with `wait`, until half the window is free,
        or all of it. Return False if `until` comes first. Raises LinkClosed."""
        target = (0 if all_ or self.open < self.size else self.size // 2) if wait else 0
        driver, before = self._driver, self.open
        if not self._flush(until if wait else NOW) and wait:
            return False
        enough, stream, looked = True, driver.stream, False
        while self.open > target:
            if self._steps is None:
                found = self._carrier.parse_acks(stream, self.open)
                if found:
                    self.open -= found
                    looked = False
                    continue
                # Where nothing is there, look for it first.
                if looked or stream.tail > stream.head or type(stream) is not ByteStream:
                    self._steps = self._carrier.expect_ack(stream)
            steps = self._steps
            if steps is not None:
                written, done = len(stream.output), False
                try:
                    next(steps)
                except StopIteration:
                    done = True
                    if self._steps is steps:  # else a signal handler has taken in its end
                        self._steps = None
                        self.open -= 1
                except YarpError:
                    self._steps = None  # one that has failed looks like one that is done
                    raise
                if len(stream.output) > written and not self._answer(until if wait else NOW):
                    enough = not wait  # what the protocol says to that comes first
                    break
                if done:
                    continue
            looked = True
            if not driver.try_fill() and not (wait and driver.fill_by(until)):
                enough = not wait
                break
        if self.open < before:
            self._open(time.perf_counter())
        if not self.open:
            self.mute = False
        return enough

    @property
    def quick(self) -> bool:
        """Return whether the reader has acknowledged soon, the last time."""
        return self._most > 1

    def has_room(self) -> bool:
        """Return whether the newest message may go to a reader that has been quick, also without a
        look at what has come: that would send what is gathered, and ask the system."""
        return (
            0 < self.open < self._most
            and self._driver.bytes_out <= self.reach
            and time.perf_counter() < self.until
        )

    def free(self, left: float) -> bool:
        """Return whether the newest message may go: the reader has taken the one before, which
        `left` then (time.perf_counter), as far as is known, or has been quick to; or it does not
        acknowledge."""
        now = time.perf_counter()
        if not self.open:
            self._most = min(2 * self._most, MOST, self.size) if now - left < WINDOW_SECONDS else 1
        if not self.open or self.mute:
            return True
        limit = self._carrier.limits.ack_timeout
        if limit is not None and now - self._ahead_since > limit:
            self._fall_mute(limit)
        return self.mute or self.has_room()

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
