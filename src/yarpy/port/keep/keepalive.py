"""Keepalive: whether the other ends of datagram connections still live, and how much came there.

Rules: a TCP connection shows its end, datagrams do not, so the other end is asked when it gives no
sign of life: a silent sender, and every receiver of a multicast group. (A UDP sender hears from the
receiver's host.) The other end is dead if its host refuses, if the port there says twice in a row
that it knows nothing of the connection, or if the host cannot be reached for `GONE`. One that is
too busy to answer is alive. To notice a death at once and ask rarely, we hold a silent TCP
connection to the other end's port if that is one of yarpy: it ends with the program. A sender that
cannot be asked, since no name service knows its address, lives by its traffic: its lease ends after
a long silence.

A receiver that does not acknowledge is asked now and then, while some are sent, how many messages
came, in TLS if the connection is. A port of C++ does not know.

`look` never blocks: each question has a short-lived thread, which also calls back when a connection
is dead. A connection whose lease has ended is closed, and not asked for again.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import Final

from yarpy.contact import Contact, parse_contact
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import AddressError, LinkClosed, YarpError
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.link.send.sender import mute
from yarpy.log import logger
from yarpy.port.connect import probe
from yarpy.port.connect.dialling import Attempts
from yarpy.port.hub import Hub
from yarpy.transports.tcp import TcpTransport, dial

log = logger("yarpy.port")

SOON: Final = 0.4  # seconds from a sign of life, or a bad one, to the next question
LATER: Final = 1.6  # ... while all that is heard are good answers
RARELY: Final = 10.0  # ... over a stream, which tells of its end
CERTAIN: Final = 2
GONE: Final = 25.0  # seconds after which a host that cannot be reached is taken for dead
LEASE: Final = 300.0  # seconds of silence allowed to a sender that cannot be asked
FIRST_LEASE: Final = 15.0  # ... and has never sent anything

Link = Inbound | Outbound


class _Sign:
    """The time when a connection is to be looked at next, and what it was found like."""

    __slots__ = (
        "answers", "asked", "asking", "contact", "cut", "due", "heard", "line", "messages",
        "misses", "pause", "reached",
    )  # fmt: skip

    def __init__(self) -> None:
        # Where the other end is. Kept, since its name may be taken off the name server first.
        self.contact: Contact | None = None
        self.messages = -1
        self.misses = 0
        self.pause = SOON
        self.heard = self.reached = time.monotonic()
        self.due = self.heard
        self.asked = False  # ever
        self.asking = False
        self.answers = True  # whether the other end knows how to tell of one connection
        self.line: TcpTransport | None = None  # silent; ends with the other end's program
        self.cut = False  # it has ended

    def hang_up(self) -> None:
        """End the silent connection."""
        if self.line is not None:
            self.line.close()
            self.line = None


class Keepalive:
    """Looks at the connections of ports again and again, and says which datagram ones have died."""

    def __init__(self, on_death: Callable[[Hub, Link], None]) -> None:
        self._on_death = on_death
        self._signs: dict[Link, _Sign] = {}
        self.questions = Attempts("ask")

    def look(self, hubs: Iterable[Hub]) -> None:
        """Ask about every connection whose time has come."""
        seen: set[Link] = set()
        for hub in hubs:
            links: tuple[Link, ...] = (*hub.inputs.links, *hub.outputs.links)
            for link in links:
                if _silent(link):
                    seen.add(link)
                    self._look_at(hub, link)
        for link in self._signs.keys() - seen:
            self._signs.pop(link).hang_up()

    @property
    def watching(self) -> bool:
        """Return whether looking would notice the end of any connection."""
        return any(sign.line is not None for sign in tuple(self._signs.values()))

    def forget(self) -> None:
        """Nothing is looked at any more."""
        for sign in self._signs.values():
            sign.hang_up()
        self._signs.clear()

    def _look_at(self, hub: Hub, link: Link) -> None:
        sign = self._signs.get(link)
        if sign is None:
            sign = self._signs[link] = _Sign()
        now = time.monotonic()
        if sign.line is not None and sign.line.ended():
            sign.cut = True
            sign.hang_up()
        if sign.asking or (now < sign.due and not sign.cut):
            return
        messages = link.counter.messages
        heard = messages != sign.messages
        sign.messages = messages
        if isinstance(link, Inbound):
            if heard:
                sign.heard = now
            if heard and sign.asked and not sign.cut:
                self._go_on(link, sign, good=False, bad=0)
                return
        elif not (heard or link.sender.outcome.open or link.carrier.delivery.broadcast):
            sign.due = now + sign.pause  # nothing is open: nothing to ask
            return
        silent = 0.0 if heard else now - sign.heard
        sign.asked = sign.asking = True
        peer = _peer(link)
        target = peer if peer.startswith("/") else f"{peer} {id(link)}"  # such are not unique
        if not self.questions.begin(target, partial(self._ask, hub, link, sign, silent)):
            sign.asking = False

    def _ask(self, hub: Hub, link: Link, sign: _Sign, silent: float) -> None:
        """Ask about a connection, and tell if it is dead. Nothing came for `silent` seconds."""
        cut, sign.cut = sign.cut, False
        try:
            if not cut:
                sign.contact = _other_end(hub, link) or sign.contact
            if sign.contact is None:
                lease = LEASE if link.counter.messages else FIRST_LEASE
                if isinstance(link, Inbound) and silent > lease:
                    self._lapse(hub, link, lease)
                self._go_on(link, sign, good=True, bad=0)
                return
            bad = self._doubt(hub, link, sign)
            if bad and cut:
                bad = CERTAIN  # whoever answers there now is another program
            self._go_on(link, sign, good=not bad, bad=bad)
            if sign.misses >= CERTAIN and link.carrier.delivery.connectionless:
                self._on_death(hub, link)
        finally:
            sign.asking = False

    def _go_on(self, link: Link, sign: _Sign, good: bool, bad: int) -> None:
        """Set the time of the next look, after a `good` answer or so many `bad` ones."""
        sign.misses = sign.misses + bad if bad else 0
        longest = LATER if link.carrier.delivery.connectionless else RARELY
        sign.pause = min(2 * sign.pause, longest) if good else SOON
        sign.due = time.monotonic() + sign.pause

    def _doubt(self, hub: Hub, link: Link, sign: _Sign) -> int:
        """Ask the other end about the connection: 0 all is well, 1 unknown there, CERTAIN nobody
        is there."""
        contact = sign.contact
        assert contact is not None
        left = link.counter.messages
        if sign.answers:
            side = "out" if isinstance(link, Inbound) else "in"
            try:
                told = probe.connection(
                    contact, side, hub.name, hub.key, secure=link.route.spec.in_tls
                )
            except LinkClosed as error:
                return self._unreached(sign, error)
            except LookupError:
                sign.answers = False
            except (YarpError, OSError):
                return 0
            else:
                sign.reached = time.monotonic()
                self._hold(hub, link, sign, contact)
                if told is not None:
                    _vouch(link)
                    _tell(link, left, int(told.get("received", 0)))
                    return 0
        try:
            bad = doubt(hub, link, contact)
        except LinkClosed as error:
            return self._unreached(sign, error)
        except (YarpError, OSError):
            return 0
        sign.reached = time.monotonic()
        if not bad:
            _vouch(link)
        if not (bad or sign.answers):
            _tell(link, left, left)  # it lives, and nobody knows more
        return bad

    def _unreached(self, sign: _Sign, error: LinkClosed) -> int:
        """Nobody answered: a cut link may be mended, and a dead host stays silent."""
        gone = probe.is_refused(error) or time.monotonic() - sign.reached > GONE
        return CERTAIN if gone else 0

    def _hold(self, hub: Hub, link: Link, sign: _Sign, contact: Contact) -> None:
        """Have a silent connection; not where it would be asked for a key."""
        if sign.line is None and link.carrier.delivery.connectionless and not hub.key:
            with contextlib.suppress(OSError, AddressError):
                sign.line = dial(contact.host, contact.port, 1.0)
                if link not in self._signs:  # over meanwhile
                    sign.hang_up()

    def _lapse(self, hub: Hub, link: Inbound, lease: float) -> None:
        log.info(
            "%s: the connection from %s over %s ends: nothing came for %g s, and no name service "
            "knows where to ask whether it still stands",
            hub.name,
            link.route.source or "somebody without a name",
            link.route.carrier,
            lease,
        )
        link.close()


def _vouch(link: Link) -> None:
    if isinstance(link, Inbound):
        link.vouched = True


def _tell(link: Link, left: int, came: int) -> None:
    if isinstance(link, Outbound) and link.active:
        link.sender.confirmation.told(left, came)


def _silent(link: Link) -> bool:
    """Return whether the other end of a connection says nothing by itself."""
    if isinstance(link, Inbound) or link.carrier.delivery.connectionless:
        return link.carrier.delivery.connectionless
    return link.dialled and mute(link.carrier)


def _peer(link: Link) -> str:
    return link.route.source if isinstance(link, Inbound) else link.route.target


def _other_end(hub: Hub, link: Link) -> Contact | None:
    try:
        contact = parse_contact(_peer(link))
        if contact.reachable:
            return contact
        names = hub.service()
        return None if names is None else names.query(contact.name)
    except YarpError:
        return None


def doubt(hub: Hub, link: Link, contact: Contact) -> int:
    """Ask the port at the other end, at `contact`, about the connection: 0 all is well, 1 unknown
    there. Raises as `probe.ask`."""
    direction = Vocab("out" if isinstance(link, Inbound) else "in")
    listed = probe.ask(
        contact, [Vocab("list"), direction], secret_=hub.key, secure=link.route.spec.in_tls
    )
    known = [plain_text(name) for name in listed]
    # Somebody may have connected us by our address instead of our name.
    return 0 if hub.name in known or any(":" in name for name in known) else 1
