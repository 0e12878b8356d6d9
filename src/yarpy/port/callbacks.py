"""Callbacks: what a program does for its port - it hears of connections, answers, shows pages.

Rules: they run in the threads of connections, without a lock held. What they raise is logged, and
costs one connection at most.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping

from yarpy.carriers.http.page import Page, Pages
from yarpy.data.bottle import Bottle
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.log import logger
from yarpy.port.connection import ConnectionEvent
from yarpy.port.deadline import DeadlineEvent, Watch
from yarpy.port.registration import Registration
from yarpy.wire.message import Message

log = logger("yarpy.port")


class Callbacks:
    """The callbacks of the port that `registration` names; None: the program leaves that alone."""

    def __init__(self, registration: Registration) -> None:
        self._registration = registration
        self.on_connection: Callable[[ConnectionEvent], None] | None = None
        self.on_deadline: Callable[[DeadlineEvent], None] | None = None
        self.watch: Watch | None = None  # looks for silence, for `on_deadline`
        self.on_admin: Callable[[Message], object] | None = None
        self.slave: Callable[[Bottle], Bottle | None] | None = None  # answers as a node of ROS
        self.on_page: Pages | None = None  # what the program shows to browsers
        self.lines_for_people: Callable[[], list[str]] = list  # more of them on the port's page

    def report(self, link: Inbound | Outbound, created: bool, reason: str = "") -> None:
        """Log that a connection came or went, and tell the program."""
        route = link.route
        incoming = isinstance(link, Inbound)
        event = ConnectionEvent(
            incoming, created, route.source, route.target, route.carrier, reason
        )
        named = (route.source if incoming else route.target).startswith("/")
        log.log(logging.INFO if named else logging.DEBUG, "%s", event)
        if named:
            self.connection(event)

    def connection(self, event: ConnectionEvent) -> None:
        """Tell the program that a connection came or went."""
        if self.on_connection is None:
            return
        try:
            self.on_connection(event)
        except Exception:
            log.exception("%s: the connection callback failed", self._registration.name)

    def deadline(self, link: Inbound, lateness: float, silent: bool) -> None:
        """Tell the program that a deadline was missed."""
        if self.on_deadline is None or link.timing is None:
            return
        route, missed = link.route, link.timing.missed
        event = DeadlineEvent(route.source, route.target, route.carrier, lateness, missed, silent)
        try:
            self.on_deadline(event)
        except Exception:
            log.exception("%s: the deadline callback failed", self._registration.name)

    def close(self) -> None:
        """The port closes."""
        if self.watch is not None:
            self.watch.stop()

    def page(self, path: str, fields: Mapping[str, str]) -> Page | None:
        """What the program shows at `path`, None if it leaves that to the port."""
        if self.on_page is None:
            return None
        try:
            found = self.on_page(path, fields)
            return Page(found) if isinstance(found, str) else found
        except Exception:
            log.exception("%s: the page %s failed", self._registration.name, path)
            return Page("the program of this port fails on this page\n", "text/plain", 500)
