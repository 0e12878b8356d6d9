"""Endpoints over DDS: a port's publisher or subscriber, as a transport of objects.

Rules: whoever promises less than the other side asks for is not connected. Where no QoS is said, a
subscriber asks for what all publishers promise, looked at again when one comes or goes, and a
publisher promises what anybody asks for; where one is said, the log names whom it keeps out, and
so it does where a type is another one. What comes faster than it is read is counted, and so is what
the network loses. Who comes and goes is told by the participant's `pump`: a message costs no look
at that. A subscriber whose type nobody has said waits for a publisher as long as the call under way
may take: others are found by and by.
"""

from __future__ import annotations

import contextlib
import math
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any, Final

from yarpy import scope
from yarpy.errors import LocalProtocolError, UnknownName, UnknownType
from yarpy.log import logger
from yarpy.peers.ros2 import kind as kinds
from yarpy.peers.ros2.carrier import Incoming, Outgoing
from yarpy.peers.ros2.dds.apart import WHY, apart
from yarpy.peers.ros2.dds.library import delete, load
from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.dds.qos import dds_qos
from yarpy.peers.ros2.dds.status import events_of, mask_of
from yarpy.peers.ros2.event import INCOMPATIBLE, MESSAGE, Events
from yarpy.peers.ros2.message.library import hash_of
from yarpy.peers.ros2.mismatch import Mismatch
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos, asked, promised
from yarpy.peers.ros2.token import PUBLISHER, SUBSCRIBER, Token
from yarpy.transports.inbox import Inbox

log = logger("yarpy.ros2")

TIMEOUT: Final = 2.0  # seconds for others to be found, where the call has no time limit
_LONG: Final = 10.0  # seconds of each wait that has no end
ROOM: Final = 100  # messages that the library keeps until they are taken, and counted
CHANGING: Final = 1.0  # seconds for others to hear of a new writer or reader
REPEATED: Final = 10.0  # seconds in which a new reader may hear something once more, or nothing yet
MOST_PUBLISHERS: Final = 1000  # whose last message is known


class DdsEndpoint(Inbox):
    """A port's publisher or subscriber."""

    def __init__(
        self, domain: int, port: str, node: Node, name: str, qos: Qos | None, role: str
    ) -> None:
        super().__init__()
        self.port_name, self.node, self.name, self.role = port, node, name, role
        self.qos, self._given = qos or Qos(), qos is not None
        self.kind: Any = None
        self._peers = PUBLISHER if role == SUBSCRIBER else SUBSCRIBER
        self._part = POOL.take(domain)
        self._class: Any = None
        self._topic: Any = None
        self._entity: Any = None
        self._shown: list[Any] = []  # readers or writers that are told of
        self._owned: tuple[Any, ...] = ()
        self._mismatch: Mismatch | None = None  # looks at others of another type
        self.events = Events()
        self._news = 0  # the statuses that tell who has come or gone
        self._refusal = 0  # ... and that somebody cannot be heard
        self._failure: Any = load().DDSException
        self._closed = False
        self._opening = threading.RLock()

    def begin(self, type_: str) -> None:
        """Find out about the type, and join. Raises UnknownName, UnknownType, DecodeError,
        PortClosed."""
        left = scope.remaining() if self.role == SUBSCRIBER else math.inf
        seconds = TIMEOUT if left == math.inf else left
        deadline = time.monotonic() + (0.0 if type_ else seconds)
        while not (seen := self._part.seen(self.name, self._peers)) and time.monotonic() < deadline:
            scope.sleep(0.05)
        with self._opening:
            if type_:
                self._open(kinds.named(type_, kinds.MESSAGE, seen))
                return
            found = kinds.learned(seen, kinds.MESSAGE, _ask)
            if found is not None:
                self._open(found[0])
            elif self.role == SUBSCRIBER:
                raise UnknownName(
                    f"nobody publishes {self.name} over DDS in domain {self._part.number}: name "
                    f"its type to be there first: ros2+dds:/{self.name}~package/msg/Type"
                )

    def settle(self, value: object) -> Any:
        """The class of its messages, chosen by the first value if nobody has said."""
        with self._opening:
            if self.kind is None:
                self._open(kinds.chosen(value))
            return self.kind

    def _open(self, kind: Any) -> None:
        from cyclonedds import topic

        self._class = self._part.class_of(kind)
        self._topic = topic.Topic(self._part.dds, f"rt{self.name}", self._class)
        self._owned = (self._topic,)
        self.kind = kind
        self._key = kinds.key_of(self._part.number, self.name, kind, False)
        self.qos = self._fitting()
        self._entity = self._show(self._made())
        self._owned = (self._entity, self._topic)
        self._mismatch = Mismatch(self.port_name, self._key, strict=False)
        self._part.watch.add(self.name, self._peers, self._mismatch.look)

    def _fitting(self) -> Qos:
        """The QoS for those who are there, unless one is said."""
        if self._given:
            return self.qos
        found = self._part.seen(self.name, self._peers)
        theirs = [item.qos for item in found if item.key and item.key.type == self._key.type]
        return asked(theirs) if self.role == SUBSCRIBER else promised(theirs)

    def _made(self) -> Any:
        """A reader or writer of the library with the present QoS."""
        raise NotImplementedError

    def _show(self, made: Any) -> Any:
        """Tell that a reader or writer is our node's, and hear what becomes of its promises."""

        def take() -> Callable[[], None]:
            found = made.take_status(self._news)
            return lambda: self._act(made, found)

        self._part.pump.add(made, take)
        self._shown.append(made)
        half = "readers" if self.role == SUBSCRIBER else "writers"
        self._part.discovery.add(self.node, **{half: (made,)})
        return made

    def _delete(self, entity: Any) -> None:
        """Delete a reader or writer."""
        self._part.pump.remove(entity)
        self._shown.remove(entity)
        self._part.discovery.remove(self.node, entity)
        delete(entity)

    def _act(self, made: Any, found: int) -> None:
        """Act upon the statuses that a reader or writer has got. In the thread of the pump."""
        with self._opening:
            if not self._over:
                self._note(made, found)
                self._meet(found)

    def _meet(self, found: int) -> None:
        """Fit those who have come or gone, as these statuses say."""
        raise NotImplementedError

    def _note(self, entity: Any, found: int) -> None:
        """Tell of what the statuses of a reader or writer say."""
        for event in events_of(entity, found, self.role == PUBLISHER):
            if event.policy in WHY:
                self._tell_apart(entity, event.policy)
            elif event.kind == INCOMPATIBLE and not self._given:
                continue  # we are about to do as they like
            elif event.kind == INCOMPATIBLE:
                log.warning(
                    "%s: somebody at %s promises less than we ask for, or asks for more than we "
                    "promise (%s; ours is %s): leave the qos out of ros2+dds+qos.NAME://..., or "
                    "name another",
                    *(self.port_name, self.name, event.policy or "of something", self.qos),
                )
            elif event.kind == MESSAGE:
                with self._counting:
                    self.dropped += event.times
            self.events.tell(event)

    def _tell_apart(self, entity: Any, policy: str) -> None:
        part, class_, key, mismatch = self._part, self._class, self._key, self._mismatch
        assert mismatch is not None
        for token in apart(policy, part, entity, class_, key, self._peers):
            mismatch.refused(token, *WHY[policy])

    def close(self) -> None:
        self.interrupt()
        with self._opening:
            if self._closed:  # an interrupted one is not
                return
            self._closed = True
        if self._mismatch is not None:
            self._part.watch.remove(self._mismatch.look)
        for item in self._shown:
            self._part.pump.remove(item)
        self._part.discovery.remove(self.node, *self._shown)
        for item in self._owned:
            delete(item)
        POOL.leave(self._part)

    def ended(self) -> bool:
        return self._over


class DdsPublisher(DdsEndpoint):
    """Writes what a port writes."""

    _next: Any = None  # the writer that takes over
    _due = 0.0  # ... and when

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._changing = threading.Lock()  # such a writer is being made

    def _made(self) -> Any:
        from cyclonedds import pub

        self._news, self._refusal = mask_of(True), load().DDSStatus.OfferedIncompatibleQos
        made: Any = pub.DataWriter(
            self._part.dds, self._topic, qos=dds_qos(self.qos, hash_of(self.kind), writes=True)
        )
        made.set_status_mask(self._news)
        return made

    def give(self, item: Outgoing) -> None:
        sample = self._class.__new__(self._class)
        body = item.body
        sample.body = body[0] if len(body) == 1 else b"".join(body)
        if self._changing.locked():  # a reader may know a new writer before we do
            with self._changing:
                pass
        if self._next is not None and self._is_due():
            self._take_over()
        self._entity.write(sample, item.time or time.time_ns())

    def _meet(self, found: int) -> None:
        """Promise more if somebody asks for it: to those who are there the present writer goes on
        until they can have heard of the new one, so that each message comes once."""
        if not found & self._refusal or self._given or self._next is not None:
            return
        wanted = self._fitting()
        if not wanted.latched or self.qos.latched:
            return
        with self._changing:
            self.qos = wanted
            made = self._show(self._made())
            self._owned = (made, *self._owned)
            self._due, self._next = time.monotonic() + CHANGING, made

    def _is_due(self) -> bool:
        """Return whether all can have heard of the new writer. Where nobody hears the present one,
        what it would write is for nobody."""
        return time.monotonic() >= self._due or not self._entity.get_matched_subscriptions()

    def _take_over(self) -> None:
        with self._opening:
            if self._over:
                return
            before, self._entity, self._next = self._entity, self._next, None
            self._owned = tuple(item for item in self._owned if item is not before)
        self._delete(before)  # once all has been confirmed, or a second later


class DdsSubscriber(DdsEndpoint):
    """Reads for a port, in the thread of its connection."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._waiting: Any = None
        self._bell: Any = None  # wakes who waits
        self._come: deque[Incoming] = deque()
        self._changed = False  # who publishes
        self._conditions: dict[int, Any] = {}  # that something has come, by the reader's id
        self._before: Any = None  # the reader that another has taken over from, for a moment
        self._due = 0.0  # ... and until when
        self._heard: set[int] = set()  # publishers of which the present one has heard
        self._repeats = False  # whether the present one may hear what the other one had
        self._last: dict[int, int] = {}  # when each publisher sent its last message, by its handle

    def _open(self, kind: Any) -> None:
        super()._open(kind)
        self._waiting = load().WaitSet(self._part.dds)
        self._bell = load().GuardCondition(self._part.dds)
        self._waiting.attach(self._bell)
        self._listen(self._entity)
        self._owned = (self._waiting, self._bell, *self._owned)

    def _listen(self, reader: Any) -> None:
        """Wait for what comes to a reader, too."""
        core = load()
        anything = core.SampleState.Any | core.ViewState.Any | core.InstanceState.Any
        condition = self._conditions[id(reader)] = core.ReadCondition(reader, anything)
        self._owned = (condition, *self._owned)
        self._waiting.attach(condition)

    def _made(self) -> Any:
        from cyclonedds import sub

        status = load().DDSStatus
        self._refusal = status.RequestedIncompatibleQos
        self._fits = self._refusal | status.SubscriptionMatched  # what may have us read anew
        self._news = self._fits | mask_of(False)
        made: Any = sub.DataReader(
            self._part.dds,
            self._topic,
            qos=dds_qos(self.qos, hash_of(self.kind), ROOM, writes=False),
        )
        made.set_status_mask(self._news)
        return made

    def receive(self, wait: bool = True) -> tuple[object] | None:
        if not self._greeted:
            return super().receive(wait)
        try:
            while not self._over:
                waited = wait and not self._come
                found = self._wait() if waited else 1
                if self._changed:
                    self._adapt()
                self._take_all()
                if self._come:
                    return (self._come.popleft(),)
                if not (waited and (found or self._timeout is None or self._before is not None)):
                    raise BlockingIOError("nothing has come")
        except self._failure as error:
            if not self._over:
                raise BrokenPipeError(f"DDS says: {error}") from error
        return None

    def _wait(self) -> int:
        """Wait until something has come or changed; 0 if neither has, for as long as one waits."""
        limit = _LONG if self._timeout is None else self._timeout
        if self._before is not None:
            limit = min(limit, CHANGING)
        found: int = self._waiting.wait(int(limit * 1e9))
        return found

    def _meet(self, found: int) -> None:
        if found & self._fits and not self._given:
            self._changed = True
            self._bell.set(True)

    def _adapt(self) -> None:
        """Read as the present publishers let us. A reader cannot change, so another takes over;
        both read until it knows them all, and what both have is taken once."""
        with self._opening:
            if self._over:  # which the bell tells, too
                return
            self._bell.set(False)
            self._changed = False
            wanted = self._fitting()
            if wanted == self.qos:
                return
            log.info("%s: %s is read as %s from now on", self.port_name, self.name, wanted)
            self.qos = wanted
            self._retire()
            self._before, self._entity = self._entity, self._show(self._made())
            self._owned = (self._entity, *self._owned)
            self._listen(self._entity)
            self._heard.clear()
            self._due, self._repeats = time.monotonic() + CHANGING, True

    def _retire(self) -> None:
        before, self._before = self._before, None
        if before is not None:
            condition = self._conditions.pop(id(before))
            self._waiting.detach(condition)
            delete(condition)
            self._owned = tuple(i for i in self._owned if i is not before and i is not condition)
            self._delete(before)

    def _take_all(self) -> None:
        """Take what there is, and count what is too much."""
        if self._before is not None:
            self._take(self._before)
        self._take(self._entity)
        if self._before is not None and self._has_taken_over():
            with self._opening:
                if not self._over:
                    self._retire()
        most = self.qos.kept
        while len(self._come) > most:
            self._come.popleft()
            with self._counting:  # the network's losses are counted in another thread
                self.dropped += 1

    def _has_taken_over(self) -> bool:
        """Return whether the reader before may go: its publishers know the present one, which has
        heard of each of them, or have had time enough."""
        now = time.monotonic()
        if now < self._due:
            return False
        return now >= self._due + REPEATED or self._heard.issuperset(
            self._before.get_matched_publications()
        )

    def _take(self, reader: Any) -> None:
        for sample in reader.take(N=ROOM):
            body = getattr(sample, "body", None)
            if body is None:
                continue
            who = sample.sample_info.publication_handle
            when = int(sample.sample_info.source_timestamp)
            if self._before is not None and reader is self._entity:
                self._heard.add(who)
            if self._repeats:
                if when <= self._last.get(who, -1):
                    continue  # the reader before had it
                self._repeats = self._before is not None or time.monotonic() < self._due + REPEATED
            if who in self._last or len(self._last) < MOST_PUBLISHERS:
                self._last[who] = when
            self._come.append(Incoming(body, 0, when))

    def interrupt(self) -> None:
        super().interrupt()
        if self._bell is not None:
            with contextlib.suppress(self._failure):  # it has been closed
                self._bell.set(True)


def _ask(token: Token, name: str, kind: str) -> Any:
    raise UnknownType(f"{name} is not known here, and over DDS nobody describes it")


def open_dds(
    domain: int, port: str, node: Node, name: str, type_: str, qos: Qos | None, role: str
) -> DdsEndpoint:
    """The endpoint of a port at a topic; `role`: PUBLISHER or SUBSCRIBER. Raises UnknownPlugin (the
    extra is not installed), UnknownName (nobody says the type), UnknownType, LocalProtocolError."""
    failure = load().DDSException
    made = DdsSubscriber if role == SUBSCRIBER else DdsPublisher
    endpoint = made(domain, port, node, name, qos, role)
    try:
        endpoint.begin(type_)
    except BaseException as error:
        endpoint.close()
        if isinstance(error, failure):
            raise LocalProtocolError(f"DDS says of {name}: {error}") from error
        raise
    return endpoint
