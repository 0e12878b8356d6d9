"""Reception: the listening socket of a port, and the connections that are just arriving there.

Rules: what a connection speaks is found out in a thread of its own, after its first bytes. A
connection that comes before the port knows its own name waits until it does.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from typing import Final

from yarpy.carriers.base import Carrier
from yarpy.config import access_file
from yarpy.errors import AccessRefused, YarpError
from yarpy.link.begin.acceptor import Acceptor
from yarpy.link.begin.admission import Gate, Rival, Room, any_number, no_rival
from yarpy.link.begin.handshake import UNPROVED, welcome
from yarpy.link.driver import Driver
from yarpy.log import logger
from yarpy.names.base import Medium
from yarpy.port.keep.registration import Registration
from yarpy.scope import Flag
from yarpy.transports.base import Answerable, Transport
from yarpy.transports.tcp import TcpTransport

log = logger("yarpy.port")

_HOSTS: Final = 1000  # that are remembered, to say of each once what it does


class Reception:
    """Welcomes connections and hands each to `serve`, which runs in its thread until it ends.

    directory: it is a name server's port. silence: why the port writes nothing that could be
    heard. room: whether it has a place for another sender of datagrams.
    rival: why another sender of a name is not taken. gate: what decides who may do what, instead of
    the rules of access.toml.
    """

    def __init__(
        self,
        registration: Registration,
        limit: int,
        serve: Callable[[Driver, Carrier], None],
        directory: bool = False,
        silence: str = "",
        room: Room = any_number,
        rival: Rival = no_rival,
        gate: Callable[[str], Gate] | None = None,
    ) -> None:
        self._registration = registration
        self.limit = limit
        self._serve = serve
        self._acceptor: Acceptor | None = None
        self._arriving: set[threading.Thread] = set()  # connections that are being welcomed
        self._open = Flag()
        self._directory = directory
        self._silence = silence
        self._room = room
        self._rival = rival
        self._own_gate = gate
        self._gate: Gate | None = None  # of the name that the port has in the end
        self._closing = False
        self._unproved: set[str] = set()  # hosts that hung up, which was told
        self._stop_medium: Callable[[], None] = lambda: None

    def listen(self, port: int) -> int:
        """Listen on `port`, 0 for any free one; the number it is. Raises OSError."""
        self._acceptor = Acceptor(
            self._registration.name, port, self._welcome, bool(self._registration.key)
        )
        return self._acceptor.port

    def open(self) -> None:
        """The port knows its name: let them in. Raises AddressError for rules that nobody can
        read."""
        own = self._registration
        if self._own_gate is None:
            self._gate = access_file.gate(own.name, self._directory)
        else:
            self._gate = self._own_gate(own.name)
        if own.registered and isinstance(own.names, Medium):
            self._stop_medium = own.names.listen(own.port, self._receive)
        self._open.set()

    @property
    def thread_id(self) -> int:
        """The kernel's id of the thread that accepts connections."""
        return -1 if self._acceptor is None else self._acceptor.thread_id

    def _welcome(self, sock: socket.socket) -> None:
        """The life of one accepted connection, in its own thread."""
        self._receive(TcpTransport(sock))

    def _receive(self, transport: Answerable) -> None:
        self._open.wait()
        own = self._registration
        peer = _peer(transport)
        gate = self._gate
        if gate is None:  # the port was never open
            transport.close()
            return
        self._arriving.add(threading.current_thread())
        try:
            found = welcome(
                transport,
                own.name,
                own.port,
                key=own.key,
                limit=self.limit,
                gate=gate,
                declared=own.declared,
                silence=self._silence,
                room=self._room,
                rival=self._rival,
            )
        except AccessRefused:
            transport.close()  # logged where it was refused
            return
        except BaseException as error:  # a defect, or no memory, ends this connection alone
            transport.close()
            if not self._closing and not self._is_old_news(peer, error):
                log.warning("%s: connection from %s refused: %s", own.name, peer, _said(error))
            return
        finally:
            self._arriving.discard(threading.current_thread())
        if found is None:
            transport.close()
            return
        driver, carrier = found
        try:
            self._serve(driver, carrier)
        except BaseException as error:
            driver.transport.close()
            log.error("%s: connection %s fails: %s", own.name, carrier.route, _said(error))

    def _is_old_news(self, peer: str, error: BaseException) -> bool:
        """Return whether a warning would say again what that host does all the time: name servers
        look every few seconds whether a port still listens, and prove no key."""
        if str(error) != UNPROVED:
            return False
        host = peer.rpartition(":")[0]
        known = host in self._unproved
        if len(self._unproved) < _HOSTS:
            self._unproved.add(host)
        return known

    def finish(self, seconds: float) -> None:
        """The port closes: give connections that are just arriving so many seconds to be complete,
        since only complete ones can be told to leave."""
        self._closing = True
        soon = time.monotonic() + seconds
        for thread in tuple(self._arriving):
            thread.join(max(0.0, soon - time.monotonic()))

    def abandon(self) -> None:
        """Give back this process's copies of the sockets, in a process without our thread."""
        if self._acceptor is not None:
            self._acceptor.abandon()

    def close(self) -> None:
        """Stop listening; connections that were handed on are not touched."""
        self._closing = True
        self._stop_medium()
        self._open.set()  # nobody waits any longer
        if self._acceptor is not None:
            self._acceptor.close()


def _said(error: BaseException) -> str:
    """Return an error in one line."""
    return (
        str(error) if isinstance(error, YarpError | OSError) else f"{type(error).__name__}: {error}"
    )


def _peer(transport: Transport) -> str:
    try:
        host, port = transport.remote
    except OSError:
        return "somebody who left"
    return f"{host}:{port}"
