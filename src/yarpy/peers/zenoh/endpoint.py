"""Endpoints: what a port is at a key of Zenoh, as a transport of objects.

    Publisher, Subscriber      messages: put, and a subscription
    Asker, Server              questions and answers: get, and a queryable

Rules: what carriers write comes here as `Outgoing`, what they read leaves as `Incoming`. Zenoh's
threads put what comes into the inbox, and wait for nothing. A router that goes away is joined again
by the session itself, and what was declared is back then.
"""

from __future__ import annotations

from typing import Any, Final

from yarpy.limit import ZENOH_ATTACHMENT, ZENOH_PARAMETERS
from yarpy.log import logger, readable
from yarpy.peers.zenoh.carrier import (
    BLOCK,
    DELETE,
    EXPRESS,
    GONE,
    HERE,
    LIVELINESS,
    TEXT,
    TIMESTAMP,
    Incoming,
    Outgoing,
)
from yarpy.peers.zenoh.library import CALLS, WAKE, load
from yarpy.peers.zenoh.transport import SharedSession
from yarpy.peers.zenoh.tunnel.line import undeclare
from yarpy.route import CarrierSpec, parse_carrier
from yarpy.transports.inbox import Inbox

log = logger("yarpy.zenoh")

KEPT: Final = 1000  # messages that wait to be read
MOST_QUESTIONS: Final = 100  # that wait for a server of ours
_NOTHING_SAID: Final = parse_carrier("zenoh")
ANSWER: Final = 600.0  # seconds for an answer; who asks may wait less long


class Endpoint(Inbox):
    """The base of publishers, subscriptions, clients and servers. It closes the shared session."""

    def __init__(self, shared: SharedSession, key: str, spec: CarrierSpec = _NOTHING_SAID) -> None:
        super().__init__()
        self.name = key
        self._spec = spec
        self._shared = shared
        self._session: Any = shared.session
        self._declared: list[Any] = []
        self._closed = False
        self.begin()

    def begin(self) -> None:
        """Declare what is needed."""

    def _live(self) -> None:
        """Have a token of liveliness, if that is asked for."""
        if LIVELINESS in self._spec.tokens:
            self._declared.append(self._session.liveliness().declare_token(self.name))

    def ended(self) -> bool:
        return self._closed or bool(self._session.is_closed())

    def close(self) -> None:
        if self._closed:
            return
        self._closed = True
        self.interrupt()
        for thing in self._declared:
            undeclare(thing)
        self._declared.clear()
        self._shared.close()


class Publisher(Endpoint):
    """Puts messages on its key."""

    def begin(self) -> None:
        library, tokens = load(), self._spec.tokens
        said: dict[str, Any] = {}
        priority = self._spec.value("priority")
        if priority is not None:
            said["priority"] = getattr(library.Priority, priority)
        if BLOCK in tokens:
            said["congestion_control"] = library.CongestionControl.BLOCK
        if EXPRESS in tokens:
            said["express"] = True
        self._declared.append(self._session.declare_publisher(self.name, **said))
        self._live()

    def give(self, item: Outgoing) -> None:
        publisher, beside = self._declared[0], item.attachment or None
        when = self._session.new_timestamp() if TIMESTAMP in self._spec.tokens else None
        with CALLS:
            if item.deletes:
                publisher.delete(attachment=beside, timestamp=when)
            else:
                body = bytes(item.payload)
                publisher.put(body, encoding=item.encoding, attachment=beside, timestamp=when)


class Subscriber(Endpoint):
    """Takes messages from its keys."""

    def begin(self) -> None:
        of = self._session
        if LIVELINESS in self._spec.tokens:
            hear = load().handlers.Callback(self._live_heard, indirect=False)
            declared = of.liveliness().declare_subscriber(self.name, hear, history=True)
        else:
            hear = load().handlers.Callback(self._heard, indirect=False)
            declared = of.declare_subscriber(self.name, hear)
        self._declared.append(declared)

    def _heard(self, sample: Any) -> None:
        said = Incoming(b"", place=str(sample.key_expr), attachment=_attached(sample))
        when = sample.timestamp
        if TIMESTAMP in self._spec.tokens and when is not None and not said.attachment:
            said.attachment = b"0 %.6f" % when.get_time().timestamp()
        if sample.kind == load().SampleKind.PUT:
            said.payload, said.encoding = sample.payload.to_bytes(), str(sample.encoding)
        elif DELETE in self._spec.tokens and said.attachment != WAKE:
            said.event = DELETE
        else:
            return
        self.put(said, KEPT)

    def _live_heard(self, sample: Any) -> None:
        event = HERE if sample.kind == load().SampleKind.PUT else GONE
        self.put(Incoming(b"", place=str(sample.key_expr), event=event), KEPT)


def _attached(said: Any) -> bytes:
    """Return what is attached to a sample or a question, as far as it is kept."""
    beside = said.attachment
    return b"" if beside is None else bytes(beside.to_bytes()[:ZENOH_ATTACHMENT])


class Asker(Endpoint):
    """Asks whoever answers on its key; the first answer counts."""

    _count = 0

    def give(self, item: Outgoing) -> None:
        self._count += 1
        number = self._count
        answered = False

        def heard(reply: Any) -> None:
            nonlocal answered
            if not answered and number == self._count:
                answered = True
                self.put(_answer(reply), MOST_QUESTIONS)

        def over() -> None:
            if not answered and number == self._count:
                why = f"nobody answers at the key {self.name} of Zenoh"
                self.put(Incoming(b"", failure=why), MOST_QUESTIONS)

        zenoh = load()
        with CALLS:
            self._session.get(
                self.name,
                zenoh.handlers.Callback(heard, over, indirect=False),
                target=zenoh.QueryTarget.ALL,
                consolidation=zenoh.ConsolidationMode.NONE,
                payload=bytes(item.payload),
                encoding=item.encoding,
                attachment=item.attachment or None,
                timeout=ANSWER,
            )


def _answer(reply: Any) -> Incoming:
    good = reply.ok
    if good is not None:
        return Incoming(good.payload.to_bytes(), encoding=str(good.encoding))
    why = readable(reply.err.payload.to_bytes()[:1000].decode("utf-8", "replace"))
    form, _, kind = str(reply.err.encoding).partition(";")
    named = form == TEXT and kind.isidentifier() and why.startswith(f"{kind}: ")
    return Incoming(b"", failure=why or "it failed", raised=kind if named else "")


class Server(Endpoint):
    """Answers questions on its key."""

    def begin(self) -> None:
        hear = load().handlers.Callback(self._heard, indirect=False)
        self._declared.append(self._session.declare_queryable(self.name, hear, complete=True))
        self._live()

    def _heard(self, query: Any) -> None:
        if self.waiting >= MOST_QUESTIONS:
            self.dropped += 1
            query.reply_err(b"too many questions are waiting")
            return
        said = Incoming(b"", query, attachment=_attached(query), encoding=str(query.encoding))
        if not query.parameters.is_empty():
            said.place = str(query.selector)
            if len(said.place) > ZENOH_PARAMETERS:
                query.reply_err(b"more than %d letters of parameters" % ZENOH_PARAMETERS)
                return
        if query.payload is None:
            said.parameters = [*query.parameters]
        else:
            said.payload = query.payload.to_bytes()
        self.put(said, MOST_QUESTIONS)

    def give(self, item: Outgoing) -> None:
        query = item.to
        if query is not None:
            with CALLS:
                if item.failed:
                    query.reply_err(bytes(item.payload), encoding=item.encoding)
                else:
                    query.reply(self.name, bytes(item.payload), encoding=item.encoding)
            query.drop()  # the asker waits for the end of it, not for the answer
