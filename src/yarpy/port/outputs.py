"""Outputs: the connections out of a port, those it dialled and those that readers opened.

Rules: as for `inputs.py`; every end of a connection comes through `drop`, once.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Final, Protocol

from yarpy import scope
from yarpy.carriers.base import Carrier
from yarpy.errors import PortClosed, YarpError
from yarpy.link.begin.admission import SCRIPT
from yarpy.link.begin.occupancy import SETTING as CONNECTIONS
from yarpy.link.begin.occupancy import connections
from yarpy.link.counter import Past
from yarpy.link.driver import Driver
from yarpy.link.ending import Ending
from yarpy.link.flapping import Flapping
from yarpy.link.receive.budget import Budget
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.port.answer import guard
from yarpy.port.answer.callbacks import Callbacks
from yarpy.port.answer.monitoring import Monitoring
from yarpy.port.connect.saved import SavedQos
from yarpy.port.graph import Membership
from yarpy.port.keep.life import Life
from yarpy.route import Route
from yarpy.threads import Thread

log = logger("yarpy.port")

SILENT: Final = "this port sends nothing by itself, it answers what it is asked"


class Hub(Protocol):
    """The port, as far as its outputs need it."""

    callbacks: Callbacks
    monitoring: Monitoring
    saved_qos: SavedQos
    membership: Membership | None
    life: Life

    @property
    def name(self) -> str: ...

    def changed(self) -> None:
        """Wake whoever waits for connections."""

    def watch(self) -> None:
        """Look after a connection that gives no sign of its end."""

    def output_lost(self, route: Route) -> None:
        """Connect an output again that broke without anybody asking for it."""


class Outputs:
    """The connections out of one port.

    `admitted` and `rpc` are what requests for them are checked against.
    """

    def __init__(
        self, hub: Hub, budget: Budget, lock: threading.RLock, admitted: bool, rpc: bool
    ) -> None:
        self._hub = hub
        self.admitted = admitted
        self.rpc = rpc
        self.links: tuple[Outbound, ...] = ()
        self.past = Past()
        self.unconnected = 0  # messages that were written while nobody was connected
        self.ending = Ending()  # of what waits to write
        self._newest = False  # writers do not wait: the newest message is what counts
        self.budget = budget
        self._lock = lock
        self._crowded = Flapping(hub.name, "others may read from here again")

    # -- coming -----------------------------------------------------------------------------------

    def serve(self, driver: Driver, carrier: Carrier) -> None:
        """Take a connection that a reader opened; serve it in this thread if it says anything."""
        hub, route = self._hub, carrier.route
        route.source, route.target = hub.name, route.source
        if any(map(driver.admission.refusal, guard.to_read(route.spec))):
            driver.transport.close()
            return
        if not self.admitted and route.spec.log is None:
            log.warning("%s: connection %s refused: %s", hub.name, route, SILENT)
            driver.transport.close()
            return
        output = Outbound(driver, carrier, dialled=False)
        try:
            if driver.admission.allows(SCRIPT):
                route.spec = replace(route.spec, scripts=True)
            output.ride(hub.monitoring.outgoing(route))
        except YarpError as error:
            log.warning("%s: connection %s refused: %s", hub.name, route, error)
            driver.transport.close()
            return
        output.join(self.ending, self._newest)
        if hub.membership is not None:
            hub.membership.admit(output)
        with self._lock:
            readers = sum(not link.dialled for link in self.links)
            most = connections()
            if hub.life.closing or readers >= most:
                driver.transport.close()
            else:
                self.links = (*self.links, output)
        hub.changed()
        if output not in self.links:
            if not hub.life.closing:
                text = "%d others read from here, and more are refused (%s sets how many)"
                self._crowded.happened(text, readers, CONNECTIONS)
            return
        if 4 * readers < 3 * most:
            self._crowded.over()
        hub.callbacks.report(output, created=True)
        if hub.membership is not None:
            hub.membership.welcome(output)
        if carrier.delivery.attentive:
            threading.current_thread().name = f"yarpy hear {route}"
            output.attend()

    def add(self, link: Outbound) -> None:
        """Take a connection that we dialled. Raises PortClosed."""
        hub = self._hub
        link.join(self.ending, self._newest)
        hub.saved_qos.give(link)  # before anything is sent
        with self._lock:
            if hub.life.closing:
                link.driver.transport.close()
                raise PortClosed(f'"{hub.name}" was closed meanwhile')
            link.incoming.budget = self.budget
            self.links = (*self.links, link)
            self._elect()
        hub.changed()
        hub.callbacks.report(link, created=True)
        if link.carrier.delivery.connectionless:
            hub.watch()
        if link.carrier.delivery.attentive:
            name = f"yarpy hear {link.route}"
            Thread(target=link.attend, name=name, daemon=True).start()

    @property
    def newest(self) -> bool:
        """True if writers do not wait: the newest message is what counts."""
        return self._newest

    @newest.setter
    def newest(self, newest: bool) -> None:
        self._newest = newest
        for link in self.links:
            link.join(self.ending, newest)

    def count_unconnected(self, value: object) -> None:
        """Count a message that was written while nobody was connected."""
        with self._lock:
            self.unconnected += 1
        membership = self._hub.membership
        if membership is not None:
            membership.unheard(value)

    def _elect(self) -> None:
        """Let a single one of the connections into one multicast group send: as YARP 4 spells
        messages, if all that listen there are of it."""
        group = [link for link in self.links if link.carrier.delivery.broadcast]
        newest = all(link.route.yarp4 for link in group)
        for link in group:
            link.active = link is group[0]
            link.sender.respells = newest and link.carrier.spelling == "binary"

    # -- going ------------------------------------------------------------------------------------

    def drop(self, link: Outbound, reason: str = "", lost: bool = False) -> bool:
        """Forget an output. With `lost`, keep trying to connect it again."""
        hub = self._hub
        with self._lock:
            known = link in self.links
            if known:  # first, so that a signal handler that raises here loses no count
                self.past.add(link.counter)
            while True:
                before = self.links
                left = tuple(item for item in before if item is not link)
                if self.links is before:  # else a signal handler has dropped others meanwhile
                    self.links = left
                    break
            self._elect()
        hub.changed()
        if known:
            link.incoming.leave()
            link.retire()
            if link.chain is not None:
                link.chain.close()
            hub.callbacks.report(link, created=False, reason=reason)
            if hub.membership is not None:
                hub.membership.lost()
            if lost and link.dialled and not hub.life.closing:
                hub.saved_qos.keep(link)
                hub.output_lost(link.route)
        return known

    def end_calls(self, state: str) -> None:
        """Let nobody wait to write any more. Takes no lock: signal handlers may call."""
        self.ending.begin(f'"{self._hub.name}" is {state}')
        for link in self.links:
            link.interrupt()

    def close(self, close: Callable[[Outbound], None]) -> None:
        """Close each in good order, by `close`."""
        links = self.links
        for number, link in enumerate(links):
            # What one reader does not use of its share of the time is for the others.
            with scope.Scope(scope.moment(scope.remaining() / (len(links) - number))):
                close(link)

    def abandon(self) -> None:
        """In a forked process: they are its parent's."""
        self.links = ()
