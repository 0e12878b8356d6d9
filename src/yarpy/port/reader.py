"""Reader: what a port does in `read` - takes from the mailbox, or straight from the socket."""

from __future__ import annotations

import math
import time

from yarpy.errors import Timeout
from yarpy.link.inbound import Inbound
from yarpy.link.turn import SILENCE
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Latest, Mailbox
from yarpy.wire.message import Message

# A reader that comes back within this many seconds may read the socket itself.
_QUICK = 0.005
# One that wants the newest and works longer than this between messages leaves reading to the link's
# thread, which drops what is old and keeps no sender waiting.
_NEWEST_QUICK = 0.001


class Reader:
    """Reading from a hub: out of the mailbox, or directly from the one link there is."""

    def __init__(self, hub: Hub, spin: bool = False) -> None:
        self._hub = hub
        self._mailbox = hub.mailbox
        self._spin = spin
        self._sole: Inbound | None = None  # the link that may be read directly
        self._left = 0.0  # when a message was last taken from the mailbox
        self._flows = False  # whether it came soon after the reader: else no lease is worth it
        self._judge()
        hub.on_inputs = self._look_again

    def _judge(self) -> None:
        self._newest = isinstance(self._mailbox, Latest)
        self._quick = _NEWEST_QUICK if self._newest else _QUICK
        # After so many seconds without a reader, who wants the newest, it may have kept its sender
        # waiting: then it gives the lease up, but not before it has looked itself once more. The
        # newest is there, while the link's thread would begin with the oldest. A reader that wants
        # every message keeps the lease: a busy writer in the same process makes every turn of its
        # reader late, and handing each message over from another thread would make it later still.
        self._away = self._quick if self._newest and not self._spin else math.inf

    def exchange(self, mailbox: Mailbox) -> None:
        """Read through another mailbox from now on, while nobody reads."""
        older = self._mailbox
        self._mailbox = mailbox
        self._judge()
        self._hub.exchange(mailbox)
        for link, message in older.surrender():
            mailbox.put(link, message)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        if self._mailbox.held:
            self._mailbox.settle()
        return self._mailbox.poll()

    def _look_again(self) -> None:
        """Connections came or went: only a sole, unscheduled one may be read directly."""
        inputs = self._hub.inputs
        sole = inputs[0] if len(inputs) == 1 and not inputs[0].carrier.connectionless else None
        old, self._sole = self._sole, sole
        if old is not None and old is not sole:
            old.turn.end()

    def read(self, timeout: float | None) -> Message:
        """See Port.read."""
        deadline = None if timeout is None else time.monotonic() + timeout
        mailbox = self._mailbox
        if mailbox.held:
            mailbox.settle()
        while True:
            link = self._sole
            leased = link is not None and link.turn.leased
            if link is not None and leased and not mailbox.waiting:
                message = link.read(deadline, self._spin, self._newest, self._away)
                if message is not None:
                    if not mailbox.stopped:
                        if message.answer is not None:
                            mailbox.keep(link, message)
                        return message
                    mailbox.put(link, message)  # which drops and counts it
                    link.leave(message)
                leased = link.turn.leased
            asked = time.perf_counter()
            quick = self._spin or (self._flows and asked - self._left < self._quick)
            if quick and link is not None and not leased and link.sched.policy < 1:
                link.turn.ask()
            left = None if deadline is None else max(0.0, deadline - time.monotonic())
            message = mailbox.take(0.0 if self._spin and leased else left)
            if message is not None:
                self._left = time.perf_counter()
                self._flows = self._left - asked < SILENCE
                return message
            if deadline is not None and time.monotonic() >= deadline:
                raise Timeout(f'nothing came to "{self._hub.name}" within {timeout} s')
