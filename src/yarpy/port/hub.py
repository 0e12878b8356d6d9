"""Hub: a port without its reader - a name, a listening socket, and the links in and out.

Rules: the tuples of links are replaced under `lock`, never changed, so who walks them needs no
lock; no lock is held while user code runs or bytes move. Every end of a connection comes through
`closed` or `drop_output`, once. What acts on hubs (commands, administration, repair) imports this
file and is handed in, as `Crew`: a hub knows none of them. `assembly` puts them together.
"""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Protocol

from yarpy.carriers.base import PAGE, Carrier
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.property import Property
from yarpy.errors import NoNameServer, PortClosed, RemoteProtocolError, YarpError
from yarpy.link.counter import Past
from yarpy.link.driver import Driver
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.port import probe
from yarpy.port.callbacks import Callbacks
from yarpy.port.connection import ConnectionEvent
from yarpy.port.dialling import Dialling
from yarpy.port.mailbox import Mailbox
from yarpy.port.monitoring import Monitoring
from yarpy.port.reception import Reception
from yarpy.port.registration import Registration
from yarpy.route import Route
from yarpy.transports.bind import reach
from yarpy.wire.message import Message
from yarpy.wire.stream import DEFAULT_LIMIT

log = logger("yarpy.port")

# Inputs over datagrams that a port has at most: each costs a thread and a socket here, and whoever
# asked for it nothing, since no connection is left that would end with its program.
MAX_DATAGRAM_INPUTS: Final = 256


class Repair(Protocol):
    """Who brings back the connections that broke."""

    def watch(self, hub: Hub, /) -> None:
        """Look after a port."""

    def forget(self, hub: Hub, /) -> None:
        """The port closes."""

    def output_lost(self, hub: Hub, route: Route, /) -> None:
        """An output broke without anybody asking for it."""

    def input_lost(self, hub: Hub, route: Route, /) -> None:
        """An input ended without a goodbye."""

    def give_up(self, hub: Hub, name: str, incoming: bool | None = None) -> bool:
        """Somebody takes the connection to or from `name` in hand; whether it was tried again."""


@dataclass(frozen=True, slots=True)
class Crew:
    """Who acts on hubs."""

    administer: Callable[[Hub, Message], Bottle]  # answers an administrative message
    obey: Callable[[Hub, Inbound, Message], list[str]]  # carries out a port command
    close_output: Callable[[Hub, Outbound], None]
    repair: Repair


class Hub:
    """A port's connections.

    `admits_outputs` and `rpc` are what requests for outputs are checked against. `limit` is the
    largest message in bytes.
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
    ) -> None:
        self.registration = registration
        self.mailbox = mailbox
        self.receive: Callable[[Inbound, Message], None] = mailbox.put  # what links call
        self.crew = crew
        self.admits_outputs = admits_outputs
        self.rpc = rpc
        self.limit = limit
        self.callbacks = Callbacks(registration)
        self.properties = Property()
        self.inputs: tuple[Inbound, ...] = ()  # one at most from each rooted name
        self.leaving: tuple[Inbound, ...] = ()  # were inputs; their threads have not ended yet
        self.outputs: tuple[Outbound, ...] = ()
        self.past = {"inputs": Past(), "outputs": Past()}
        self.closing = False
        self.inherited = False  # from the process that this one was forked from
        self.interrupted = False
        self.on_inputs: Callable[[], None] = lambda: None  # the reader looks at them again
        self.lock = threading.Lock()  # replaces the tuples of links
        self.dialling = Dialling()
        self.monitoring = Monitoring(self)
        self.reception = Reception(registration, limit, self.run_input)

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
        self.crew.repair.watch(self)
        where = f"tcp://{self.contact.address}/"
        log.info("Port %s active at %s, open to %s", self.name, where, reach())

    # -- connections in ---------------------------------------------------------------------------

    def run_input(self, driver: Driver, carrier: Carrier) -> None:
        """Serve a connection that we accepted as an input, in this thread, until it ends.

        With a pull carrier it is an output instead: who dialled receives.
        """
        if not carrier.push:
            self._serve_reader(driver, carrier)
            return
        link = Inbound(self, driver, carrier)
        link.thread = threading.current_thread()
        try:
            self.take_input(link)
        except PortClosed:
            return
        except YarpError as error:
            log.warning("%s: connection %s refused: %s", self.name, link.route, error)
            return
        self.serve_input(link)

    def take_input(self, link: Inbound) -> None:
        """Make an open connection one of our inputs, to be served next.

        It replaces the one that its sender had, and waits for the end of that, up to 2 s. Raises
        PortClosed, and as monitors do that cannot start; the connection is closed then.
        """
        link.receiver.page = self.callbacks.page
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
            full = link.carrier.connectionless and (
                sum(item.carrier.connectionless for item in (*others, *self.leaving))
                >= MAX_DATAGRAM_INPUTS
            )
            if not (late or full):
                self.inputs = (*others, link)
                self.leaving = (*self.leaving, *older)
        if full:
            self._turn_away(link)
            raise RemoteProtocolError(
                f"there are {MAX_DATAGRAM_INPUTS} inputs over datagrams already; use tcp"
            )
        if late:
            with contextlib.suppress(NoNameServer):
                self.ask_to_leave(link.route.source)
            self._turn_away(link)
            raise PortClosed(f'"{self.name}" is closed')
        for old in older:
            old.close()
            if old.thread is not threading.current_thread():
                old.served.wait(2.0)  # what it still brings comes before what the new one brings

    def _turn_away(self, link: Inbound) -> None:
        link.driver.transport.close()
        if link.own_chain is not None:
            link.own_chain.close()

    def serve_input(self, link: Inbound) -> None:
        """Serve an input, in this thread, until it ends."""
        link.thread = threading.current_thread()
        link.thread.name = f"yarpy {link.route}"
        self.on_inputs()
        self.report(link, created=True)
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
        output = Outbound(driver, carrier, dialled=False)
        try:
            output.chain = self.monitoring.outgoing(route)
        except YarpError as error:
            log.warning("%s: connection %s refused: %s", self.name, route, error)
            driver.transport.close()
            return
        with self.lock:
            if self.closing:
                driver.transport.close()
                return
            self.outputs = (*self.outputs, output)
        self.report(output, created=True)

    def closed(self, link: Inbound, reason: str, quit_: bool) -> None:
        if not self._forget_input(link):
            return
        self.report(link, created=False, reason=reason)
        if not (quit_ or link.closing or self.closing):
            self.crew.repair.input_lost(self, link.route)

    def _forget_input(self, link: Inbound) -> bool:
        with self.lock:
            known = link in (*self.inputs, *self.leaving)
            self.inputs = tuple(item for item in self.inputs if item is not link)
            self.leaving = tuple(item for item in self.leaving if item is not link)
        if known:
            self.past["inputs"].add(link.counter, link.lost)
        self.on_inputs()
        return known

    # -- connections out --------------------------------------------------------------------------

    def add_output_link(self, link: Outbound) -> None:
        """Take a greeted connection as an output; one to the same port is replaced by it."""
        with self.lock:
            if self.closing:
                link.driver.transport.close()
                raise PortClosed(f'"{self.name}" was closed meanwhile')
            self.outputs = (*self.outputs, link)
            self._elect()
        self.report(link, created=True)

    def drop_output(self, link: Outbound, reason: str = "", lost: bool = False) -> bool:
        """Forget an output. With `lost`, keep trying to connect it again."""
        with self.lock:
            known = link in self.outputs
            self.outputs = tuple(item for item in self.outputs if item is not link)
            self._elect()
        if known:
            self.past["outputs"].add(link.counter)
            if link.chain is not None:
                link.chain.close()
            self.report(link, created=False, reason=reason)
            if lost and link.dialled and not self.closing:
                self.crew.repair.output_lost(self, link.route)
        return known

    def _elect(self) -> None:
        """Of the connections into one multicast group a single one sends."""
        elected = False
        for link in self.outputs:
            if link.carrier.broadcast:
                link.active = not elected
                elected = True

    # -- reports ----------------------------------------------------------------------------------

    def report(self, link: Inbound | Outbound, created: bool, reason: str = "") -> None:
        """Log a connection's coming or going and tell whoever wants to know."""
        route = link.route
        incoming = isinstance(link, Inbound)
        peer = route.source if incoming else route.target
        event = ConnectionEvent(
            incoming, created, route.source, route.target, route.carrier, reason
        )
        log.log(logging.INFO if peer.startswith("/") else logging.DEBUG, "%s", event)
        if peer.startswith("/"):
            self.callbacks.connection(event)

    # -- ending -----------------------------------------------------------------------------------

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
        self.crew.repair.forget(self)
        self.mailbox.interrupt()
        self.reception.finish(0.3)  # who is just arriving is told to leave as well
        answers = self._ask_senders_to_leave()
        for output in self.outputs:
            self.crew.close_output(self, output)
        for link in self.inputs:
            link.close()
        deadline = time.monotonic() + 3.0
        for link in (*self.inputs, *self.leaving):
            if link.thread is not None and link.thread is not threading.current_thread():
                link.thread.join(max(0.0, deadline - time.monotonic()))
        self.reception.close()
        self.monitoring.close()
        try:
            if not answers:
                raise NoNameServer("it did not answer just now")
            self.registration.give_back()
        except NoNameServer as error:
            log.info("%s: the name stays registered: %s", self.name, error)

    def _ask_senders_to_leave(self) -> bool:
        """Ports that send to us hear it from us, so that they do not take it for a failure.

        False if nobody tells where they are: a name service that does not answer is not waited for
        again and again.
        """
        for link in self.inputs:
            try:
                self.ask_to_leave(link.route.source)
            except NoNameServer:
                return False
        return True

    def ask_to_leave(self, source: str) -> None:
        """Ask the port `source` to drop its connection to us: it would take the end for a failure.

        Raises NoNameServer if nobody tells where that port is.
        """
        if not source.startswith("/") or source == self.name or self.names is None:
            return
        try:
            contact: Contact | None = self.names.query(source)
            if contact is not None and contact.carrier == "tcp":
                probe.drop_output(contact, self.name, timeout=1.0, secret_=self.key)
        except NoNameServer:
            raise
        except (YarpError, OSError):
            pass  # it will notice by itself

    def snapshot(self) -> dict[str, Any]:
        """Counters of every connection, and of the mailbox."""
        return {
            "name": self.name,
            "inputs": [{**_route(link), **link.snapshot()} for link in self.inputs],
            "outputs": [{**_route(link), **link.snapshot()} for link in self.outputs],
            "past": {side: past.as_dict() for side, past in self.past.items()},
            "waiting": self.mailbox.waiting,
        }


def _route(link: Inbound | Outbound) -> dict[str, str]:
    route = link.route
    return {"source": route.source, "target": route.target, "carrier": route.carrier}
