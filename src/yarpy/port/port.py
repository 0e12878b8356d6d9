"""Port: the thing with a name that programs read from and write to.

Rules: opening registers, closing gives the name back; it is a context manager and iterates over
what comes in. Everything is safe to call from any thread.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from yarpy.contact import Contact, modifier
from yarpy.data.stamp import Stamp
from yarpy.errors import LinkClosed, LocalProtocolError, PortClosed, UnknownName, YarpError
from yarpy.link.inbound import PATIENCE, Inbound
from yarpy.link.outbound import Outbound
from yarpy.names.base import NameClient
from yarpy.port import command, wiring
from yarpy.port.connection import Connection
from yarpy.port.event import ConnectionEvent
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Mailbox, Rendezvous
from yarpy.wire.message import CALL, DATA, Message, Packet
from yarpy.wire.stream import DEFAULT_LIMIT

if TYPE_CHECKING:
    pass

# A reader that comes back within this many seconds may read the socket itself.
_QUICK = 0.005


class BasePort:
    """What every kind of port can do: be open under a name, and have connections."""

    _hub: Hub

    def __init__(self, hub: Hub) -> None:
        self._hub = hub

    @property
    def name(self) -> str:
        """The name, complete: what `...` became, prefix included."""
        return self._hub.name

    @property
    def contact(self) -> Contact:
        """Where the port listens."""
        return self._hub.contact

    @property
    def address(self) -> str:
        """`host:port` of the listening socket."""
        return self._hub.contact.address

    @property
    def inputs(self) -> list[Connection]:
        """The connections that bring messages here."""
        hub = self._hub
        return [Connection(link, link.close) for link in hub.inputs if _shown(link.route.source)]

    @property
    def outputs(self) -> list[Connection]:
        """The connections that take messages away."""
        hub = self._hub
        return [
            Connection(link, lambda link=link: command.close_output(hub, link))  # type: ignore[misc]
            for link in hub.outputs
        ]

    @property
    def stats(self) -> dict[str, Any]:
        """Counters of every connection and of the mailbox, as plain data."""
        return self._hub.snapshot()

    def connect(self, target: str, carrier: str = "tcp", timeout: float | None = None) -> Self:
        """Send what this port writes to `target` (`/name`, `/host:port`) over `carrier`.

        With `timeout`, wait that many seconds for a port that is not there yet. Raises UnknownName,
        UnknownPlugin (a wrong carrier), LinkClosed, LocalProtocolError (the port takes no outputs).
        """
        wiring.connect(self._hub, target, carrier, timeout)
        return self

    def disconnect(self, target: str) -> bool:
        """End the connections to `target`; whether there were any."""
        found, _ = command.disconnect_output(self._hub, target)
        return bool(found)

    def listen_to(self, source: str, carrier: str = "tcp") -> Self:
        """Ask the port `source` to send here. Raises UnknownName, LinkClosed,
        LocalProtocolError."""
        wiring.subscribe(self._hub, source, carrier)
        return self

    def wait_for_outputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports receive what this one writes; False if time is over."""
        return _wait(lambda: len(self._hub.outputs) >= count, timeout)

    def wait_for_inputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports write to this one; False if time is over."""
        return _wait(lambda: len(self.inputs) >= count, timeout)

    def on_connection(self, callback: Callable[[ConnectionEvent], None] | None) -> None:
        """Call `callback` whenever a connection comes or goes."""
        self._hub.on_connection = callback

    def on_admin(self, callback: Callable[[Message], object] | None) -> None:
        """Let `callback` answer administrative messages that the port itself does not know."""
        self._hub.on_admin = callback

    def interrupt(self) -> None:
        """Stop reading and writing: who waits in `read` gets PortClosed; connections stay."""
        self._hub.interrupt()

    def resume(self) -> None:
        """Undo `interrupt`."""
        self._hub.resume()

    def close(self) -> None:
        """Close the port: say goodbye on each connection, give the name back. Idempotent."""
        self._hub.close()

    @property
    def closed(self) -> bool:
        """Whether `close` was called."""
        return self._hub.closing

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "closed" if self.closed else self.address
        return f"<{type(self).__name__} {self.name} ({state})>"

    def _check_open(self) -> None:
        hub = self._hub
        if hub.closing or hub.interrupted:
            state = "closed" if hub.closing else "interrupted"
            raise PortClosed(f'"{hub.name}" is {state}')


class Writer(BasePort):
    """A port that can write."""

    def write(self, value: object, stamp: Stamp | str | None = None, *, wait: bool = False) -> int:
        """Send `value` to every connected port; returns how many connections took it.

        When it returns, the message is in the system's hands (in a burst: about to be, at the
        latest 0.2 ms later) and `value` may be changed. Up to 256 messages per connection may be
        on their way unacknowledged; beyond that a writer waits for its slowest reader. With `wait`
        it returns when every reader that acknowledges has taken this message. `stamp` travels as
        the envelope. A connection that breaks is dropped, counted, and mended in the background.
        Raises PortClosed; TypeError for what cannot be sent.
        """
        hub = self._hub
        if hub.closing or hub.interrupted:
            self._check_open()
        outputs = hub.outputs
        if not outputs:
            return 0
        packet = Packet(value, envelope_of(stamp) if stamp is not None else b"")
        return self._send_all(packet, outputs, wait)

    def _send_all(self, packet: Packet, outputs: tuple[Outbound, ...], wait: bool) -> int:
        sent = 0
        for link in outputs:
            if not link.active or _is_log(link):
                continue
            try:
                link.send(packet)
                if wait:
                    link.wait_acknowledged()
                sent += 1
            except LinkClosed as error:
                self._hub.drop_output(link, str(error), lost=True)
            except YarpError as error:
                self._hub.drop_output(link, str(error))
        return sent

    def flush(self, timeout: float | None = None) -> bool:
        """Wait until every message was sent and, where readers acknowledge, taken."""
        done = True
        for link in self._hub.outputs:
            try:
                link.wait_acknowledged(timeout)
            except YarpError:
                done = False
        return done


class Port(Writer):
    """A plain port: every message is read once, and its sender waits until it was.

    name: begins with `/`; `...` asks the name server for one; "" opens an unregistered port.
    names: a name client, None for the default (see `yarpy.NameServer`, `yarpy.LocalNames`).
    port: the TCP port number, 0 to let the name server or the system choose.
    callback: called with each message in its connection's thread, instead of `read`.
    spin: readers ask the socket again and again instead of sleeping: the lowest latency, one core.
    limit: the largest message accepted, in bytes.
    Raises AddressError (unusable name, or in use), NoNameServer.
    """

    def __init__(
        self,
        name: str,
        *,
        names: NameClient | None = None,
        port: int = 0,
        type_: str = "",
        callback: Callable[[Message], None] | None = None,
        spin: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
    ) -> None:
        mailbox = Rendezvous() if callback is None else Callback(callback)
        self._mailbox: Mailbox = mailbox
        hub = Hub(
            name,
            mailbox,
            names,
            port=port,
            type_=type_,
            limit=limit,
            on_connection=on_connection,
        )
        super().__init__(hub)
        self._reader = Reader(hub, spin)

    def read(self, timeout: float | None = None) -> Message:
        """The next message. A question that the last one asked and you left open is then closed.

        Raises Timeout after `timeout` seconds, PortClosed if the port is closed or interrupted.
        """
        return self._reader.read(timeout)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        return self._mailbox.poll()

    def __iter__(self) -> Iterator[Message]:
        """Messages until the port is closed or interrupted."""
        try:
            while True:
                yield self.read()
        except PortClosed:
            return


class Reader:
    """Reading from a hub: out of the mailbox, or directly from the one link there is.

    The mailbox is always right. Direct reading is a shortcut for the case that matters most, a loop
    around one connection: it saves waking a second thread for every message.
    """

    def __init__(self, hub: Hub, spin: bool = False) -> None:
        self._hub = hub
        self._mailbox = hub.mailbox
        self._spin = spin
        self._sole: Inbound | None = None
        self._left = 0.0
        self._asking: Message | None = None
        self._settle = getattr(hub.mailbox, "settle", None)
        hub.on_inputs = self._look_again

    def _look_again(self) -> None:
        """Connections came or went: only a sole, unscheduled one may be read directly."""
        inputs = self._hub.inputs
        sole = inputs[0] if len(inputs) == 1 and not inputs[0].carrier.connectionless else None
        old, self._sole = self._sole, sole
        if old is not None and old is not sole:
            old.wanted = False

    def read(self, timeout: float | None) -> Message:
        """See Port.read."""
        from yarpy.errors import Timeout

        deadline = None if timeout is None else time.monotonic() + timeout
        self._finish()
        while True:
            link = self._sole
            if link is not None and link.wanted and not self._hub.mailbox.waiting:
                message = self._directly(link, deadline)
                if message is not None:
                    return message
            elif link is not None and link.sched.policy < 1 and self._is_quick():
                link.wanted = True
            message = self._from_mailbox(link, deadline)
            if message is not None:
                self._left = time.perf_counter()
                return message
            if deadline is not None and time.monotonic() >= deadline:
                raise Timeout(f'nothing came to "{self._hub.name}" within {timeout} s')

    def _is_quick(self) -> bool:
        """Whether the reader comes back fast enough to be worth the turn."""
        return self._spin or time.perf_counter() - self._left < _QUICK

    def _from_mailbox(self, link: Inbound | None, deadline: float | None) -> Message | None:
        left = None if deadline is None else max(0.0, deadline - time.monotonic())
        if link is not None and link.wanted:
            # The turn may become free at any moment; do not sleep past it.
            left = PATIENCE if left is None else min(left, PATIENCE)
        return self._mailbox.take(left)

    def _directly(self, link: Inbound, deadline: float | None) -> Message | None:
        hub = self._hub
        if not link.borrow():
            return None
        try:
            while not (self._mailbox.waiting or self._mailbox.stopped) and link.wanted:
                until = deadline
                if until is not None and until - time.monotonic() > PATIENCE:
                    until = None
                message = link.fetch(until, self._spin)
                if message is not None:
                    if message.answer is not None:
                        self._asking = message
                        if self._settle is None:
                            link.settle(message)
                    if hub.mailbox.stopped:
                        hub.mailbox.put(link, message)
                        return None
                    return message
                if deadline is not None and time.monotonic() >= deadline:
                    return None
            return None
        finally:
            link.give_back()

    def _finish(self) -> None:
        """The reader is done with the message it took last."""
        if self._settle is not None:
            self._settle()
        asking, self._asking = self._asking, None
        if asking is not None and asking.answer is not None and self._sole is not None:
            self._sole.settle(asking)


def envelope_of(stamp: Stamp | str | bytes) -> bytes:
    """The envelope's bytes: a Stamp's text, or any one-line text up to its first control
    character."""
    if isinstance(stamp, Stamp):
        return stamp.to_text().encode()
    data = stamp.encode() if isinstance(stamp, str) else stamp
    for index, byte in enumerate(data):
        if byte < 0x20 or byte >= 0x80:
            return data[:index]
    return data


def _is_log(link: Outbound) -> bool:
    carrier = link.route.carrier
    return "+" in carrier and modifier(carrier, "log") is not None


def _shown(name: str) -> bool:
    return name != "admin"


def _wait(condition: Callable[[], bool], timeout: float | None) -> bool:
    deadline = None if timeout is None else time.monotonic() + timeout
    while not condition():
        if deadline is not None and time.monotonic() >= deadline:
            return False
        time.sleep(0.005)
    return True


__all__ = ["CALL", "DATA", "LocalProtocolError", "Port", "UnknownName"]
