"""Reader: what a port does in `read` - takes from the mailbox, or straight from the socket."""

from __future__ import annotations

import math
import threading
import time

from yarpy.errors import LocalProtocolError, Timeout
from yarpy.link.receive.inbound import Inbound
from yarpy.link.receive.receiver import FRESH
from yarpy.link.receive.turn import SILENCE, Lease
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Latest, Mailbox
from yarpy.scope import moment
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
        self._mailbox = hub.inputs.mailbox
        self._spin = spin
        self._sole: Inbound | None = None  # the link that may be read directly
        self._waiting: dict[object, None] = {}  # one for each thread that waits in the mailbox
        self._flows = False  # whether it came soon after the reader: else no lease is worth it
        self._judge()
        hub.inputs.on_change = self._look_again

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
        mailbox.notify = older.notify
        self._mailbox = mailbox
        self._judge()
        self._hub.inputs.exchange(mailbox)
        for link, message in older.surrender():
            mailbox.put(link, message)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        if self._mailbox.held:
            self._mailbox.settle()
        return self._mailbox.poll()

    def _look_again(self) -> None:
        """Connections came or went: only a sole, unscheduled one may be read directly."""
        inputs = self._hub.inputs.links
        sole = (
            inputs[0]
            if len(inputs) == 1 and not inputs[0].carrier.delivery.connectionless
            else None
        )
        old, self._sole = self._sole, sole
        if old is not None and old is not sole:
            old.turn.end()

    def read(self, timeout: float | None) -> Message:
        """See Port.read.

        Where a message is returned, nothing is called after it was released: until then whoever
        reads next gets it, should an exception come out of a signal handler.
        """
        until = None if timeout is None else moment(timeout)
        mailbox = self._mailbox
        if mailbox.held:
            mailbox.settle()
        me = threading.get_ident()
        while True:
            link = self._sole
            lease = None if link is None else link.turn.lease
            if link is not None and lease is not None and not lease.over:
                if lease.reader != me:
                    link.turn.end()  # several threads read: each gets its messages by the mailbox
                elif lease.busy:
                    raise LocalProtocolError(
                        f'"{self._hub.name}" is being read already by this thread, beneath a '
                        "signal handler"
                    )
                elif mailbox.empty():
                    message = self._read_directly(link, lease, until)
                    if message is not None:
                        return message
            leased = lease is not None and lease.reader == me and not lease.over
            asked = time.perf_counter()
            quick = self._spin or (self._flows and asked - mailbox.taken < self._quick)
            alone = not (leased or self._waiting)
            if quick and link is not None and alone and link.sched.policy < 1:
                link.turn.ask(me)
            left = None if until is None else max(0.0, until - time.monotonic())
            here = object()
            self._waiting[here] = None
            try:
                message = mailbox.take(0.0 if self._spin and leased else left)
            finally:
                del self._waiting[here]
            if message is not None:
                self._flows = mailbox.taken - asked < SILENCE
                return message
            if until is not None and time.monotonic() >= until:
                raise Timeout(f'nothing came to "{self._hub.name}" within {timeout} s')

    def _read_directly(self, link: Inbound, lease: Lease, until: float | None) -> Message | None:
        """Read from the socket, in this thread, under its lease."""
        mailbox = self._mailbox
        if not lease.open:
            left = SILENCE if until is None else until - time.monotonic()
            if not lease.wait(max(0.0, min(left, SILENCE))):
                return None
        lease.busy = True
        try:
            if lease.over:
                return None
            message = link.read(lease, until, self._spin, self._newest, self._away)
            if message is None:
                return None
            if mailbox.stopped:
                link.receiver.release()
                mailbox.put(link, message)  # which drops and counts it
                link.leave(message)
                return None
            if message.answer is not None:
                mailbox.keep(link, message)
            lease.seen = time.perf_counter()
            receiver = link.receiver
            if receiver.spare is None:
                receiver.held, receiver.stage = None, FRESH  # as `release`
            else:
                receiver.release()
            return message
        finally:
            lease.busy = False
