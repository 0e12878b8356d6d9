"""Names inside one process: a dictionary, for tests and programs without a name server.

Rules: hands out no port numbers (there is no range to manage): a port lets the system choose its
number, then registers with host and number. Multicast groups are still handed out, because no
operating system does. Every `LocalNames()` is a world of its own; give the same one to all ports
that are to find each other.
"""

from __future__ import annotations

from yarpy import fork
from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.names.base import Contacts, Strings
from yarpy.nameserver.store import NameStore


class LocalNames:
    """A `NameClient` without a server."""

    allocates = False

    def __init__(self) -> None:
        self._store = NameStore()
        self._lock = fork.lock()  # ports are opened and closed from any thread

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        port_type: str | None = None,
    ) -> Contact:
        if not port and carrier not in ("mcast", "topic"):
            raise AddressError(
                f'cannot register "{name}" without its port number: '
                "in-process names hand out none, so listen first and then register"
            )
        with self._lock:
            return self._store.register(
                name, carrier or "", host or "", port or 0, port_type or "", "127.0.0.1"
            )

    def unregister(self, name: str) -> None:
        with self._lock:
            self._store.unregister(name)

    def query(self, name: str) -> Contact | None:
        with self._lock:
            return self._store.query(name)

    def announce(self, name: str, ok: bool = True) -> None:
        """Nothing to do: there are no persistent connections without a server."""

    def set(self, name: str, key: str, *values: str | int | float) -> Strings:
        with self._lock:
            return self._store.assign(name, key, map(str, values)) or []

    def get(self, name: str, key: str) -> Strings:
        with self._lock:
            return self._store.values(name, key) or []

    def list(self, prefix: str | None = None) -> Contacts:
        with self._lock:
            return [*self._store.contacts(prefix or "")]

    def close(self) -> None:
        """Do nothing: there are no connections to close."""
