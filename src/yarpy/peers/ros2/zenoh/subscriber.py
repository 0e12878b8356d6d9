"""Subscriber: a port's subscription in Zenoh, as a transport of objects.

Rules: the thread that reads waits in Zenoh (`Ring`) where it can. What Zenoh hands to a callback
goes through the inbox: of a topic whose messages are kept for who comes late, where many are to be
kept (the inbox has a limit in bytes, too), where another subscription of this process has the
ring, and for a subclass that says so (`waits`). Numbers tell what was lost, in the ring, too
(`Firsts`); what was published before the subscription is not.
"""

from __future__ import annotations

import time
from collections import deque
from typing import Any, ClassVar, Final

from yarpy.errors import DecodeError
from yarpy.log import logger
from yarpy.peers.ros2 import kind as kinds
from yarpy.peers.ros2.carrier import Incoming
from yarpy.peers.ros2.event import MESSAGE, Event
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.qos import PROFILES, promised
from yarpy.peers.ros2.token import PUBLISHER, SUBSCRIBER, Token, gid
from yarpy.peers.ros2.zenoh.attachment import (
    GID_SIZE,
    GID_SIZE_AT,
    SIZE,
    UNPACK,
    parse_attachment,
)
from yarpy.peers.ros2.zenoh.coalesced import Coalesced
from yarpy.peers.ros2.zenoh.endpoint import Endpoint
from yarpy.peers.ros2.zenoh.firsts import Firsts
from yarpy.peers.ros2.zenoh.ring import Ring
from yarpy.peers.zenoh.library import CALLS, WAKE

log = logger("yarpy.ros2")

MOST_PUBLISHERS: Final = 1000  # whose numbers are followed
BACKENDS: Final = "backends:cpu:"  # what Lyrical wants to know of readers of bytes
BESIDE: Final = "/_buf_cpu"  # ... and where it may send them then
MOST_RING: Final = 100  # messages that wait in Zenoh, where nobody counts bytes
HURRY: Final = 1.0  # seconds for the reader to leave a ring: a signal handler may be above it
_LOOK: Final = (Incoming(b""),)  # only wakes who waits: there is a ring, or no longer


class Subscriber(Endpoint):
    """Takes messages from its key."""

    role = SUBSCRIBER
    peers = (PUBLISHER,)
    hears = True
    waits: ClassVar[bool] = True  # a thread calls `receive` for each message

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._numbers: dict[bytes, int] = {}  # the last of each publisher
        self._repeats = False  # whether what was kept may come once more
        self._refused = ""
        self._kept = 0  # messages that wait to be read
        self._past = Coalesced(self._catch_up, f"yarpy past of {self.name}")
        self._ring: Ring | None = None
        self._firsts: Firsts | None = None
        self._idle = False  # the reader waits for the inbox alone
        self._held: deque[Any] | None = None  # samples that wait for those in a ring to be read

    def extra(self, kind: Any) -> str:
        return BACKENDS if kinds.has_bytes(kind) and not self.qos.latched else ""

    def join(self, key: Key, kind: Any) -> None:
        from zenoh.handlers import Callback

        hear = Callback(self._heard, indirect=False)
        session = self.participant.session
        self._kept = self.qos.kept
        if self.qos.latched:
            from zenoh import ext

            recovery = ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
            history = ext.HistoryConfig(detect_late_publishers=True, max_samples=self.qos.kept)
            self._handles.append(
                ext.declare_advanced_subscriber(
                    session,
                    str(key),
                    hear,
                    history=history,
                    recovery=recovery if self.qos.reliable else None,
                    subscriber_detection=True,
                )
            )
            return
        if self.waits and self._kept <= MOST_RING and self.participant.claim(str(key)):
            self._ring = Ring(
                session, str(key), self._kept, lambda: self.participant.give_up(str(key))
            )
            seen = self.participant.graph.endpoints(self.name, PUBLISHER)
            theirs = [gid(str(token)) for token in seen if token.key == key]
            self._firsts = Firsts(session, str(key), theirs)  # behind it: not what it has not got
            self._handles += self._ring, self._firsts
            if self._idle:
                self._inbox.put(_LOOK[0])
        else:
            self._handles.append(session.declare_subscriber(str(key), hear))
        if self.extra(kind):
            self._handles.append(session.declare_subscriber(f"{key}{BESIDE}", hear))

    def joined(self, token: Token) -> None:
        if self._firsts is not None:
            self._firsts.come(gid(str(token)))
        if token.qos.latched and not self.qos.latched and not self.given_qos:
            self._past()

    def left(self, token: Token) -> None:
        if self._firsts is not None:
            self._firsts.leave(gid(str(token)))

    def _catch_up(self) -> None:
        """Subscribe to what is kept, too: a publisher has come that keeps something."""
        with self._opening:
            if self._closed or self.key is None or self.qos.latched:
                return
            self.qos, self._repeats = promised([PROFILES["latched"]]), True
            before, self._handles = self._handles, []
            shown, self._declared = self._declared, None
            if self._ring is not None:
                self._held = deque(maxlen=self.qos.kept)
            self.open(self.kind, self._old)
            self._leave_ring()
            for handle in before:
                handle.undeclare()
            if shown is not None:
                shown.close()

    def _leave_ring(self) -> None:
        """From now on messages come by the inbox, in front of them those in the ring."""
        ring, self._ring = self._ring, None
        if ring is None:
            return
        ring.wake()
        alone = ring.lock.acquire(timeout=HURRY)
        try:
            self._drain(ring)
            with self._counting:
                held, self._held = self._held or (), None
                for sample in held:
                    self._heard(sample)
        finally:
            if alone:
                ring.lock.release()

    # -- what comes -------------------------------------------------------------------------------

    def _heard(self, sample: Any) -> None:
        """In a thread of Zenoh."""
        if self._held is not None:
            with self._counting:
                if self._held is not None:
                    self._held.append(sample)
                    return
        item = self._item(sample)
        if item is None:
            return
        self.put(item, self._kept)
        ring = self._ring
        if ring is not None:
            ring.wake()

    def _item(self, sample: Any) -> Incoming | None:
        """Return what came, None for what is none, or nothing new; count what is missing."""
        attached = sample.attachment
        number, when = 0, 0
        if attached is not None:
            data = attached.to_bytes()
            if len(data) != SIZE or data[GID_SIZE_AT] != GID_SIZE:
                self._refuse(data)
                return None
            number, when, _, sender = UNPACK(data)  # as `parse_attachment`, spelled out
            numbers = self._numbers
            before = numbers.get(sender)
            if before is None:
                firsts = self._firsts
                before = (number if firsts is None else firsts.first(sender, number)) - 1
                if len(numbers) >= MOST_PUBLISHERS:
                    del numbers[next(iter(numbers))]  # one that flaps has many names
            if number != before + 1:
                if number <= before and self._repeats:
                    return None
                if number > before:
                    self.dropped += number - before - 1
                    self.events.tell(Event(MESSAGE, number - before - 1))
            numbers[sender] = number
        return Incoming(sample.payload.to_bytes(), number, when)

    def _refuse(self, attached: bytes) -> None:
        """Count a message whose attachment is none of ROS 2, unless it only wakes who waits."""
        if attached == WAKE:
            return
        self.dropped += 1
        try:
            parse_attachment(attached)
        except DecodeError as error:
            if str(error) != self._refused:
                self._refused = str(error)
                log.warning("%s: a message of %s is lost: %s", self.port_name, self.name, error)

    # -- reading ----------------------------------------------------------------------------------

    def receive(self, wait: bool = True) -> tuple[object] | None:
        while True:
            ring = self._ring
            if ring is not None and self._greeted:
                with ring.lock:
                    found = self._receive_from(ring, wait)
            else:
                found = self._receive_heard(wait)
            if found is not _LOOK:
                return found

    def _receive_heard(self, wait: bool) -> tuple[object] | None:
        """As `receive`, from the inbox."""
        self._idle = True
        try:
            if self._greeted and self._ring is not None:
                return _LOOK
            found = super().receive(wait)
            return _LOOK if found == _LOOK else found
        finally:
            self._idle = False

    def _receive_from(self, ring: Ring, wait: bool) -> tuple[object] | None:
        """As `receive`, for who has the lock of the ring."""
        limit = self._timeout
        deadline = None if limit is None else time.monotonic() + limit
        while True:
            ring.woken = False  # first: what is said from now on wakes
            if self._over or CALLS.over:
                return None
            if self._ring is not ring:
                return _LOOK
            try:
                sample = ring.look()
                if sample is not None:
                    self._take(sample)
                    self._drain(ring)
                elif self._inbox.empty():  # as nearly always
                    if not wait:
                        raise BlockingIOError("nothing has come")
                    sample = ring.wait(deadline)
                    item = None if sample is None else self._item(sample)
                    if item is None:  # woken, perhaps since time is over: it looks once more
                        wait = deadline is None or time.monotonic() < deadline
                        continue
                    if self._inbox.empty():
                        return (item,)
                    self.put(item, self._kept)
            except ring.error:
                return None  # closed
            if not self._inbox.empty():
                return super().receive(False)

    def _take(self, sample: Any) -> None:
        item = self._item(sample)
        if item is not None:
            self.put(item, self._kept)

    def _drain(self, ring: Ring) -> None:
        """Have the messages in the ring in the inbox, the newest as many as are kept."""
        for _ in range(ring.most):  # and not for ever, where they come fast
            sample = ring.look()
            if sample is None:
                return
            self._take(sample)

    def interrupt(self) -> None:
        super().interrupt()
        ring = self._ring
        if ring is not None:
            ring.wake()
