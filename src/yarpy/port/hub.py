"""Hub: a port without its reader - a name, a listening socket, and the links in and out.

Rules: no lock is held while user code runs or bytes move. What acts on hubs (commands,
administration, reconnecting) imports this file and is handed in, as `Actions`: a hub knows none of
them. `assembly` puts them together.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from yarpy import linger, scope
from yarpy.callback_thread import waited_by
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import NoNameServer, YarpError
from yarpy.link.begin.admission import Gate
from yarpy.link.receive.budget import port_budget
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.answer.callbacks import Callbacks
from yarpy.port.answer.monitoring import Monitoring
from yarpy.port.answer.reception import Reception
from yarpy.port.connect import goodbye
from yarpy.port.connect.dialling import Dialling
from yarpy.port.connect.saved import SavedQos
from yarpy.port.graph import Membership
from yarpy.port.inputs import Inputs
from yarpy.port.keep.closing import Closing
from yarpy.port.keep.life import Life
from yarpy.port.keep.registration import Registration
from yarpy.port.mailbox import Mailbox
from yarpy.port.outputs import SILENT, Outputs
from yarpy.port.preparing import Preparing
from yarpy.port.properties import Properties
from yarpy.route import Route
from yarpy.transports.bind import reach
from yarpy.wire.message import Message
from yarpy.wire.stream import DEFAULT_LIMIT

log = logger("yarpy.port")


class Reconnect(Protocol):
    """The watcher that makes broken connections again."""

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

    def over(self, hub: Hub, source: str, /) -> None:
        """A sender has said goodbye for an input that has just ended."""


@dataclass(frozen=True, slots=True)
class Actions:
    """The functions that act on hubs."""

    administer: Callable[[Hub, Message], Bottle]  # answers an administrative message
    obey: Callable[[Hub, Inbound, Message], list[str]]  # carries out a port command
    close_output: Callable[[Hub, Outbound], None]
    reconnect: Reconnect


class Hub:
    """A port's connections.

    `admits_outputs` and `rpc` are what requests for outputs are checked against. `limit` is the
    largest message in bytes, `input_limit` what unfinished ones may hold together (None: as the
    environment says). `directory`: it is a name server's. `gate`: as in PortOptions.
    """

    def __init__(
        self,
        registration: Registration,
        mailbox: Mailbox,
        actions: Actions,
        *,
        admits_outputs: bool = True,
        rpc: bool = False,
        limit: int = DEFAULT_LIMIT,
        input_limit: int | None = None,
        directory: bool = False,
        gate: Callable[[str], Gate] | None = None,
    ) -> None:
        self.registration = registration
        self.actions = actions
        self.life = Life()
        self.callbacks = Callbacks(registration)
        self.properties = Properties()
        self.watchers: dict[int, Callable[[], None]] = {}  # wait for connections
        self.dialling = Dialling()
        self.saved_qos = SavedQos()
        self.membership: Membership | None = None  # in the graph of a node
        budget = port_budget(input_limit)
        self.inputs = Inputs(self, mailbox, budget)
        self.outputs = Outputs(self, budget, self.inputs.lock, admits_outputs, rpc)
        self.reception = Reception(
            registration,
            limit,
            self.inputs.run,
            directory,
            "" if admits_outputs else SILENT,
            self.inputs.find_room,
            self.inputs.rival,
            gate,
        )
        self.monitoring = Monitoring(self)
        self.preparing = Preparing()
        self._ender = Closing(
            lambda: self.name,
            (
                (self._leave, 0.2),
                (self._ask_senders_to_leave, 0.4),
                (lambda: self.outputs.close(self._close_output), 0.8),
                (self.inputs.close, 0.9),
                (self._stop_listening, 1.0),
                (self._give_back, 1.0),
            ),
        )

    # -- what it is -------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The name, complete once the port is open."""
        return self.registration.name

    @property
    def contact(self) -> Contact:
        """The address where the port listens."""
        return self.registration.contact

    @property
    def port(self) -> int:
        """The number of the listening socket."""
        return self.registration.port

    @property
    def limit(self) -> int:
        """The largest message, in bytes."""
        return self.reception.limit

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

    def snapshot(self) -> dict[str, Any]:
        """Counters of every connection, and of the mailbox."""
        inputs, outputs = self.inputs, self.outputs
        return {
            "name": self.name,
            "inputs": [{**_route(link), **link.snapshot()} for link in inputs.connections],
            "outputs": [{**_route(link), **link.snapshot()} for link in outputs.links],
            "unconnected": outputs.unconnected,
            "past": {"inputs": inputs.past.as_dict(), "outputs": outputs.past.as_dict()},
            "waiting": inputs.mailbox.waiting,
        }

    # -- opening ----------------------------------------------------------------------------------

    def open(self, port: int, host: str) -> None:
        """Listen on `port` (0: any free one) and register. Raises AddressError, NoNameServer."""
        linger.add(self, lambda seconds: self._undo_opening())  # a signal may end the program here
        try:
            self.registration.open(port, host, self.reception.listen)
            self.reception.open()
            self.registration.tell()
        except BaseException:
            self._undo_opening()
            linger.remove(self)
            raise
        linger.add(self, self._close_at_end)
        self.actions.reconnect.watch(self)
        where = f"tcp://{self.contact.address}/"
        log.info("Port %s active at %s, open to %s", self.name, where, reach())

    def _undo_opening(self) -> None:
        self.life.closing = True
        self.reception.close()
        self.registration.forget()

    # -- asked by its inputs and outputs ----------------------------------------------------------

    def answer(self, message: Message) -> Bottle:
        """Answer an administrative message."""
        return self.actions.administer(self, message)

    def obey(self, link: Inbound, message: Message) -> list[str]:
        """Carry out a port command; lines for a person to read."""
        return self.actions.obey(self, link, message)

    def changed(self) -> None:
        """Wake whoever waits for connections."""
        for wake in tuple(self.watchers.values()):
            wake()

    def watch(self) -> None:
        """Look after a connection that gives no sign of its end."""
        self.actions.reconnect.wake()

    def input_lost(self, route: Route) -> None:
        """Expect an input again that ended without a goodbye."""
        self.actions.reconnect.input_lost(self, route)

    def input_left(self, route: Route) -> None:
        """Expect an input no more: its sender has said goodbye."""
        self.actions.reconnect.give_up(self, route.source, incoming=True)

    def output_lost(self, route: Route) -> None:
        """Connect an output again that broke without anybody asking for it."""
        self.actions.reconnect.output_lost(self, route)

    # -- ending -----------------------------------------------------------------------------------

    def interrupt(self) -> None:
        """Stop reading and writing; connections stay, but those that wait for an answer."""
        self.life.interrupted = True
        self.life.calls.end(f'"{self.name}" is interrupted')
        self.outputs.end_calls("interrupted")
        self.inputs.interrupt()

    def resume(self) -> None:
        """Undo `interrupt`; a closed port stays closed."""
        with self.inputs.lock:
            if self.life.closing:
                return
        self.life.interrupted = False
        self.outputs.ending.resume()
        self.inputs.mailbox.resume()
        if self.life.closing:  # by another thread, or a signal handler, meanwhile
            self.outputs.end_calls("closed")
            self.inputs.end_reading()

    def close(self, seconds: float | None = None) -> None:
        """Close every connection in good order, then the port; the name is given back. All of it
        takes so many seconds at most; where none are given, what `linger` says, and `linger.NAMES`
        for the name if all of that was needed for the rest."""
        if seconds is None:
            self._close(linger.seconds(), linger.NAMES)
        else:
            self._close(seconds, 0.0)

    def _close_at_end(self, seconds: float) -> None:
        """The program ends."""
        self._close(seconds, linger.left_for_names())

    def _close(self, seconds: float, giving_back: float) -> None:
        with self.inputs.lock:
            self.life.closing = True
        self.life.calls.end(f'"{self.name}" is closed', last=True)
        self.outputs.end_calls("closed")
        own = [link.thread for link in (*self.inputs.links, *self.inputs.leaving)]
        self._ender.run(
            seconds,
            last=giving_back if self.registration.answered else 0.0,
            wait=waited_by() not in own,  # which are waited for
        )

    def _leave(self) -> None:
        self.actions.reconnect.forget(self)
        self.inputs.end_reading()
        if self.membership is not None:
            self.membership.leave()
        # Connections that are just arriving are told to leave as well.
        self.reception.finish(min(0.3, scope.remaining()))

    def _ask_senders_to_leave(self) -> None:
        senders = [link.route.source for link in self.inputs.links if link.carrier.push]
        self.registration.answered = False
        self.registration.answered = goodbye.ask_all_to_leave(self.registration, senders)

    def _close_output(self, link: Outbound) -> None:
        self.actions.close_output(self, link)

    def _stop_listening(self) -> None:
        self.reception.close()
        self.preparing.end()
        self.monitoring.close()
        self.callbacks.close()

    def _give_back(self) -> None:
        try:
            if not self.registration.answered:
                raise NoNameServer("it did not answer just now")
            self.registration.give_back()
        except YarpError as error:
            log.info("%s: the name stays registered: %s", self.name, error)
        linger.remove(self)  # not before: this may be a thread that the end of the program cuts

    def abandon(self, why: str) -> None:
        """In a forked process: the port is its parent's. Close our copies of its sockets."""
        self.life.inherit()
        self._ender.forget()
        self.inputs.mailbox.abandon(why)
        self.reception.abandon()
        links: tuple[Inbound | Outbound, ...] = (
            *self.inputs.links,
            *self.inputs.leaving,
            *self.outputs.links,
        )
        for link in links:
            sock = link.driver.transport.sock
            if sock is not None:
                sock.close()
        self.inputs.abandon()
        self.outputs.abandon()


def _route(link: Inbound | Outbound) -> dict[str, str]:
    route = link.route
    return {"source": route.source, "target": route.target, "carrier": route.carrier}
