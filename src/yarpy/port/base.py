"""BasePort: what every kind of port can do - be open under a name, and have connections."""

from __future__ import annotations

import sys
import threading
import time
import warnings
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Self

from yarpy.carriers.http.page import Pages
from yarpy.contact import Contact, parse_contact
from yarpy.data.bottle import Property
from yarpy.errors import LinkClosed, PortClosed
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.port import connecting, disconnecting
from yarpy.port.connection import ConnectionEvent, PortConnection
from yarpy.port.deadline import DeadlineEvent, Watch
from yarpy.port.hub import Hub
from yarpy.port.monitoring import Side
from yarpy.route import masked
from yarpy.wire.message import Message


class BasePort:
    """The common part of all ports. Made by its subclasses, not by users."""

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
    def inputs(self) -> list[PortConnection]:
        """The connections that bring messages here."""
        return [self._shown(link) for link in self._hub.inputs if link.route.source != "admin"]

    @property
    def outputs(self) -> list[PortConnection]:
        """The connections that take messages away."""
        return [self._shown(link) for link in self._hub.outputs]

    def _shown(self, link: Inbound | Outbound) -> PortConnection:
        if isinstance(link, Inbound):
            return PortConnection(link, partial(disconnecting.close_input, self._hub, link))
        return PortConnection(link, partial(disconnecting.close_output, self._hub, link))

    @property
    def stats(self) -> dict[str, Any]:
        """Counters of every connection and of the mailbox, as plain data; under `past` the sums
        over connections that have ended."""
        return self._hub.snapshot()

    def connect(
        self, target: str, carrier: str = "", timeout: float | None = None
    ) -> PortConnection:
        """Send what this port writes to `target` (`/name`, `/host:port`) over `carrier`; with a
        carrier by which the reader dials, such as mjpeg, read from it. Without one it is `memory`
        to another program of yarpy on this computer, else tcp. Returns the connection.

        With `timeout`, wait that many seconds for a port that is not there yet. Raises UnknownName,
        UnknownPlugin (a wrong carrier), LinkClosed (nobody is there), AccessRefused, NotAllowed
        (this port takes no outputs), LocalProtocolError, RemoteProtocolError.
        """
        hub = self._hub
        connecting.connect(hub, target, carrier, timeout)
        peer = parse_contact(target).label
        for output in reversed(hub.outputs):
            if output.route.target == peer:
                return self._shown(output)
        for link in reversed(hub.inputs):
            if link.route.source == peer and not link.carrier.push:
                return self._shown(link)
        raise LinkClosed(f'"{masked(target)}" went away at once')

    def disconnect(self, target: str) -> bool:
        """End what `connect` with this target has made; whether there was anything."""
        return disconnecting.disconnect(self._hub, target)

    def listen_to(self, source: str, carrier: str = "") -> None:
        """Ask the port `source` to send here; for `carrier` see `connect`. Raises UnknownName,
        LinkClosed, NotAllowed."""
        connecting.subscribe(self._hub, source, carrier)

    def wait_for_outputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports receive what this one writes; False if time is over."""
        return _wait(lambda: len(self._hub.outputs) >= count, timeout)

    def wait_for_inputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports write to this one; False if time is over."""
        return _wait(lambda: len(self.inputs) >= count, timeout)

    def on_connection(self, callback: Callable[[ConnectionEvent], None] | None) -> None:
        """Call `callback` whenever a connection comes or goes."""
        self._hub.callbacks.on_connection = callback

    def on_deadline(self, callback: Callable[[DeadlineEvent], None] | None) -> None:
        """Call `callback` whenever a message comes after the deadline of its connection
        (`Qos(deadline=...)`), or none comes that should (`Qos(rate=...)`).

        It is called in the thread of the connection, before the message is handed on; for a
        silence in a thread of the port.
        """
        callbacks, hub = self._hub.callbacks, self._hub
        callbacks.on_deadline = callback
        if callback is not None and callbacks.watch is None:
            callbacks.watch = Watch(hub.name, lambda: hub.inputs)

    def on_admin(self, callback: Callable[[Message], object] | None) -> None:
        """Let `callback` answer administrative messages that the port itself does not know."""
        self._hub.callbacks.on_admin = callback

    def on_page(self, callback: Pages | None) -> None:
        """Let `callback(path, fields)` show pages to browsers: a Page, a string of HTML, or
        None for what the port shows there by itself.

        It is called for GET requests that carry no message (`/`, `/picture.png?size=2`), in the
        threads of their connections; `path` begins with a slash, `fields` are the arguments. See
        `yarpy.Page`.
        """
        self._hub.callbacks.on_page = callback

    def attach(self, side: Side, parameters: Mapping[str, Any]) -> None:
        """Let a monitor ride on all that goes "in" or "out", instead of the one that did.

        `{"monitor": NAME, ...}` says which and with what parameters; without a name it is a script,
        `{"type": "python", "file": "gate"}`. Raises UnknownPlugin, LocalProtocolError.
        """
        self._hub.monitoring.attach(side, Property(parameters), own=True)

    def detach(self, side: Side) -> None:
        """Let nothing ride on it any more."""
        self._hub.monitoring.detach(side)

    def interrupt(self) -> None:
        """Stop reading and writing: a waiting `read` raises PortClosed; connections stay."""
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

    def __exit__(self, *details: object) -> None:
        self.close()

    def __del__(self) -> None:
        """Nobody can close it any more. Closing waits for threads, perhaps for the one in which
        objects are being collected, so a thread of its own does it."""
        hub = getattr(self, "_hub", None)
        if hub is None or hub.closing or sys.is_finalizing():
            return
        warnings.warn(
            f'port "{hub.name}" was dropped without being closed: call close(), or use it in a '
            "`with` statement",
            ResourceWarning,
            stacklevel=2,
            source=self,
        )
        threading.Thread(target=hub.close, name=f"yarpy close {hub.name}", daemon=True).start()

    def __repr__(self) -> str:
        state = "closed" if self.closed else self.address
        return f"<{type(self).__name__} {self.name} ({state})>"

    def _check_open(self) -> None:
        hub = self._hub
        if hub.closing or hub.interrupted:
            state = "closed" if hub.closing else "interrupted"
            if hub.inherited:
                state = "a port of the process that this one was forked from; open one here"
            raise PortClosed(f'"{hub.name}" is {state}')


def _wait(condition: Callable[[], bool], timeout: float | None) -> bool:
    deadline = None if timeout is None else time.monotonic() + timeout
    while not condition():
        if deadline is not None and time.monotonic() >= deadline:
            return False
        time.sleep(0.005)
    return True
