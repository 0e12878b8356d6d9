"""BasePort: what every kind of port can do - be open under a name, and have connections."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable, Mapping, Sized
from functools import partial
from operator import index
from typing import Any, NoReturn, Self, SupportsIndex

from yarpy.carriers.web.http.page import Pages
from yarpy.contact import Contact, parse_contact
from yarpy.data.bottle import Property
from yarpy.errors import LinkClosed, PortClosed
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.port.answer.monitoring import Side
from yarpy.port.connect import connecting, disconnecting
from yarpy.port.connection import ConnectionEvent, PortConnection
from yarpy.port.deadline import DeadlineEvent, Watch
from yarpy.port.hub import Hub
from yarpy.port.stats import PortStats, port_stats
from yarpy.route import masked
from yarpy.scope import CONNECTING, Waiter, apart
from yarpy.threads import Thread
from yarpy.wire.message import Message


def at_least(count: int, found: Callable[[], Sized]) -> Callable[[], bool]:
    """Return what tells whether `found()` has `count`. Raises TypeError for what is no number."""
    try:
        wanted = index(count)
    except TypeError:
        raise TypeError(f"`count` is a number of connections, not {count!r}") from None
    return lambda: len(found()) >= wanted


class BasePort:
    """The common part of all ports. Made by its subclasses, not by users."""

    _hub: Hub

    def __init__(self, hub: Hub) -> None:
        self._hub = hub
        # They may know this object, so the threads of connections must not keep them.
        self._program = hub.callbacks.release()
        self._handles = hub.inputs.mailbox.release()

    @property
    def name(self) -> str:
        """The name, complete: what `...` became, prefix included."""
        return self._hub.name

    @property
    def contact(self) -> Contact:
        """The address where the port listens."""
        return self._hub.contact

    @property
    def address(self) -> str:
        """`host:port` of the listening socket."""
        return self._hub.contact.address

    @property
    def inputs(self) -> list[PortConnection]:
        """The connections that bring messages here."""
        return [self._shown(link) for link in self._hub.inputs.connections]

    @property
    def outputs(self) -> list[PortConnection]:
        """The connections that take messages away."""
        return [self._shown(link) for link in self._hub.outputs.links]

    def _shown(self, link: Inbound | Outbound) -> PortConnection:
        if isinstance(link, Inbound):
            return PortConnection(link, partial(disconnecting.close_input, self._hub, link))
        return PortConnection(link, partial(disconnecting.close_output, self._hub, link))

    @property
    def stats(self) -> PortStats:
        """The counts of every connection and of the mailbox; `past` has the sums over connections
        that have ended. `stats.as_dict()` is plain data."""
        return port_stats(self._hub.snapshot())

    @apart
    def connect(
        self, target: str, carrier: str = "", timeout: float | None = None
    ) -> PortConnection:
        """Send what this port writes to `target` (`/name`, `/host:port`) over `carrier`; with a
        carrier by which the reader dials, such as mjpeg, read from it. Without one it is `memory`
        to another program of yarpy on this computer, else tcp. Returns the connection.

        With `timeout`, wait that many seconds for a port that is not there yet; without, it is
        tried once, for 5 s. Raises UnknownName, UnknownPlugin (a wrong carrier), LinkClosed (nobody
        is there, or it is silent), AccessRefused, NotAllowed (this port takes no outputs),
        LocalProtocolError, RemoteProtocolError, NoNameServer, PortClosed.
        """
        hub = self._hub
        with hub.life.calls.scope(CONNECTING if timeout is None else timeout):
            connecting.connect(hub, target, carrier, again=timeout is not None)
        peer = parse_contact(target).label
        for output in reversed(hub.outputs.links):
            if output.route.target == peer:
                return self._shown(output)
        for link in reversed(hub.inputs.links):
            if link.route.source == peer and not link.carrier.push:
                return self._shown(link)
        if hub.life.closing:
            self._check_open()
        raise LinkClosed(f'"{masked(target)}" went away at once')

    @apart
    def disconnect(self, target: str, timeout: float | None = None) -> bool:
        """End what `connect` with this target has made; whether there was anything. What was
        written has `timeout` seconds to leave, else 5. Raises PortClosed."""
        with self._hub.life.calls.scope(CONNECTING if timeout is None else timeout):
            return disconnecting.disconnect(self._hub, target)

    @apart
    def listen_to(self, source: str, carrier: str = "", timeout: float | None = None) -> None:
        """Ask the port `source` to send here, within `timeout` seconds, else 5; for `carrier` see
        `connect`. Raises UnknownName, LinkClosed, Timeout, NotAllowed, NoNameServer, PortClosed."""
        with self._hub.life.calls.scope(CONNECTING if timeout is None else timeout):
            connecting.subscribe(self._hub, source, carrier)

    def wait_for_outputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports receive what this one writes; False if time is over.
        Raises PortClosed."""
        return self._wait(at_least(count, lambda: self._hub.outputs.links), timeout)

    def wait_for_inputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports write to this one; False if time is over. Raises
        PortClosed."""
        return self._wait(at_least(count, lambda: self.inputs), timeout)

    @apart
    def _wait(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Wait until `condition()`, looking again whenever a connection comes or goes."""
        hub, waiter = self._hub, Waiter()
        hub.watchers[id(waiter)] = waiter.wake
        try:
            with hub.life.calls.scope(timeout) as call:
                self._check_open()
                while not condition():
                    if call.until is not None and time.monotonic() >= call.until:
                        return False
                    waiter.wait()
        finally:
            del hub.watchers[id(waiter)]
        return True

    def on_connection(self, callback: Callable[[ConnectionEvent], None] | None) -> None:
        """Call `callback` whenever a connection comes or goes."""
        self._program.on_connection = callback

    def on_deadline(self, callback: Callable[[DeadlineEvent], None] | None) -> None:
        """Call `callback` whenever a message comes after the deadline of its connection
        (`Qos(deadline=...)`), or none comes that should (`Qos(rate=...)`).

        It is called in the thread of the connection, before the message is handed on; for a
        silence in a thread of the port.
        """
        callbacks, hub = self._hub.callbacks, self._hub
        self._program.on_deadline = callback
        if callback is not None and callbacks.watch is None:
            callbacks.watch = Watch(hub.name, lambda: hub.inputs.links)

    def on_admin(self, callback: Callable[[Message], object] | None) -> None:
        """Let `callback` answer administrative messages that the port itself does not know."""
        self._program.on_admin = callback

    def on_page(self, callback: Pages | None) -> None:
        """Let `callback(path, fields)` show pages to browsers: a Page, a string of HTML, or
        None for what the port shows there by itself.

        It is called for GET requests that carry no message (`/`, `/picture.png?size=2`), in the
        threads of their connections; `path` begins with a slash, `fields` are the arguments. See
        `yarpy.Page`.
        """
        self._program.on_page = callback

    def attach(self, side: Side, parameters: Mapping[str, Any]) -> None:
        """Let a monitor ride on all that goes "in" or "out", instead of the one that did.

        `{"monitor": NAME, ...}` says which and with what parameters; without a name it is a script,
        `{"type": "python", "file": "gate"}`. Raises UnknownPlugin, LocalProtocolError.
        """
        self._check_not_closed()
        self._hub.monitoring.attach(side, Property(parameters), own=True)

    def detach(self, side: Side) -> None:
        """Let nothing ride on it any more."""
        self._check_not_closed()
        self._hub.monitoring.detach(side)

    def interrupt(self) -> None:
        """Stop reading and writing: a waiting `read` raises PortClosed; connections stay."""
        self._hub.interrupt()

    def resume(self) -> None:
        """Undo `interrupt`. Raises PortClosed."""
        self._check_not_closed()
        self._hub.resume()

    def close(self, timeout: float | None = None) -> None:
        """Close the port: let what was written leave, say goodbye on each connection, give the name
        back, within `timeout` seconds, else 1 (YARPY_LINGER). What could not be done by then is
        logged.

        It may be called again, to go on where Ctrl-C has cut it, and from any thread, signal
        handler or callback: a second thread waits for the first.
        """
        self._hub.close(timeout)

    @property
    def closed(self) -> bool:
        """Return whether `close` was called."""
        return self._hub.life.closing

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def __del__(self) -> None:
        """Nobody can close it any more. Closing waits for threads, perhaps for the one in which
        objects are being collected, so a thread of its own does it."""
        hub = getattr(self, "_hub", None)
        if hub is None or hub.life.closing or sys.is_finalizing():
            return
        warnings.warn(
            f'port "{hub.name}" was dropped without being closed: call close(), or use it in a '
            "`with` statement",
            ResourceWarning,
            stacklevel=2,
            source=self,
        )
        Thread(target=hub.close, name=f"yarpy close {hub.name}", daemon=True).start()

    def __reduce_ex__(self, protocol: SupportsIndex) -> NoReturn:
        """Whoever dropped a copy would close the port that the others have."""
        raise TypeError(
            f'the port "{self.name}" can be neither copied nor pickled: a process that gets its '
            "name can connect to it"
        )

    def __repr__(self) -> str:
        state = "closed" if self.closed else self.address
        return f"<{type(self).__name__} {self.name} ({state})>"

    def _check_not_closed(self) -> None:
        if self._hub.life.closing:
            self._check_open()

    def _check_open(self) -> None:
        hub = self._hub
        if hub.life.closing or hub.life.interrupted:
            state = "closed" if hub.life.closing else "interrupted"
            if hub.life.inherited:
                state = "a port of the process that this one was forked from; open one here"
            raise PortClosed(f'"{hub.name}" is {state}')
