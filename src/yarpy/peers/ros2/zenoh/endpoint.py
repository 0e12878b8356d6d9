"""Endpoints: a port's publisher, client or server in Zenoh, as a transport of objects.

    Publisher      messages; Client, Server      questions and answers; `subscriber.py` has the rest

Rules: what carriers write comes here as `Outgoing`, what they read leaves as `Incoming`. Zenoh's
threads put what comes into the inbox. An endpoint
whose type nobody knows yet joins the graph once somebody says it, or the first message does. The
log names whoever has another type at the same topic: nothing else would say why nothing comes.
"""

from __future__ import annotations

import threading
import time
from functools import partial
from typing import Any, ClassVar, Final

from yarpy.errors import DecodeError, YarpError
from yarpy.log import logger, readable
from yarpy.peers.ros2 import kind as kinds
from yarpy.peers.ros2.carrier import GONE, Incoming, Outgoing
from yarpy.peers.ros2.event import Events
from yarpy.peers.ros2.key import NO_HASH, Key
from yarpy.peers.ros2.mismatch import Mismatch
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import KEEP_ALL, Qos, promised
from yarpy.peers.ros2.token import CLIENT, PUBLISHER, SERVER, SUBSCRIBER, Token, gid
from yarpy.peers.ros2.zenoh.attachment import GID_SIZE, PACK, attachment, parse_attachment
from yarpy.peers.ros2.zenoh.coalesced import Coalesced
from yarpy.peers.ros2.zenoh.description import describe
from yarpy.peers.ros2.zenoh.participant import Declared, Participant
from yarpy.peers.ros2.zenoh.querier import Querier
from yarpy.peers.zenoh.spare import Spare
from yarpy.transports.inbox import Inbox

log = logger("yarpy.ros2")

SOON: Final = 0.2  # seconds in which a subscriber of no type learns ours
MOST_QUESTIONS: Final = 100  # that wait for a server of ours


class Endpoint(Inbox):
    """The base of publishers, subscriptions, clients and servers."""

    role: ClassVar[str] = ""
    peers: ClassVar[tuple[str, ...]] = ()
    what: ClassVar[str] = kinds.MESSAGE
    hears: ClassVar[bool] = False  # what comes may be read before `join` is over

    def __init__(
        self, participant: Participant, port: str, node: Node, name: str, qos: Qos | None
    ) -> None:
        super().__init__()
        self.participant = participant
        self.port_name = port
        self.node = node
        self.name = name
        self.qos = qos or Qos()
        self.given_qos = qos is not None
        self.kind: Any = None
        self.key: Key | None = None
        self._old = False  # Humble: no hashes
        self._declared: Declared | None = None
        self._handles: list[Any] = []
        self._gid = b""
        self._closed = False
        self._mismatch: Mismatch | None = None
        self._opening = threading.RLock()  # the type is settled once
        self._look = Coalesced(self._take_type, f"yarpy type of {name}")
        self.events = Events()

    # -- as the carrier sees it -------------------------------------------------------------------

    def settle(self, value: object) -> Any:
        """The class of its messages, chosen by the first value if nobody has said."""
        with self._opening:
            if self.kind is None and not self._learn():
                self.open(kinds.chosen(value))
            return self.kind

    # -- joining ----------------------------------------------------------------------------------

    def begin(self, type_: str, old: bool, timeout: float) -> None:
        """Find out about the type and join, if that is possible now. Raises UnknownType,
        DecodeError; what Zenoh raises."""
        graph = self.participant.graph
        kinds_ = (self.role, *self.peers)
        seen = graph.wait(self.name, *kinds_, timeout=timeout)
        with self._opening:
            if type_:
                self._fit(seen)
                self.open(kinds.named(type_, self.what, seen, old), old)
            else:
                self._learn()
        for token in graph.watch(self._watch):
            self._watch(token, True)

    def _learn(self) -> bool:
        """Take the type from the graph, and how much is kept; whether there is one. Raises
        UnknownType."""
        graph = self.participant.graph
        seen = graph.endpoints(self.name, *self.peers) or graph.endpoints(self.name, self.role)
        found = kinds.learned(seen, self.what, partial(describe, self.participant))
        if found is None:
            return False
        kind, key = found
        self._fit(seen)
        self.open(kind, key.hash == NO_HASH)
        return True

    def _fit(self, seen: list[Token]) -> None:
        """Keep messages, or ask for those that were kept, if one of the peers does: over Zenoh that
        keeps nobody out."""
        theirs = [token.qos for token in seen if token.kind in self.peers]
        if not self.given_qos:
            self.qos = promised(theirs)

    def open(self, kind: Any, old: bool = False) -> None:
        """Join the graph with a type."""
        domain = self.participant.graph.domain
        self._old = old
        key = kinds.key_of(domain, self.name, kind, old)
        self._declared = self.participant.declare(
            self.role, self.node, key, self.qos, self.extra(kind)
        )
        self._gid = gid(self._declared.text)
        before = self.key, self.kind
        if self.hears:
            self.key, self.kind = key, kind
        try:
            self.join(key, kind)
        except BaseException:
            self.key, self.kind = before
            raise
        self._declared.show()
        self._mismatch = self._mismatch or Mismatch(self.port_name, key, strict=True)
        self.key, self.kind = key, kind

    def extra(self, kind: Any) -> str:
        """The fields at the end of its token."""
        return ""

    def join(self, key: Key, kind: Any) -> None:
        """Publish, subscribe, or serve."""

    def _watch(self, token: Token, come: bool) -> None:
        """A token of anybody. In a thread of Zenoh."""
        key = token.key
        if self._closed or key is None or key.name != self.name or token.kind not in self.peers:
            return
        if not come:
            self.left(token)
        elif self.key is None or self._mismatch is None:
            self._look()
        elif key[2:] != self.key[2:]:
            self._mismatch.look(token)
        else:
            self.joined(token)

    def joined(self, token: Token) -> None:
        """A peer with the same type has come. In a thread of Zenoh."""

    def left(self, token: Token) -> None:
        """A peer has gone, of whatever type. In a thread of Zenoh."""

    def _take_type(self) -> None:
        try:
            with self._opening:
                if self.kind is None and not self._closed:
                    self._learn()
        except YarpError as error:
            log.warning("%s: %s", self.port_name, error)

    # -- the end ----------------------------------------------------------------------------------

    def ended(self) -> bool:
        return self._closed or bool(self.participant.session.is_closed())

    def close(self) -> None:
        with self._opening:
            if self._closed:
                return
            self._closed = True
        self.interrupt()
        self.participant.graph.unwatch(self._watch)
        if not self.participant.session.is_closed():
            if self._declared is not None:  # first: who sees it still makes use of it
                self._declared.close()
            for handle in self._handles:
                handle.undeclare()
        self._handles.clear()
        self.participant.close()


class Publisher(Endpoint):
    """Puts messages on its key."""

    role = PUBLISHER
    peers = (SUBSCRIBER,)

    _count = 0

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._spare = Spare()

    def settle(self, value: object) -> Any:
        """As of an endpoint. Who subscribes without a type learns it from us, by now, and is waited
        for: else nobody would hear the first message."""
        if self.kind is None and super().settle(value) is not None:
            self.participant.graph.wait(self.name, SUBSCRIBER, timeout=SOON)
        return self.kind

    def join(self, key: Key, kind: Any) -> None:
        import zenoh

        blocks = self.qos.reliable and self.qos.history == KEEP_ALL
        options: dict[str, Any] = {
            "congestion_control": (
                zenoh.CongestionControl.BLOCK if blocks else zenoh.CongestionControl.DROP
            ),
            "reliability": (
                zenoh.Reliability.RELIABLE if self.qos.reliable else zenoh.Reliability.BEST_EFFORT
            ),
        }
        session = self.participant.session
        if self.qos.latched:
            from zenoh import ext

            misses = ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5)
            self._publisher = ext.declare_advanced_publisher(
                session,
                str(key),
                cache=ext.CacheConfig(max_samples=self.qos.kept),
                publisher_detection=True,
                sample_miss_detection=misses if self.qos.reliable else None,
                **options,
            )
        else:
            self._publisher = session.declare_publisher(str(key), **options)
        self._handles.append(self._publisher)

    def give(self, item: Outgoing) -> None:
        self._count += 1
        body = item.body
        joined = None if len(body) == 1 else self._spare.join(body)
        beside = PACK(self._count, item.time or time.time_ns(), GID_SIZE, self._gid)
        self._publisher.put(body[0] if joined is None else joined, attachment=beside)
        if joined is not None:
            self._spare.give_back(joined)


class Client(Endpoint):
    """Asks a service."""

    role = CLIENT
    peers = (SERVER,)
    what = kinds.SERVICE

    _count = 0
    _querier: Querier

    def join(self, key: Key, kind: Any) -> None:
        self._querier = Querier(self.participant.session, key)
        self._handles.append(self._querier)

    def give(self, item: Outgoing) -> None:
        self._count += 1
        number, key = self._count, self.key
        assert key is not None
        answered = False
        servers = self.participant.graph.endpoints(self.name, SERVER)
        served = any(server.key == key for server in servers)

        def heard(reply: Any) -> None:
            nonlocal answered
            if answered or number != self._count:
                return  # of two servers the first is taken
            answered = True
            self.put(answer_of(reply), MOST_QUESTIONS)

        def over() -> None:
            if not answered and number == self._count:
                why = f"nobody serves {self.name} as {kinds.shown(key)}"
                if served:
                    why = f"{GONE} {self.name} went away during the call"
                self.put(Incoming(b"", failure=why), MOST_QUESTIONS)

        beside = attachment(number, item.time or time.time_ns(), self._gid)
        self._querier.get(heard, over, b"".join(item.body), beside, served)


def answer_of(reply: Any) -> Incoming:
    """Return what is received for a server's reply."""
    good = reply.ok
    if good is None:
        why = readable(bytes(reply.err.payload)[:1000].decode("utf-8", "replace"))
        return Incoming(b"", failure=why or "it failed")
    number, when = 0, 0
    if good.attachment is not None:
        try:
            number, when, _ = parse_attachment(bytes(good.attachment))
        except DecodeError as error:
            return Incoming(b"", failure=str(error))
    return Incoming(good.payload.to_bytes(), number, when)


class Server(Endpoint):
    """Serves a service."""

    role = SERVER
    peers = (CLIENT,)
    what = kinds.SERVICE
    hears = True

    def join(self, key: Key, kind: Any) -> None:
        from zenoh.handlers import Callback

        hear = Callback(self._heard, indirect=False)
        self._handles.append(
            self.participant.session.declare_queryable(str(key), hear, complete=True)
        )

    def _heard(self, query: Any) -> None:
        attached, payload = query.attachment, query.payload
        try:
            number, when, sender = parse_attachment(b"" if attached is None else bytes(attached))
        except DecodeError as error:
            self.dropped += 1
            query.reply_err(str(error).encode())
            return
        if self.waiting >= MOST_QUESTIONS:
            self.dropped += 1
            query.reply_err(b"too many questions are waiting")
            return
        body = b"" if payload is None else payload.to_bytes()
        self.put(Incoming(body, number, when, (query, number, sender)), MOST_QUESTIONS)

    def give(self, item: Outgoing) -> None:
        if item.to is None:
            return
        query, number, sender = item.to
        if item.failure:
            query.reply_err(item.failure.encode("utf-8", "replace"))
        else:
            beside = attachment(number, time.time_ns(), sender)
            query.reply(str(self.key), b"".join(item.body), attachment=beside)
        query.drop()  # the asker waits for the end of it, not for the answer
