"""Inputs: the connections into a port, each served in a thread of its own.

Rules: the tuples of links are replaced under `lock`, never changed, so walking them needs no
lock; none is held while user code runs or bytes move. Every end of a connection comes through
`input_ended`, once.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Final, Protocol

from yarpy import scope
from yarpy.callback_thread import waited_by
from yarpy.carriers.base import PAGE, Carrier
from yarpy.data.bottle import Bottle
from yarpy.errors import AccessRefused, NoNameServer, PortClosed, RemoteProtocolError, YarpError
from yarpy.link.begin.admission import Peer
from yarpy.link.counter import Past
from yarpy.link.driver import Driver
from yarpy.link.receive.budget import Budget
from yarpy.link.receive.inbound import Inbound
from yarpy.log import logger
from yarpy.names.client import YarpNameClient
from yarpy.port.answer import crowd, guard, spelling
from yarpy.port.answer.callbacks import Callbacks
from yarpy.port.answer.monitoring import Monitoring
from yarpy.port.answer.name_conflicts import NameConflicts
from yarpy.port.connect import goodbye
from yarpy.port.connect.saved import SavedQos
from yarpy.port.graph import Membership
from yarpy.port.keep.life import Life
from yarpy.port.keep.registration import Registration
from yarpy.port.mailbox import Mailbox
from yarpy.port.outputs import Outputs
from yarpy.qos import NOTHING_ASKED
from yarpy.route import Route
from yarpy.wire.message import Message

log = logger("yarpy.port")

SETTLING: Final = 2.0  # seconds without progress of a connection that another takes the place of
LOOK: Final = 0.05  # seconds between two looks at it
LEAVING: Final = 0.5  # seconds for one whose sender has closed it, which we may not have seen yet


class Hub(Protocol):
    """The port, as far as its inputs need it."""

    registration: Registration
    callbacks: Callbacks
    monitoring: Monitoring
    saved_qos: SavedQos
    membership: Membership | None
    inputs: Inputs
    outputs: Outputs
    life: Life

    @property
    def name(self) -> str: ...

    def answer(self, message: Message) -> Bottle:
        """Answer an administrative message."""

    def obey(self, link: Inbound, message: Message) -> list[str]:
        """Carry out a port command."""

    def changed(self) -> None:
        """Wake whoever waits for connections."""

    def watch(self) -> None:
        """Look after a connection that gives no sign of its end."""

    def input_lost(self, route: Route) -> None:
        """Expect an input again that ended without a goodbye."""

    def input_left(self, route: Route) -> None:
        """Expect an input no more: its sender has said goodbye."""


class Inputs:
    """The connections into one port; `budget` is what their unfinished messages may hold."""

    def __init__(self, hub: Hub, mailbox: Mailbox, budget: Budget) -> None:
        self._hub = hub
        self.mailbox = mailbox
        self.receive: Callable[[Inbound, Message], None] = mailbox.put  # what links call
        self.links: tuple[Inbound, ...] = ()  # one at most from each rooted name
        self.leaving: tuple[Inbound, ...] = ()  # were inputs; their threads have not ended yet
        self._telling: tuple[Inbound, ...] = ()  # have ended; the program is being told
        self.past = Past()
        self.on_change: Callable[[], None] = lambda: None  # the reader looks at them again
        self.budget = budget
        # Of the outputs, too, since closing ends both. A signal handler may close the port above a
        # frame that has it.
        self.lock = threading.RLock()
        self._conflicts = NameConflicts(lambda: hub.name)

    @property
    def name(self) -> str:
        """The port's name."""
        return self._hub.name

    @scope.apart
    def _guess(self, source: str) -> bool:
        """Return whether a port that asks, and does not tell, is of YARP 4."""
        hub = self._hub
        try:
            with hub.life.calls.scope(spelling.TIMEOUT):
                return spelling.is_yarp4(hub.registration.names, source)
        except PortClosed:
            return False

    @property
    def connections(self) -> tuple[Inbound, ...]:
        """The links but those of administrators, who pass by and bring no messages."""
        return tuple(link for link in self.links if link.route.source != "admin")

    # -- coming -----------------------------------------------------------------------------------

    def run(self, driver: Driver, carrier: Carrier) -> None:
        """Serve a connection that we accepted, in this thread, until it ends.

        With a pull carrier it is an output instead: the side that dialled receives.
        """
        if not carrier.push:
            self._hub.outputs.serve(driver, carrier)
            return
        try:
            link = guard.inbound(self, self._hub, driver, carrier)
            link.thread = threading.current_thread()
            self.take(link)
        except (PortClosed, AccessRefused):
            return
        except YarpError as error:
            log.warning("%s: connection %s refused: %s", self.name, carrier.route, error)
            return
        self.serve(link)

    def take(self, link: Inbound) -> None:
        """Make an open connection one of these, to be served next.

        It replaces an earlier one of the same sender, unless its carrier has several side by side,
        and waits until that has ended.
        Raises PortClosed, or what a monitor raises that cannot start; the connection is then
        closed.
        """
        hub = self._hub
        link.receiver.page = hub.callbacks.page
        link.receiver.guess = partial(self._guess, link.route.source)
        link.receiver.incoming.budget = self.budget
        try:
            hub.monitoring.incoming(link)
        except YarpError:
            link.driver.transport.close()
            raise
        source, idle = link.route.source, None
        while True:
            with self.lock:  # of connections that come at once each replaces the one before it
                alone = source.startswith("/") and not link.carrier.delivery.side_by_side
                older, ended = (
                    tuple(item for item in items if alone and item.route.source == source)
                    for items in (self.links, self._telling)
                )
                others = tuple(item for item in self.links if item not in older)
                late = hub.life.closing
                full = ""
                if link.carrier.delivery.connectionless:
                    # Who greeted at the same time may have taken the place that was found then.
                    peer = link.driver.admission.peer
                    full, idle = crowd.room((*others, *self.leaving), peer)
                if not (late or full):
                    self.links = (*others, link)
                    self.leaving = (*self.leaving, *older)
            if late or idle is None:
                break
            self._replace(idle)
        if full:
            self._turn_away(link)
            raise RemoteProtocolError(full)
        if late:
            with contextlib.suppress(NoNameServer):
                goodbye.ask_to_leave(hub.registration, link.route.source)
            self._turn_away(link)
            raise PortClosed(f'"{self.name}" is closed')
        self.mailbox.attend(link)
        hub.changed()
        hub.saved_qos.give(link)
        if any(_lives(old) for old in older):
            self._conflicts.replaced(source)
        for old in older:
            old.replaced = not old.closing
            old.close()
        for old in (*ended, *older):
            if old.thread is not waited_by():
                self._let_end(old)

    def _let_end(self, old: Inbound) -> None:
        """Wait until an earlier connection has ended: what it still brings, and word of its end,
        come before what the new one brings. It has SETTLING after each message, and as long as it
        takes while the program does not read. One that is at work on a question is not waited for:
        nobody waits for the answer any more."""
        came, limit = old.counter.messages, time.monotonic() + SETTLING
        while old.receiver.question is None and not old.served.wait(LOOK):
            if self._hub.life.closing:
                return
            if self.mailbox.behind or old.counter.messages != came:
                came, limit = old.counter.messages, time.monotonic() + SETTLING
            elif time.monotonic() > limit:
                return

    def rival(self, source: str) -> str:
        """Return why another input of that name is not taken, "" if it is: it may be the same
        program, whose connection broke, or which has closed it to make another one."""
        why = self._conflicts.refusal(source) if self._alive(source) else ""
        limit = time.monotonic() + LEAVING
        while why and time.monotonic() < limit:
            alive = self._alive(source)
            if not alive:
                return ""
            alive[0].served.wait(LOOK)
        return why

    def _alive(self, source: str) -> list[Inbound]:
        return [link for link in self.links if link.route.source == source and _lives(link)]

    def find_room(self, peer: Peer) -> str:
        """Return why another input over datagrams finds no place, "" if it does; one that nobody
        needs may have to leave for it."""
        while True:
            why, idle = crowd.room((*self.links, *self.leaving), peer)
            if idle is None:
                return why
            if self._replace(idle):
                return ""

    def _replace(self, idle: Inbound) -> bool:
        """Let one leave that nobody needs; return False if it has left already."""
        if not self._forget(idle):
            return False
        self._hub.callbacks.report(idle, created=False, reason=crowd.REPLACED)
        idle.close()
        return True

    def _turn_away(self, link: Inbound) -> None:
        if link.receiver.close():
            with self.lock:
                self.past.add(link.counter)
        if link.own_chain is not None:
            link.own_chain.close()

    def serve(self, link: Inbound) -> None:
        """Serve one of these, in this thread, until it ends."""
        link.thread = threading.current_thread()
        link.thread.name = f"yarpy {link.route}"
        self.on_change()
        self._hub.callbacks.report(link, created=True)
        if link.carrier.delivery.connectionless:
            self._hub.watch()
        link.serve()
        if link.own_chain is not None:
            link.own_chain.close()
        link.served.set()

    # -- asked by its links -----------------------------------------------------------------------

    def administer(self, link: Inbound, message: Message) -> Bottle:
        """Answer an administrative message."""
        return self._hub.answer(message)

    def command(self, link: Inbound, message: Message) -> list[str]:
        """Carry out a port command; lines for a person to read."""
        lines = self._hub.obey(link, message)
        if (message.key, message.text) == ("*", PAGE):
            names = self._hub.registration.names
            if isinstance(names, YarpNameClient):
                lines.append(f"Name server at http://{names.host}:{names.port}/")
            lines += self._hub.callbacks.lines_for_people()
        return lines

    def reverse(self, link: Inbound) -> None:
        """Make an output of a connection whose other end wants to read."""
        self._forget(link)
        self._hub.outputs.serve(link.driver, link.successor)

    def deadline_missed(self, link: Inbound, lateness: float, silent: bool) -> None:
        """Tell the program that a message is that many seconds late."""
        self._hub.callbacks.deadline(link, lateness, silent)

    def exchange(self, mailbox: Mailbox) -> None:
        """Hand what comes from now on to another mailbox."""
        with self.lock:
            if self._hub.life.over:
                mailbox.why = self.mailbox.why
                mailbox.close() if self.mailbox.closed else mailbox.interrupt()
            self.mailbox, self.receive = mailbox, mailbox.put

    # -- going ------------------------------------------------------------------------------------

    def input_ended(self, link: Inbound, reason: str, quit_: bool) -> None:
        """Forget a link that has ended; in good order if `quit_`."""
        hub = self._hub
        if not self._forget(link, to_tell=True):
            return
        try:
            hub.callbacks.report(link, created=False, reason=reason)
        finally:
            with self.lock:
                self._telling = tuple(item for item in self._telling if item is not link)
        if hub.life.closing:
            return
        if quit_:  # also where one before it was lost, and is still to be asked for
            hub.input_left(link.route)
        elif link.replaced:  # it has broken: its sender has dialled again before we saw that
            hub.saved_qos.keep(link)
            self._inherit(link.route.source)
        elif not link.closing:
            hub.saved_qos.keep(link)
            hub.input_lost(link.route)

    def _inherit(self, source: str) -> None:
        """Give the connection of a sender what was asked for the one before it."""
        for link in self.links:
            if link.route.source == source and link.asked == NOTHING_ASKED and link.wanted is None:
                self._hub.saved_qos.give(link)

    def _forget(self, link: Inbound, to_tell: bool = False) -> bool:
        with self.lock:
            known = link in (*self.links, *self.leaving)
            if known:
                self.past.add(link.counter, link.lost)
                if to_tell:
                    self._telling = (*self._telling, link)
            while True:
                before, leaving = self.links, self.leaving
                left = tuple(item for item in before if item is not link)
                gone = tuple(item for item in leaving if item is not link)
                # Else a signal handler has forgotten others meanwhile.
                if self.links is before and self.leaving is leaving:
                    self.links, self.leaving = left, gone
                    break
        self._hub.changed()
        self.on_change()
        if self._hub.membership is not None:
            self._hub.membership.lost()
        return known

    def interrupt(self) -> None:
        """Let nobody wait to read any more."""
        self.mailbox.why = f'"{self._hub.name}" is interrupted'
        self.mailbox.interrupt()

    def end_reading(self) -> None:
        """Let nobody wait to read, or for an answer, any more."""
        self.mailbox.why = f'"{self._hub.name}" is closed'
        self.mailbox.close()

    def close(self) -> None:
        """End them, with the answers that are on their way, and wait for their threads: also for
        those that tell the program of an end that came just before."""
        goodbye.let_answers_leave(self.links, min(0.3, scope.remaining()))
        for link in self.links:
            link.close()
        for link in (*self.links, *self.leaving, *self._telling):
            if link.thread is not None and link.thread is not waited_by():
                link.thread.join(min(3.0, scope.remaining()))

    def abandon(self) -> None:
        """In a forked process: they are its parent's."""
        self.links = self.leaving = self._telling = ()


def _lives(link: Inbound) -> bool:
    """Return whether an input would show its end, and there is no sign of that. Datagrams do not:
    there, what a sender leaves behind when it dials again looks like another one's. An end may be
    behind what nobody has read yet."""
    silent, transport = link.carrier.delivery.connectionless, link.driver.transport
    return not (silent or link.closing or transport.ended() or transport.hung_up())
