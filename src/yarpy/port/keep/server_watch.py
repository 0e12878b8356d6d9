"""Name servers that went away and came back: a restarted one is told the names of our ports again.

Rules: a server is watched through an idle connection, whose end tells that the server went away;
it is replaced before the server lets it go for its silence. `look` waits for nobody: dialling a
server, and telling it names, is done in a short-lived thread.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Sequence
from functools import partial
from typing import Final

from yarpy.errors import YarpError
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.names.fallback_client import SeveralNames
from yarpy.port.connect.dialling import Attempts
from yarpy.port.hub import Hub

log = logger("yarpy.port")

RENEW: Final = 40.0  # seconds; a server of yarpy lets a silent connection go after 60
RENEW_PROVED: Final = 5.0  # ... and one that has proved its key after 10


class ServerWatch:
    """The name servers of all ports."""

    def __init__(self) -> None:
        self._watched: dict[int, _Watched] = {}
        self._attempts = Attempts("dial name server")
        self._hubs: Sequence[Hub] = ()

    def look(self, hubs: Sequence[Hub]) -> bool:
        """See whether a server of these ports went away, or came back; whether one is away."""
        self._hubs = hubs
        servers = {id(client): client for hub in hubs for client in _servers(hub.names)}
        for number in self._watched.keys() - servers.keys():
            self._watched.pop(number).forget()
        for number, client in servers.items():
            server = self._watched.setdefault(number, _Watched(client))
            if not server.is_there() or server.is_old():
                self._attempts.begin(client.address, partial(self._dial, server))
        return any(server.away for server in self._watched.values())

    def forget(self) -> None:
        """There are no ports any more, or none of this process."""
        while self._watched:
            self._watched.popitem()[1].forget()

    def _dial(self, server: _Watched) -> None:
        try:
            fresh = server.client.connect()
        except YarpError:
            return  # it is still away
        away = server.away
        if server.returned(fresh):
            if away:
                log.warning("the name server at %s is back", server.client.address)
            self._register_again(server.client, away)

    def _register_again(self, client: YarpNameClient, describe: bool) -> None:
        for hub in self._hubs:
            registration = hub.registration
            if hub.life.closing or not registration.registered or client not in _servers(hub.names):
                continue  # a port without a name of its own is in no list
            # One that closes gives its name back behind this: the program may end then.
            with registration.again:
                if not hub.life.closing:
                    _register(hub, client, describe)


class _Watched:
    """One name server, and the idle connection to it."""

    def __init__(self, client: YarpNameClient) -> None:
        self.client = client
        self.away = False  # it was there, and is not any more
        self._forgotten = False
        self._connection: socket.socket | None = None
        self._since = 0.0  # when that was made

    def is_there(self) -> bool:
        """Return whether the connection to the server still stands."""
        connection = self._connection
        if connection is None:
            return False
        try:
            connection.setblocking(False)
            if connection.recv(1, socket.MSG_PEEK):
                return True
        except BlockingIOError:
            return True
        except OSError:
            pass
        if self._connection is not connection:
            return True  # replaced meanwhile
        log.warning("the name server at %s went away", self.client.address)
        self.away = True
        connection.close()
        self._connection = None
        return False

    def is_old(self) -> bool:
        """Return whether the connection is to be replaced."""
        limit = RENEW_PROVED if self.client.proves_key else RENEW
        return time.monotonic() - self._since > limit

    def returned(self, connection: socket.socket) -> bool:
        """Note that the server was reached; return whether it may lack our names: it had been away,
        or is watched only from now on, and what came before was not seen."""
        old, self._connection = self._connection, connection
        self._since = time.monotonic()
        if old is not None:
            old.close()
        if self._forgotten:  # by another thread: one of the two sees what the other one did
            connection.close()
            return False
        lacking, self.away = self.away or old is None, False
        return lacking

    def forget(self) -> None:
        """It is not watched any more."""
        self._forgotten = True
        connection = self._connection
        if connection is not None:
            connection.close()


def _register(hub: Hub, client: YarpNameClient, describe: bool) -> None:
    registration, contact = hub.registration, hub.contact
    try:
        known = client.query(hub.name)
        if known is None or (known.host, known.port) != (contact.host, hub.port):
            client.register(hub.name, "tcp", contact.host, hub.port, registration.type or None)
        elif not describe:
            return
        registration.describe(client)
        if hub.life.closing:  # meanwhile: it may have been too long for whoever closes it
            registration.give_back()
    except YarpError as error:
        log.warning("%s could not be registered again: %s", hub.name, error)


def _servers(names: NameClient | None) -> list[YarpNameClient]:
    """The name servers that a name service asks."""
    if isinstance(names, SeveralNames):
        return [client for each in names.clients for client in _servers(each)]
    return [names] if isinstance(names, YarpNameClient) else []
