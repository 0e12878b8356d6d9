"""Hub: a port without its reader - a name, a listening socket, and the links in and out.

Rules: the tuples of links are replaced under `lock`, never changed, so walking them needs no
lock; no lock is held while user code runs or bytes move. Every end of a connection comes through
`input_ended` or `drop_output`, once. What acts on hubs (commands, administration, reconnecting)
imports this file and is handed in, as `Crew`: a hub knows none of them. `assembly` puts them
together.
"""

from __future__ import annotations

import contextlib
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Protocol

from yarpy.carriers.base import PAGE, Carrier
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle, Property
from yarpy.errors import AccessRefused, NoNameServer, PortClosed, RemoteProtocolError, YarpError
from yarpy.link.budget import port_budget
from yarpy.link.counter import Past
from yarpy.link.driver import Driver
from yarpy.link.episode import Episode
from yarpy.link.inbound import Inbound
from yarpy.link.occupancy import SETTING as CONNECTIONS
from yarpy.link.occupancy import connections
from yarpy.link.outbound import Outbound
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.port import farewell, guard
from yarpy.port.callbacks import Callbacks
from yarpy.port.dialling import Dialling
from yarpy.port.kept import Kept
from yarpy.port.mailbox import Mailbox
from yarpy.port.monitoring import Monitoring
from yarpy.port.part import Seat
from yarpy.port.preparing import Preparing
from yarpy.port.reception import Reception
from yarpy.port.registration import Registration
from yarpy.route import Route
from yarpy.transports.bind import reach
from yarpy.wire.message import Message
from yarpy.wire.stream import DEFAULT_LIMIT

log = logger("yarpy.port")

# Most inputs over datagrams of a port, a quarter of them from one other computer: each costs us a
# thread and a socket, but costs its sender nothing, since no connection is left that would end with
# the sender's program.
MAX_DATAGRAM_INPUTS: Final = 256
SETTLING: Final = 2.0  # seconds for a connection to end that another takes the place of
SILENT: Final = "this port sends nothing by itself, it answers what it is asked"


class Reconnect(Protocol):
    """Who brings back the connections that broke."""

    def watch(self, hub: Hub, /) -> None:
        """Look after a port."""

    def forget(self, hub: Hub, /) -> None:
        """The port closes."""

    def output_lost(self, hub: Hub, route: Route, /) -> None:
        """An output broke without anybody asking for it."""

    def input_lost(self, hub: Hub, route: Route, /) -> None:
        """An input ended without a goodbye."""

    def wake(self) -> None:
        """There is a connection that gives no sign of its end."""

    def give_up(
        self, hub: Hub, name: str, incoming: bool | None = None, before: float = math.inf
    ) -> bool:
        """Somebody takes the connection to or from `name` in hand; whether it was tried again."""


@dataclass(frozen=True, slots=True)
class Crew:
    """Who acts on hubs."""

    administer: Callable[[Hub, Message], Bottle]  # answers an administrative message
    obey: Callable[[Hub, Inbound, Message], list[str]]  # carries out a port command
    close_output: Callable[[Hub, Outbound], None]
    reconnect: Reconnect


class Hub:
    """A port's connections.

    `admits_outputs` and `rpc` are what requests for outputs are checked against. `limit` is the
    largest message in bytes, `input_limit` what unfinished ones may hold together (None: as the
    environment says). `directory`: it is a name server's.
    """

    def __init__(
        self,
        registration: Registration,
        mailbox: Mailbox,
        crew: Crew,
        *,
        admits_outputs: bool = True,
        rpc: bool = False,
        limit: int = DEFAULT_LIMIT,
        input_limit: int | None = None,
        directory: bool = False,
    ) -> None:
        self.registration = registration
        self.mailbox = mailbox
        self.receive: Callable[[Inbound, Message], None] = mailbox.put  # what links call
        self.crew = crew
        self.admits_outputs = admits_outputs
        self.rpc = rpc
        self.limit = limit
        self.budget = port_budget(input_limit)
        self.callbacks = Callbacks(registration)
        self.properties = Property()
        self.property_sizes: dict[str, int] = {}  # bytes of each
        self.inputs: tuple[Inbound, ...] = ()  # one at most from each rooted name
        self.leaving: tuple[Inbound, ...] = ()  # were inputs; their threads have not ended yet
        self.outputs: tuple[Outbound, ...] = ()
        self.past = {"inputs": Past(), "outputs": Past()}
        self.unconnected = 0  # messages that were written while nobody was connected
        self.closing = False
        self.inherited = False  # from the process that this one was forked from
        self.interrupted = False
        self.on_inputs: Callable[[], None] = lambda: None  # the reader looks at them again
        self.lock = threading.Lock()  # replaces the tuples of links
        self._crowded = Episode(self.name, "others may read from here again")
        self.dialling = Dialling()
        self.kept = Kept()
        self.seat: Seat | None = None  # in the graph of a node
        self.monitoring = Monitoring(self)
        self.preparing = Preparing()
        silence = "" if admits_outputs else SILENT
        self.reception = Reception(registration, limit, self.run_input, directory, silence)

    # -- what it is -------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The name, complete once the port is open."""
        return self.registration.name

    @property
    def contact(self) -> Contact:
        """Where the port listens."""
        return self.registration.contact

    @property
    def port(self) -> int:
        """The number of the listening socket."""
        return self.registration.port

    @property
    def key(self) -> bytes:
        """The secret of auth.conf, b"" without one."""
        return self.registration.key

    @property
    def names(self) -> NameClient | None:
        """The name service we are registered with."""
        return self.registration.names

    def service(self) -> NameClient | None:
        """The name service to look others up with, None if there is none."""
        return self.registration.service()

    # -- opening ----------------------------------------------------------------------------------

    def open(self, port: int, host: str) -> None:
        """Listen on `port` (0: any free one) and register. Raises AddressError, NoNameServer."""
        try:
            self.registration.open(port, host, self.reception.listen)
            self.reception.open()
            self.registration.tell()
        except BaseException:
            self.closing = True
            self.reception.close()
            self.registration.forget()
            raise
        self.crew.reconnect.watch(self)
        where = f"tcp://{self.contact.address}/"
        log.info("Port %s active at %s, open to %s", self.name, where, reach())

    # -- connections in ---------------------------------------------------------------------------

    def run_input(self, driver: Driver, carrier: Carrier) -> None:
        """Serve a connection that we accepted as an input, in this thread, until it ends.

        With a pull carrier it is an output instead: the side that dialled receives.
        """
        if not carrier.push:
            self._serve_reader(driver, carrier)
            return
        try:
            link = guard.inbound(self, driver, carrier)
            link.thread = threading.current_thread()
            self.take_input(link)
        except (PortClosed, AccessRefused):
            return
        except YarpError as error:
            log.warning("%s: connection %s refused: %s", self.name, carrier.route, error)
            return
        self.serve_input(link)

    def take_input(self, link: Inbound) -> None:
        """Make an open connection one of our inputs, to be served next.

        It replaces an earlier one of the same sender, and waits SETTLING until that has ended,
        unless that is at work on a question: nobody waits for the answer any more.
        Raises PortClosed, or what a monitor raises that cannot start; the connection is then
        closed.
        """
        link.receiver.page = self.callbacks.page
        link.receiver.intake.budget = self.budget
        try:
            self.monitoring.incoming(link)
        except YarpError:
            link.driver.transport.close()
            raise
        source = link.route.source
        with self.lock:  # of connections that come at once each replaces the one before it
            rooted = source.startswith("/")
            older = tuple(item for item in self.inputs if rooted and item.route.source == source)
            others = tuple(item for item in self.inputs if item not in older)
            late = self.closing
            full = link.carrier.connectionless and self._has_datagrams(link, others)
            if not (late or full):
                self.inputs = (*others, link)
                self.leaving = (*self.leaving, *older)
        if full:
            self._turn_away(link)
            raise RemoteProtocolError(
                "there are too many inputs over datagrams already, of "
                f"{MAX_DATAGRAM_INPUTS} and a quarter of them from one computer; use tcp"
            )
        if late:
            with contextlib.suppress(NoNameServer):
                farewell.ask_to_leave(self.registration, link.route.source)
            self._turn_away(link)
            raise PortClosed(f'"{self.name}" is closed')
        self.kept.give(link)
        for old in older:
            old.close()
            stuck = old.receiver.question is not None
            if old.thread is not threading.current_thread() and not stuck:
                old.served.wait(
                    SETTLING
                )  # what it still brings comes before what the new one brings

    def _has_datagrams(self, link: Inbound, others: tuple[Inbound, ...]) -> bool:
        """Whether there are as many inputs over datagrams as there may be."""
        found = [
            item.driver.admission.peer
            for item in (*others, *self.leaving)
            if item.carrier.connectionless
        ]
        peer = link.driver.admission.peer
        share = MAX_DATAGRAM_INPUTS // (1 if peer.here else 4)
        return len(found) >= MAX_DATAGRAM_INPUTS or (
            sum(one.address == peer.address for one in found) >= share
        )

    def _turn_away(self, link: Inbound) -> None:
        link.driver.transport.close()
        if link.own_chain is not None:
            link.own_chain.close()

    def serve_input(self, link: Inbound) -> None:
        """Serve an input, in this thread, until it ends."""
        link.thread = threading.current_thread()
        link.thread.name = f"yarpy {link.route}"
        self.on_inputs()
        self.callbacks.report(link, created=True)
        if link.carrier.connectionless:
            self.crew.reconnect.wake()
        link.serve()
        if link.own_chain is not None:
            link.own_chain.close()
        link.served.set()

    def administer(self, link: Inbound, message: Message) -> Bottle:
        return self.crew.administer(self, message)

    def command(self, link: Inbound, message: Message) -> list[str]:
        lines = self.crew.obey(self, link, message)
        if (message.key, message.text) == ("*", PAGE):
            lines += self._whereabouts() + self.callbacks.lines_for_people()
        return lines

    def _whereabouts(self) -> list[str]:
        """Where the other ports are to be found, if somebody knows."""
        names = self.names
        if isinstance(names, YarpNameClient):
            return [f"Name server at http://{names.host}:{names.port}/"]
        return []

    def reverse(self, link: Inbound) -> None:
        """The peer at the other end wants to read: its connection becomes an output of ours."""
        self._forget_input(link)
        self._serve_reader(link.driver, link.successor)

    def _serve_reader(self, driver: Driver, carrier: Carrier) -> None:
        """Make a connection that somebody else opened an output of ours."""
        route = carrier.route
        route.source, route.target = self.name, route.source
        if any(map(driver.admission.refusal, guard.to_read(route.spec))):
            driver.transport.close()
            return
        if not self.admits_outputs and route.spec.log is None:
            log.warning("%s: connection %s refused: %s", self.name, route, SILENT)
            driver.transport.close()
            return
        output = Outbound(driver, carrier, dialled=False)
        try:
            output.ride(self.monitoring.outgoing(route))
        except YarpError as error:
            log.warning("%s: connection %s refused: %s", self.name, route, error)
            driver.transport.close()
            return
        with self.lock:
            readers = sum(not link.dialled for link in self.outputs)
            most = connections()
            if self.closing or readers >= most:
                driver.transport.close()
            else:
                self.outputs = (*self.outputs, output)
        if output not in self.outputs:
            if not self.closing:
                text = "%d others read from here, and more are refused (%s sets how many)"
                self._crowded.happened(text, readers, CONNECTIONS)
            return
        if 4 * readers < 3 * most:
            self._crowded.over()
        self.callbacks.report(output, created=True)
        if self.seat is not None:
            self.seat.welcome(output)
        if carrier.attentive:
            threading.current_thread().name = f"yarpy hear {route}"
            output.attend()

    def input_ended(self, link: Inbound, reason: str, quit_: bool) -> None:
        if not self._forget_input(link):
            return
        self.callbacks.report(link, created=False, reason=reason)
        if not (quit_ or link.closing or self.closing):
            self.kept.keep(link)
            self.crew.reconnect.input_lost(self, link.route)

    def deadline_missed(self, link: Inbound, lateness: float, silent: bool) -> None:
        self.callbacks.deadline(link, lateness, silent)

    def _forget_input(self, link: Inbound) -> bool:
        with self.lock:
            known = link in (*self.inputs, *self.leaving)
            self.inputs = tuple(item for item in self.inputs if item is not link)
            self.leaving = tuple(item for item in self.leaving if item is not link)
        if known:
            self.past["inputs"].add(link.counter, link.lost)
        self.on_inputs()
        if self.seat is not None:
            self.seat.lost()
        return known

    # -- connections out --------------------------------------------------------------------------

    def add_output_link(self, link: Outbound) -> None:
        """Take a greeted connection as an output; one to the same port is replaced by it."""
        self.kept.give(link)  # before anything is sent
        with self.lock:
            if self.closing:
                link.driver.transport.close()
                raise PortClosed(f'"{self.name}" was closed meanwhile')
            link.intake.budget = self.budget
            self.outputs = (*self.outputs, link)
            self._elect()
        self.callbacks.report(link, created=True)
        if link.carrier.connectionless:
            self.crew.reconnect.wake()
        if link.carrier.attentive:
            name = f"yarpy hear {link.route}"
            threading.Thread(target=link.attend, name=name, daemon=True).start()

    def drop_output(self, link: Outbound, reason: str = "", lost: bool = False) -> bool:
        """Forget an output. With `lost`, keep trying to connect it again."""
        with self.lock:
            known = link in self.outputs
            self.outputs = tuple(item for item in self.outputs if item is not link)
            self._elect()
        if known:
            self.past["outputs"].add(link.counter)
            link.intake.leave()
            link.retire()
            if link.chain is not None:
                link.chain.close()
            self.callbacks.report(link, created=False, reason=reason)
            if self.seat is not None:
                self.seat.lost()
            if lost and link.dialled and not self.closing:
                self.kept.keep(link)
                self.crew.reconnect.output_lost(self, link.route)
        return known

    def count_unconnected(self) -> None:
        """A message was written, and nobody is connected."""
        with self.lock:
            self.unconnected += 1

    def _elect(self) -> None:
        """Of the connections into one multicast group a single one sends."""
        elected = False
        for link in self.outputs:
            if link.carrier.broadcast:
                link.active = not elected
                elected = True

    # -- ending -----------------------------------------------------------------------------------

    def exchange(self, mailbox: Mailbox) -> None:
        """Hand what comes from now on to another mailbox."""
        with self.lock:
            if self.closing or self.interrupted:
                mailbox.interrupt()
            self.mailbox, self.receive = mailbox, mailbox.put

    def interrupt(self) -> None:
        """Stop reading and writing; connections stay."""
        self.interrupted = True
        self.mailbox.interrupt()

    def resume(self) -> None:
        """Undo `interrupt`; a closed port stays closed."""
        with self.lock:
            if self.closing:
                return
        self.interrupted = False
        self.mailbox.resume()

    def close(self) -> None:
        """Close every connection in good order, then the port; the name is given back."""
        with self.lock:
            if self.closing:
                return
            self.closing = True
        self.crew.reconnect.forget(self)
        if self.seat is not None:
            self.seat.leave()
        self.mailbox.interrupt()
        self.reception.finish(0.3)  # connections just arriving are told to leave as well
        senders = [link.route.source for link in self.inputs if link.carrier.push]
        answers = farewell.ask_all_to_leave(self.registration, senders)
        for output in self.outputs:
            self.crew.close_output(self, output)
        farewell.let_answers_leave(self.inputs, 0.3)
        for link in self.inputs:
            link.close()
        deadline = time.monotonic() + 3.0
        for link in (*self.inputs, *self.leaving):
            if link.thread is not None and link.thread is not threading.current_thread():
                link.thread.join(max(0.0, deadline - time.monotonic()))
        self.reception.close()
        self.preparing.end()
        self.monitoring.close()
        self.callbacks.close()
        try:
            if not answers:
                raise NoNameServer("it did not answer just now")
            self.registration.give_back()
        except (NoNameServer, AccessRefused) as error:
            log.info("%s: the name stays registered: %s", self.name, error)

    def snapshot(self) -> dict[str, Any]:
        """Counters of every connection, and of the mailbox."""
        return {
            "name": self.name,
            "inputs": [{**_route(link), **link.snapshot()} for link in self.inputs],
            "outputs": [{**_route(link), **link.snapshot()} for link in self.outputs],
            "unconnected": self.unconnected,
            "past": {side: past.as_dict() for side, past in self.past.items()},
            "waiting": self.mailbox.waiting,
        }


def _route(link: Inbound | Outbound) -> dict[str, str]:
    route = link.route
    return {"source": route.source, "target": route.target, "carrier": route.carrier}
