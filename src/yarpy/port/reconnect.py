"""Repair: connections that failed come back, names that a restarted server forgot are told again.

Rules: one daemon thread for the process, started with the first registered port, asleep most of the
time; it watches, and what it finds broken is dialled in short-lived threads, one for each target,
ever more rarely. What somebody disconnected on purpose stays disconnected; what broke is tried
again until it works or is given up. A lost output is dialled again by us, and so is a camera; any
other lost input is asked for again from its sender, once that is back. A name server is watched
through a connection of its own.
"""

from __future__ import annotations

import random
import socket
import threading
import time
from dataclasses import dataclass, field
from typing import Final

from yarpy.contact import parse_contact
from yarpy.data.value import Vocab
from yarpy.errors import LoginRefused, WrongPort, YarpError
from yarpy.link.handshake import find_carrier
from yarpy.link.outbound import Outbound
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.names.fallback_client import SeveralNames
from yarpy.port import connecting, disconnecting, identity, probe
from yarpy.port.hub import Hub
from yarpy.port.keepalive import Link, Pulse
from yarpy.route import Route

log = logger("yarpy.port")

TICK: Final = 0.1  # seconds between looks at what is broken
CALM: Final = 0.5  # seconds between looks when nothing is
LOCKED: Final = 60.0  # seconds between two logins: cameras lock those out who try too often
LONGEST: Final = 30.0  # seconds between attempts at something that stays away
SLOWER: Final = 1.3  # so much longer is each pause than the one before, and up to so much by chance
ATTEMPTS: Final = 32  # connections that are dialled at the same time
INPUT_PATIENCE: Final = 60.0  # seconds for a sender that vanished to come back


@dataclass(slots=True, eq=False)
class _Lost:
    """A connection that failed."""

    hub: Hub
    route: Route
    incoming: bool
    since: float = field(default_factory=time.monotonic)
    pause: float = TICK
    due: float = 0.0
    under_way: bool = False
    seen_gone: bool = False
    told: str = ""  # what was logged last: each reason is told once, not at every attempt

    def put_off(self, now: float) -> None:
        """Another attempt later; each pause is longer than the one before."""
        self.due = now + self.pause * random.uniform(1.0, SLOWER)
        self.pause = min(self.pause * SLOWER, max(self.pause, LONGEST))

    def tell(self, reason: YarpError, then: str) -> None:
        """Log why it does not come back, and what happens `then`."""
        if str(reason) != self.told:
            self.told = str(reason)
            way = "from" if self.incoming else "to"
            log.warning(
                "%s: no connection %s %s: %s; %s", self.hub.name, way, _peer(self), reason, then
            )


class Repairer:
    """The thread and its lists."""

    def __init__(self) -> None:
        self._lines: dict[int, tuple[YarpNameClient, object]] = {}
        self._begin()

    def _begin(self) -> None:
        self._hubs: list[Hub] = []
        self._lost: list[_Lost] = []
        self._dead_servers: set[int] = set()
        self._pulse = Pulse(self._lose)
        self._thread: threading.Thread | None = None
        self._wake = threading.Event()
        self._lock = threading.Lock()  # ports come and go from any thread

    def start_over(self) -> list[Hub]:
        """Begin anew in a forked process, which has no thread of ours; the ports of before."""
        left = self._hubs
        self._drop_lines()
        self._begin()
        return left

    # -- what ports say ---------------------------------------------------------------------------

    def watch(self, hub: Hub) -> None:
        """Look after a registered port."""
        with self._lock:
            self._hubs.append(hub)
            if self._thread is None or not self._thread.is_alive():
                self._thread = threading.Thread(target=self._run, name="yarpy repair", daemon=True)
                self._thread.start()
        self._wake.set()

    def forget(self, hub: Hub) -> None:
        """The port closes."""
        with self._lock:
            self._hubs = [item for item in self._hubs if item is not hub]
            self._lost = [item for item in self._lost if item.hub is not hub]
        self._wake.set()

    def add(self, hub: Hub, route: Route, incoming: bool) -> None:
        """A connection failed."""
        with self._lock:
            if hub.closing:
                return  # `forget` may have been here already
            self._lost.append(_Lost(hub, route, incoming))
        self._wake.set()

    def give_up(self, hub: Hub, name: str, incoming: bool | None = None) -> bool:
        """Somebody takes the connection to or from `name` in hand, or the one of these that
        `incoming` tells; whether it was being tried again."""

        def meant(item: _Lost) -> bool:
            return item.hub is hub and _peer(item) == name and incoming in (None, item.incoming)

        with self._lock:
            left = [item for item in self._lost if not meant(item)]
            found = len(left) < len(self._lost)
            self._lost = left
        return found

    def pending(self, hub: Hub) -> list[Route]:
        """Outputs that are being tried again."""
        return [item.route for item in self._lost if item.hub is hub and not item.incoming]

    # -- the thread -------------------------------------------------------------------------------

    def _run(self) -> None:
        while True:
            busy = bool(self._lost or self._dead_servers)
            self._wake.wait(TICK if busy else CALM)
            self._wake.clear()
            with self._lock:
                hubs, lost = list(self._hubs), list(self._lost)
                if not hubs:
                    self._drop_lines()
                    self._thread = None
                    return
            try:
                self._look_at_outputs(hubs)
                self._pulse.look(hubs)
                self._look_at_servers(hubs)
                self._attempt(lost)
            except Exception:
                log.exception("the repair of connections failed; it goes on")

    def _look_at_outputs(self, hubs: list[Hub]) -> None:
        for hub in hubs:
            for link in hub.outputs:
                if link.ended():
                    hub.drop_output(link, "the peer hung up", lost=True)

    def _lose(self, hub: Hub, link: Link) -> None:
        """A datagram connection has died without a sign."""
        if isinstance(link, Outbound):
            hub.drop_output(link, "the receiver is gone", lost=True)
            link.close(quit_=False)
            return
        link.close()
        if link.thread is not None:
            link.thread.join(2.0)
        input_lost(hub, link.route)

    def _look_at_servers(self, hubs: list[Hub]) -> None:
        servers = {id(client): client for hub in hubs for client in _servers(hub.names)}
        for number in [number for number in self._lines if number not in servers]:
            _close(self._lines.pop(number)[1])
        for number, client in servers.items():
            line = self._lines.get(number)
            if line is not None and _holds(line[1]):
                continue
            if line is not None:
                del self._lines[number]
                _close(line[1])
                self._dead_servers.add(number)
                log.warning("the name server at %s:%d went away", client.host, client.port)
            try:
                fresh = client.connect()
            except YarpError:
                continue
            self._lines[number] = (client, fresh)
            if number in self._dead_servers:
                self._dead_servers.discard(number)
                self._register_again(client, hubs)

    def _register_again(self, client: YarpNameClient, hubs: list[Hub]) -> None:
        log.warning("the name server at %s:%d is back", client.host, client.port)
        for hub in hubs:
            if hub.closing or client not in _servers(hub.names):
                continue
            try:
                known = client.query(hub.name)
                contact = hub.contact
                if known is None or (known.host, known.port) != (contact.host, hub.port):
                    client.register(
                        hub.name, "tcp", contact.host, hub.port, hub.registration.type or None
                    )
                hub.registration.describe(client)
            except YarpError as error:
                log.warning("%s could not be registered again: %s", hub.name, error)

    def _drop_lines(self) -> None:
        for _, line in self._lines.values():
            _close(line)
        self._lines.clear()
        self._dead_servers.clear()

    # -- one connection ---------------------------------------------------------------------------

    def _attempt(self, lost: list[_Lost]) -> None:
        """Begin what is due, each in a thread of its own: one that hangs delays no other.

        Of those that want the same port, one at a time.
        """
        now = time.monotonic()
        busy = {_peer(item) for item in lost if item.under_way}
        for item in lost:
            if len(busy) >= ATTEMPTS:
                return
            if now < item.due or item.hub.closing or _peer(item) in busy:
                continue
            busy.add(_peer(item))
            item.under_way = True
            threading.Thread(
                target=self._mend, args=(item,), name=f"yarpy dial {_peer(item)}", daemon=True
            ).start()

    def _mend(self, item: _Lost) -> None:
        try:
            self._try_to_mend(item)
        except Exception:
            log.exception("%s: reconnecting %s failed", item.hub.name, item.route)
        finally:
            item.under_way = False

    def _try_to_mend(self, item: _Lost) -> None:
        done = False
        try:
            if item.incoming:
                done = self._mend_input(item)
            else:
                done = self._dial_again(item, item.route.target)
        except LoginRefused as error:
            item.pause = LOCKED
            item.tell(error, f"it is asked again every {LOCKED:g} s")
        except WrongPort as error:
            item.tell(error, "it is dialled again now and then, until the right one answers")
        except (YarpError, OSError):
            pass  # not yet
        now = time.monotonic()
        if item.incoming and not _is_pulled(item.route) and now - item.since > INPUT_PATIENCE:
            done = True
        if done:
            with self._lock:
                self._lost = [other for other in self._lost if other is not item]
        else:
            item.put_off(now)

    def _mend_input(self, item: _Lost) -> bool:
        """Ask the sender, once it lives again, to send to us as before."""
        hub, route = item.hub, item.route
        if _is_there(item):
            return True
        if _is_pulled(route):
            return self._dial_again(item, route.source)
        contact = hub.names.query(route.source) if hub.names is not None else None
        if contact is None or not probe.is_alive(contact, hub.key):
            item.seen_gone = True
            return False
        if not item.seen_gone and time.monotonic() - item.since < CALM:
            return False  # it is still there: give it the time to dial us by itself
        listed = probe.ask(contact, [Vocab("list"), Vocab("out")], secret_=hub.key)
        if hub.name in listed:
            return True
        if route.spec.log is not None:
            return True
        probe.ask(contact, [Vocab("add"), f"{route.spec.whole}:/{hub.name}"], secret_=hub.key)
        return True

    def _dial_again(self, item: _Lost, peer: str) -> bool:
        """Dial a receiver, or a camera that we fetch from, once more; not if somebody else does."""
        hub, route = item.hub, item.route
        with hub.dialling.alone(peer, wait=False) as alone:
            if not alone:
                return False
            if item not in self._lost or _is_there(item):
                return True
            contact = hub.registration.locate(parse_contact(peer))
            if contact is None:
                return False
            connecting.open_output(hub, contact, peer, route.spec, route)
            if item in self._lost:
                way = "from" if item.incoming else "to"
                log.info("%s: the connection %s %s is back", hub.name, way, peer)
            elif item.incoming:  # somebody disconnected it meanwhile
                disconnecting.disconnect_input(hub, peer)
            else:
                disconnecting.disconnect_output(hub, peer)
        return True


def _peer(item: _Lost) -> str:
    return item.route.source if item.incoming else item.route.target


def _is_there(item: _Lost) -> bool:
    """Whether there is such a connection already."""
    hub, route = item.hub, item.route
    if item.incoming:
        return any(link.route.source == route.source for link in hub.inputs)
    return any(link.route.target == route.target for link in hub.outputs)


def _is_pulled(route: Route) -> bool:
    """Whether the receiver of such a connection is the one that dials."""
    return not find_carrier(route.spec.base).push


def _servers(names: NameClient | None) -> list[YarpNameClient]:
    if isinstance(names, SeveralNames):
        return [client for each in names.clients for client in _servers(each)]
    return [names] if isinstance(names, YarpNameClient) else []


def _holds(line: object) -> bool:
    """Whether an idle connection is still open."""
    assert isinstance(line, socket.socket)
    try:
        line.setblocking(False)
        return bool(line.recv(1, socket.MSG_PEEK))
    except BlockingIOError:
        return True
    except OSError:
        return False


def _close(line: object) -> None:
    assert isinstance(line, socket.socket)
    line.close()


REPAIR: Final = Repairer()
watch = REPAIR.watch
forget = REPAIR.forget
give_up = REPAIR.give_up
pending = REPAIR.pending


def output_lost(hub: Hub, route: Route) -> None:
    """An output broke without anybody asking for it."""
    if route.spec.log is not None:
        return
    if not identity.has_proof(route):
        _leave(hub, "to", route.target)
        return
    REPAIR.add(hub, route, incoming=False)


def input_lost(hub: Hub, route: Route) -> None:
    """An input ended without a goodbye."""
    if _is_pulled(route) and not identity.has_proof(route):
        _leave(hub, "from", route.source)
    elif _is_pulled(route) or (route.source.startswith("/") and not _is_address(route.source)):
        REPAIR.add(hub, route, incoming=True)


def _leave(hub: Hub, way: str, peer: str) -> None:
    log.warning(
        "%s: the connection %s %s broke and is not dialled again by itself: what listened there "
        "did not say its name, so nobody could tell whether it is the same again",
        hub.name,
        way,
        peer,
    )


def _is_address(name: str) -> bool:
    """Whether a route's name is really an address, which nobody can be asked at."""
    try:
        return parse_contact(name).reachable
    except YarpError:
        return True
