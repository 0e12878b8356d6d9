"""Reconnecting: connections that failed come back.

Rules: one daemon thread for the process, started with the first registered port, asleep most of the
time. It only watches and decides: whatever may hang (dialling a lost connection, a question whether
the other end of a datagram connection still lives, a name server) is done in short-lived threads,
one for each target and a limited number of them. What somebody disconnected on purpose stays
disconnected; what broke is tried again, ever more rarely, until it works or is given up. A lost
output is dialled again by us, and so is a camera; any other lost input is asked for again from its
sender, once that is back.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from contextlib import closing
from functools import partial
from typing import Final

from yarpy.contact import Contact, parse_contact
from yarpy.data.value import Vocab
from yarpy.errors import AccessRefused, RemoteProtocolError, WrongPort, YarpError
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.port.answer.ping import Pings
from yarpy.port.connect import connecting, disconnecting, identity, probe
from yarpy.port.connect.choosing import MEMORY, choose
from yarpy.port.connect.dialling import Attempts
from yarpy.port.connect.lost import TICK, Lost, is_pulled
from yarpy.port.hub import Hub
from yarpy.port.keep.keepalive import Keepalive, Link
from yarpy.port.keep.server_watch import ServerWatch
from yarpy.route import Route
from yarpy.scope import Waiter
from yarpy.threads import Thread

log = logger("yarpy.port")

CALM: Final = 0.5  # seconds between looks when nothing is
LOCKED: Final = 60.0  # seconds between two logins: cameras lock those out who try too often
INPUT_TIMEOUT: Final = 60.0  # seconds for a sender that vanished to come back
GOODBYE: Final = 1.0  # seconds between a goodbye and the end that it was for
MOST_SENDERS: Final = 200  # of one port that are waited for


class Reconnector:
    """The thread and its lists."""

    def __init__(self) -> None:
        self._begin()

    def _begin(self) -> None:
        self._hubs: list[Hub] = []
        self._lost: list[Lost] = []
        self._attempts = Attempts("dial")
        self._reports = Attempts("end outputs of")
        self._keepalive = Keepalive(self._died)
        self._pings = Pings()
        self._servers = ServerWatch()
        self._thread: threading.Thread | None = None
        self._wake = Waiter()  # of the thread; a signal handler may raise in who wakes it
        self._over: list[tuple[Hub, str, float]] = []  # goodbyes for inputs that had ended
        # Ports come and go from any thread, and from signal handlers over frames that hold it.
        self._lock = threading.RLock()

    def start_over(self) -> list[Hub]:
        """Begin anew in a forked process, which has no thread of ours; the ports of before."""
        left = self._hubs
        self._servers.forget()
        self._keepalive.forget()
        self._begin()
        return left

    # -- what ports say ---------------------------------------------------------------------------

    def wake(self) -> None:
        """Look soon at a connection that gives no sign of its end."""
        self._wake.wake()

    def watch(self, hub: Hub) -> None:
        """Look after a registered port."""
        with self._lock:
            self._hubs = [*self._hubs, hub]
            if self._thread is None or not self._thread.is_alive():
                self._thread = Thread(target=self._run, name="yarpy reconnect", daemon=True)
                self._thread.start()

    def forget(self, hub: Hub) -> None:
        """The port closes."""
        with self._lock:
            while True:
                before = self._hubs
                left = [item for item in before if item is not hub and not item.life.closing]
                if self._hubs is before:  # else a signal handler has closed another meanwhile
                    self._hubs = left
                    break
            self._keep(lambda item: item.hub is not hub)
            last = not self._hubs
        if last:
            self._wake.wake()

    def _keep(self, stays: Callable[[Lost], bool]) -> bool:
        """Forget what does not stay, and what a signal handler forgets meanwhile; return whether
        there was any."""
        while True:
            before = self._lost
            left = [item for item in before if stays(item)]
            if self._lost is before:
                self._lost = left
                return len(left) < len(before)

    def add(self, hub: Hub, route: Route, incoming: bool, gone: bool = False) -> None:
        """A connection failed; `gone`: the other end's program has ended, or lost it."""
        with self._lock:
            if hub.life.closing:
                return  # `forget` may have been here already
            if incoming and self._is_over(hub, route.source):
                return
            added = Lost(hub, route, incoming, seen_gone=gone)
            if incoming and not is_pulled(route):
                self._make_room(added)
            self._lost = [*self._lost, added]
        self._wake.wake()

    def _make_room(self, added: Lost) -> None:
        """Forget the same input from before, and the oldest where there are too many: whoever
        connects under new names again and again must not keep us busy."""
        inputs = [
            item
            for item in self._lost
            if item.incoming and item.hub is added.hub and not is_pulled(item.route)
        ]
        over = {item for item in inputs if item.peer == added.peer}
        if not over and len(inputs) >= MOST_SENDERS:
            over = {inputs[0]}
        self._keep(lambda item: item not in over)

    def give_up(
        self, hub: Hub, name: str, incoming: bool | None = None, before: float = math.inf
    ) -> bool:
        """Somebody takes the connection to or from `name` in hand, or the one of these that
        `incoming` tells, if it was lost `before` that time (of time.perf_counter); whether it was
        being tried again."""

        def meant(item: Lost) -> bool:
            this = item.hub is hub and item.peer == name and item.since < before
            return this and incoming in (None, item.incoming)

        with self._lock:
            return self._keep(lambda item: not meant(item))

    def over(self, hub: Hub, source: str) -> None:
        """A sender has said goodbye for an input that has just ended: its thread may be about to
        tell us that it was lost."""
        with self._lock:
            self._over = [*self._over[-MOST_SENDERS:], (hub, source, time.monotonic())]

    def _is_over(self, hub: Hub, source: str) -> bool:
        since = time.monotonic() - GOODBYE
        self._over = [item for item in self._over if item[2] > since]
        return any(item[0] is hub and item[1] == source for item in self._over)

    def pending(self, hub: Hub) -> list[Route]:
        """Outputs that are being tried again."""
        return [item.route for item in self._lost if item.hub is hub and not item.incoming]

    # -- the thread -------------------------------------------------------------------------------

    def _run(self) -> None:
        server_away = False
        while True:
            busy = self._lost or server_away or self._keepalive.watching
            self._wake.wait(TICK if busy else CALM)
            with self._lock:
                hubs, lost = list(self._hubs), list(self._lost)
                if not hubs:
                    self._servers.forget()
                    self._keepalive.forget()
                    self._thread = None
                    return
            try:
                self._look_at_outputs(hubs)
                self._keepalive.look(hubs)
                self._pings.look(hubs)
                server_away = self._servers.look(hubs)
                self._dial(lost)
            except Exception:
                log.exception("the watch over connections failed; it goes on")

    def _look_at_outputs(self, hubs: list[Hub]) -> None:
        for hub in hubs:
            ended = [link for link in hub.outputs.links if link.watch()]
            if ended:  # a callback of the program hears of it, and may take its time
                self._reports.begin(hub.name, partial(self._drop, hub, ended))

    def _drop(self, hub: Hub, ended: list[Outbound]) -> None:
        for link in ended:
            hub.outputs.drop(link, link.reason, lost=True)

    def _died(self, hub: Hub, link: Link) -> None:
        """A datagram connection has died without a sign."""
        if isinstance(link, Outbound):
            hub.outputs.drop(link, "the receiver is gone", lost=True)
            link.close(quit_=False)
            return
        foreseen = link.closing  # its sender has left because we have asked for that
        link.close()
        if link.thread is not None:
            link.thread.join(2.0)
        if not foreseen:
            input_lost(hub, link.route, gone=True)

    # -- one connection ---------------------------------------------------------------------------

    def _dial(self, lost: list[Lost]) -> None:
        """Begin what is due; of those that want the same port, one at a time."""
        now = time.perf_counter()
        for item in lost:
            if item.due <= now and not item.hub.life.closing:
                self._attempts.begin(item.peer, partial(self._attempt, item))

    def _attempt(self, item: Lost) -> None:
        """Try once to have it back."""
        done = False
        try:
            if item.incoming:
                done = self._ask_sender(item)
            else:
                done = self._dial_again(item, item.route.target)
        except AccessRefused as error:
            item.pause = LOCKED
            item.tell(error, f"it is asked again every {LOCKED:g} s")
        except WrongPort as error:
            item.tell(error, "it is dialled again now and then, until the right one answers")
        except RemoteProtocolError as error:  # it says why not
            item.tell(error, "it is dialled again now and then, ever more rarely")
        except (YarpError, OSError):
            pass  # not yet
        finally:
            now = time.perf_counter()
            waited = now - item.since > INPUT_TIMEOUT
            if done or (waited and item.incoming and not is_pulled(item.route)):
                with self._lock:
                    self._keep(lambda other: other is not item)
            else:
                item.put_off(now)

    def _ask_sender(self, item: Lost) -> bool:
        """Ask the sender, once it lives again, to send to us as before. It is given the time to
        dial us by itself: of two connections one ends, with what is on its way."""
        hub, route = item.hub, item.route
        if item.is_there():
            return True
        if is_pulled(route):
            return self._dial_again(item, route.source)
        contact = hub.names.query(route.source) if hub.names is not None else None
        visit = None if contact is None else _visit(contact, hub.key)
        if visit is None:
            item.seen_gone, item.back = True, None
            return False
        with closing(visit):
            if not item.is_calm(time.perf_counter()):
                return False
            if hub.name in visit.ask([Vocab("list"), Vocab("out")]) or route.spec.log is not None:
                return True
            # What a sender has chosen by itself, it chooses again.
            way = "" if route.spec.base == MEMORY else f"{route.spec.whole}:/"
            if not item.is_there():  # it may have dialled us while it answered
                visit.ask([Vocab("add"), way + hub.name])
        return True

    def _dial_again(self, item: Lost, peer: str) -> bool:
        """Dial a receiver, or a camera that we fetch from, once more; not if somebody else does."""
        hub, route = item.hub, item.route
        if not identity.has_proof(route):  # it broke while its listener was being asked
            return _is_left(hub, route, item.incoming)
        with hub.callbacks.later(), hub.dialling.alone(peer, wait=False) as alone:
            if not alone:
                return False
            if item not in self._lost or item.is_there():
                return True
            contact = hub.registration.locate(parse_contact(peer))
            if contact is None:
                return False
            item.timeout, timeout = min(2 * item.timeout, identity.TIMEOUT), item.timeout
            spec = route.spec
            if spec.chosen:  # what was best need not be so with what is there now
                spec = choose(contact, hub.service(), spec.own)
            connecting.open_output(hub, contact, peer, spec, route, timeout)
            if item in self._lost:
                way = "from" if item.incoming else "to"
                log.info("%s: the connection %s %s is back", hub.name, way, peer)
            elif item.incoming:  # somebody disconnected it meanwhile
                disconnecting.disconnect_input(hub, peer)
            else:
                disconnecting.disconnect_output(hub, peer)
        return True


def _visit(contact: Contact, key: bytes) -> probe.AdminConnection | None:
    """Return a connection to the port of that name; None if it does not answer there."""
    try:
        visit = probe.AdminConnection(contact, secret_=key)
    except (YarpError, OSError):
        return None
    try:
        if visit.name() == contact.name:
            return visit
    except (YarpError, OSError):
        pass
    visit.close()
    return None


RECONNECTOR: Final = Reconnector()
watch = RECONNECTOR.watch
wake = RECONNECTOR.wake
forget = RECONNECTOR.forget
give_up = RECONNECTOR.give_up
over = RECONNECTOR.over
pending = RECONNECTOR.pending


def output_lost(hub: Hub, route: Route) -> None:
    """An output broke without anybody asking for it."""
    if route.spec.log is not None:
        return
    if not _is_left(hub, route, incoming=False):
        RECONNECTOR.add(hub, route, incoming=False)


def input_lost(hub: Hub, route: Route, gone: bool = False) -> None:
    """An input ended without a goodbye; `gone`: its sender knows nothing of it any more."""
    if is_pulled(route) and route.declared.topic:
        return  # its node dials publishers again
    if is_pulled(route):
        if not _is_left(hub, route, incoming=True):
            RECONNECTOR.add(hub, route, incoming=True, gone=gone)
    elif route.source.startswith("/") and not _is_address(route.source):
        RECONNECTOR.add(hub, route, incoming=True, gone=gone)


def _is_left(hub: Hub, route: Route, incoming: bool) -> bool:
    """Return whether a connection that broke is not dialled again, which its log tells then: nobody
    could tell whether the same port answers. One that is being asked for its name may still say."""
    if route.asked or identity.has_proof(route):
        return False
    log.warning(
        "%s: the connection %s %s broke and is not dialled again by itself: what listened there "
        "did not say its name, so nobody could tell whether it is the same again",
        *(hub.name, *(("from", route.source) if incoming else ("to", route.target))),
    )
    return True


def _is_address(name: str) -> bool:
    """Return whether a route's name is really an address, which nobody can be asked at."""
    try:
        return parse_contact(name).reachable
    except YarpError:
        return True
