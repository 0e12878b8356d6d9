"""Callbacks: what a program does for its port - it hears of connections, answers, shows pages.

Rules: they run in the threads of connections, without a lock held. What they raise is logged, and
costs one connection at most. What the program wants to be called is kept by its port alone, for
which the program is responsible: connections live in threads, and would keep for ever whatever a
callback knows, the port itself among it.
"""

from __future__ import annotations

import logging
import threading
import weakref
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Final

from yarpy.carriers.web.http.page import Page, Pages
from yarpy.data.bottle import Bottle
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.port.connection import ConnectionEvent
from yarpy.port.deadline import DeadlineEvent, Watch
from yarpy.port.keep.registration import Registration
from yarpy.scope import outside
from yarpy.wire.message import Message

log = logger("yarpy.port")


class Program:
    """The callbacks of a program; None: it leaves that alone."""

    __slots__ = ("__weakref__", "on_admin", "on_connection", "on_deadline", "on_page")

    def __init__(self) -> None:
        self.on_connection: Callable[[ConnectionEvent], object] | None = None
        self.on_deadline: Callable[[DeadlineEvent], None] | None = None
        self.on_admin: Callable[[Message], object] | None = None
        self.on_page: Pages | None = None  # what it shows to browsers


_NOTHING: Final = Program()  # of a port that the program has dropped


class Callbacks:
    """The callbacks of the port that `registration` names."""

    def __init__(self, registration: Registration) -> None:
        self._registration = registration
        self._kept: Program | None = Program()  # until a port takes it
        self._program = weakref.ref(self._kept)
        self._held: dict[int, list[ConnectionEvent]] = {}  # by thread, see `later`
        self.watch: Watch | None = None  # looks for silence, for `on_deadline`
        self.node: Callable[[Bottle], Bottle | None] | None = None  # answers for that of the port
        self.lines_for_people: Callable[[], list[str]] = list  # more of them on the port's page

    @property
    def program(self) -> Program:
        """Return the callbacks of the program; none of them once it has dropped its port."""
        return self._program() or _NOTHING

    def release(self) -> Program:
        """Hand the program's callbacks to its port, which keeps them from now on."""
        kept, self._kept = self.program, None
        return kept

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

    @contextmanager
    def later(self) -> Iterator[None]:
        """Tell the program of connections that come or go in this thread only after the block: what
        it does then may want what the block has."""
        me = threading.get_ident()
        if me in self._held:
            yield
            return
        held = self._held[me] = []
        try:
            yield
        finally:
            del self._held[me]
            for event in held:
                self.connection(event)

    def connection(self, event: ConnectionEvent) -> None:
        """Tell the program that a connection came or went."""
        callback = self.program.on_connection
        if callback is None:
            return
        held = self._held.get(threading.get_ident())
        if held is not None:
            held.append(event)
            return
        try:
            with outside():
                callback(event)
        except FAILURES as error:
            log_failure(log, error, "%s: the connection callback failed", self._registration.name)

    def deadline(self, link: Inbound, lateness: float, silent: bool) -> None:
        """Tell the program that a deadline was missed."""
        callback = self.program.on_deadline
        if callback is None or link.timing is None:
            return
        route, missed = link.route, link.timing.missed
        event = DeadlineEvent(route.source, route.target, route.carrier, lateness, missed, silent)
        try:
            callback(event)
        except FAILURES as error:
            log_failure(log, error, "%s: the deadline callback failed", self._registration.name)

    def close(self) -> None:
        """The port closes."""
        if self.watch is not None:
            self.watch.stop()

    def page(self, path: str, fields: Mapping[str, str]) -> Page | None:
        """Return the page that the program shows at `path`, None if it leaves that to the port."""
        callback = self.program.on_page
        if callback is None:
            return None
        try:
            found = callback(path, fields)
            return Page(found) if isinstance(found, str) else found
        except FAILURES as error:
            log_failure(log, error, "%s: the page %s failed", self._registration.name, path)
            return Page("the program of this port fails on this page\n", "text/plain", 500)
