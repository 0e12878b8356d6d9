"""Pulse: whether the other ends of datagram connections still live.

Rules: TCP tells of its end, datagrams do not, so an end that gives no sign is asked: a sender that
is silent, and every receiver of a multicast group. (A UDP sender hears from the receiver's host.)
Where nobody listens the other end has died; so it has where somebody answers, twice in a row, who
knows nothing of the connection. Somebody too busy to answer lives. A sender whom nobody can ask,
since no name service knows where it is, lives by its traffic: its lease ends when none comes for
long. Runs in the thread of `repair`, which mends what has died; what lapsed just ends.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import Final
from weakref import WeakKeyDictionary

from yarpy.contact import Contact, parse_contact
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import LinkClosed, YarpError
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.log import logger
from yarpy.port import probe
from yarpy.port.hub import Hub

log = logger("yarpy.port")

SOON: Final = 0.4  # seconds from a sign of life, or a bad one, to the next question
LATER: Final = 1.6  # ... while all that is heard are good answers
CERTAIN: Final = 2
LEASE: Final = 300.0  # seconds of silence in which a sender is let be whom nobody can ask

Link = Inbound | Outbound


class _Sign:
    """When a connection is to be looked at, and what it was found like."""

    __slots__ = ("contact", "due", "heard", "messages", "misses", "pause")

    def __init__(self) -> None:
        # Where the other end is. Kept, since its name may be taken off the name server first.
        self.contact: Contact | None = None
        self.messages = -1
        self.misses = 0
        self.pause = SOON
        self.heard = time.monotonic()
        self.due = self.heard + SOON


class Pulse:
    """Looks at the datagram connections of ports again and again, and says which have died."""

    def __init__(self, on_death: Callable[[Hub, Link], None]) -> None:
        self._on_death = on_death
        self._signs: WeakKeyDictionary[Link, _Sign] = WeakKeyDictionary()

    def look(self, hubs: Iterable[Hub]) -> None:
        """Ask about every connection whose time has come."""
        for hub in hubs:
            for link in hub.inputs:
                if link.carrier.connectionless and self._is_dead(hub, link):
                    self._on_death(hub, link)
            for output in hub.outputs:
                if output.carrier.broadcast and self._is_dead(hub, output):
                    self._on_death(hub, output)

    def _is_dead(self, hub: Hub, link: Link) -> bool:
        sign = self._signs.get(link)
        if sign is None:
            sign = self._signs[link] = _Sign()
            sign.contact = _other_end(hub, link)  # while it lives, and has its name
        now = time.monotonic()
        if now < sign.due:
            return False
        heard = isinstance(link, Inbound) and link.counter.messages != sign.messages
        sign.messages = link.counter.messages
        if heard:
            sign.heard = now
        else:
            sign.contact = _other_end(hub, link) or sign.contact
        if sign.contact is None and isinstance(link, Inbound) and now - sign.heard > LEASE:
            self._lapse(hub, link)
            return False
        found = 0 if heard or sign.contact is None else doubt(hub, link, sign.contact)
        sign.misses = sign.misses + found if found else 0
        sign.pause = SOON if heard or found else min(2 * sign.pause, LATER)
        sign.due = now + sign.pause
        return sign.misses >= CERTAIN

    def _lapse(self, hub: Hub, link: Inbound) -> None:
        log.info(
            "%s: the connection from %s over %s ends: nothing came for %g s, and no name service "
            "knows where to ask whether it still stands",
            hub.name,
            link.route.source or "somebody without a name",
            link.route.carrier,
            LEASE,
        )
        link.close()


def _other_end(hub: Hub, link: Link) -> Contact | None:
    try:
        route = link.route
        contact = parse_contact(route.source if isinstance(link, Inbound) else route.target)
        if contact.reachable:
            return contact
        names = hub.service()
        return None if names is None else names.query(contact.name)
    except YarpError:
        return None


def doubt(hub: Hub, link: Link, contact: Contact) -> int:
    """Ask the port at the other end, at `contact`, about the connection: 0 all is well, 1 unknown
    there, CERTAIN nobody is there."""
    direction = Vocab("out" if isinstance(link, Inbound) else "in")
    try:
        listed = probe.ask(contact, [Vocab("list"), direction], secret_=hub.key)
    except LinkClosed:
        return CERTAIN
    except (YarpError, OSError):
        return 0
    known = [plain_text(name) for name in listed]
    # Somebody may have connected us by our address instead of our name.
    return 0 if hub.name in known or any(":" in name for name in known) else 1
