"""The name service that a port uses when it is given none.

Rules: the innermost open `NameServer` or `LocalNames` of this process, else what `YARPY_SERVER` or
the configuration files say. The files are read again at every lookup, so a server that was
configured later is found; clients are kept, with their connections.
"""

from __future__ import annotations

import os
import socket

from yarpy import fork
from yarpy.carriers.auth import prove_initiator
from yarpy.config.configuration import YARP, Server, configuration
from yarpy.config.resource import find_file
from yarpy.data.text import plain_text
from yarpy.errors import AddressError, NoNameServer
from yarpy.names.address import local_addresses
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.names.fallback_client import SeveralNames
from yarpy.wire.stream import ByteStream


class DefaultNames:
    """The process's choice. There is one instance, `DEFAULT`, since all ports share it."""

    def __init__(self) -> None:
        self._stack: list[NameClient] = []
        self._servers: tuple[Server, ...] = ()
        self._configured: NameClient | None = None
        self._lock = fork.lock()  # ports are opened from any thread

    def push(self, client: NameClient) -> None:
        """Make `client` the default until `pop`."""
        with self._lock:
            self._stack.append(client)

    def pop(self, client: NameClient) -> None:
        """Undo `push`, in whatever order."""
        with self._lock:
            self._stack = [item for item in self._stack if item is not client]

    def current(self) -> NameClient:
        """The service to use now. Raises NoNameServer when none is configured."""
        with self._lock:
            if self._stack:
                return self._stack[-1]
            found = configuration(os.environ)
            servers = tuple(server for server in found.servers if server.mode != "local")
            if not servers:
                raise NoNameServer(
                    f"no name server is configured for {found.namespace}: start one with "
                    "`yarpy server`, find one with `yarpy detect --write`, say where it is with "
                    "`yarpy conf HOST PORT` or YARPY_SERVER=HOST:PORT, or use yarpy.LocalNames() "
                    "inside one program"
                )
            if servers != self._servers or self._configured is None:
                clients = [default_client(server) for server in servers]
                self._configured = clients[0] if len(clients) == 1 else SeveralNames(clients)
                self._servers = servers
            return self._configured


def default_client(server: Server) -> NameClient:
    """Return a client for a configured name service. Raises UnknownPlugin for one whose kind is
    not installed."""
    if server.mode == YARP:
        return client_of(server)
    from yarpy.registry import names

    client: NameClient = names.load(server.mode)(server.host, server.port, server.namespace)
    return client


def client_of(server: Server) -> YarpNameClient:
    """A client for one configured server, with this host's address and key taken into account."""
    return YarpNameClient(
        server.host, server.port, own_host=own_host(), prepare=prove if secret() else None
    )


def own_host() -> str:
    """The local address that `YARP_IP` chooses, "" if it chooses none."""
    prefix = os.environ.get("YARP_IP", "")
    return next((a for a in local_addresses() if a.startswith(prefix)), "") if prefix else ""


def secret() -> bytes:
    """The key of `auth.conf`, b"" if there is no such file: connections need no proof then.

    Raises AddressError for a file without a key: to go on in the open would be the wrong guess.
    """
    path = find_file("auth.conf")
    if path is None:
        return b""
    from yarpy.config.ini import read_ini  # late: few have such a file

    group = read_ini(path).group("AUTH")
    key = None if group is None else group.find("key")
    if key is None:
        raise AddressError(f"{path} has no key: write `[AUTH]` and below it `key SECRET`")
    return plain_text(key).encode()


def prove(connection: socket.socket) -> None:
    """Prove on a fresh socket that we know the key, before anything else is said."""
    stream = ByteStream()
    steps = prove_initiator(stream, secret())
    try:
        while True:
            next(steps)
            for piece in stream.take_output():
                connection.sendall(piece)
            view = stream.get_buffer()
            # Not a byte beyond the proof: what follows is for the next reader.
            count = connection.recv_into(view[: 40 - stream.waiting])
            stream.buffer_updated(count) if count else stream.feed_eof()
    except StopIteration:
        for piece in stream.take_output():
            connection.sendall(piece)


DEFAULT = DefaultNames()
