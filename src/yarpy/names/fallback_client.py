"""Several name services used as one, in order of preference.

Rules: a port is registered in all, the first one completes the address and
the others get it complete; a query goes through them until one knows the name; everything else is
asked of the first. The first one must answer, the others may be down.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from yarpy.contact import Contact
from yarpy.errors import AddressError, NoNameServer
from yarpy.names.base import Contacts, Medium, NameClient, Strings, Values, introduce


def _warn(message: str, *arguments: object) -> None:
    from yarpy.log import logger  # late: most programs have nothing to warn of

    logger("yarpy.names").warning(message, *arguments)


class SeveralNames:
    """A `NameClient` made of others."""

    def __init__(self, clients: Sequence[NameClient]) -> None:
        if not clients:
            raise AddressError("SeveralNames needs at least one name client")
        self.clients = tuple(clients)

    @property
    def allocates(self) -> bool:
        return self.clients[0].allocates

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        port_type: str | None = None,
    ) -> Contact:
        contact = self.clients[0].register(name, carrier, host, port, port_type)
        for client in self.clients[1:]:
            try:
                client.register(
                    contact.name, contact.carrier, contact.host, contact.port, port_type
                )
            except (NoNameServer, AddressError) as error:
                _warn('"%s" is not registered everywhere: %s', contact.name, error)
        return contact

    def unregister(self, name: str) -> None:
        missing: NoNameServer | None = None
        for client in reversed(self.clients):
            try:
                client.unregister(name)
            except NoNameServer as error:
                missing = error
                if client is not self.clients[0]:
                    _warn('"%s" is not unregistered everywhere: %s', name, error)
                    missing = None
        if missing is not None:
            raise missing

    def query(self, name: str) -> Contact | None:
        """Return the address of `name`. Raises NoNameServer if a service was down and no other knew
        the name."""
        missing: NoNameServer | None = None
        for client in self.clients:
            try:
                contact = client.query(name)
            except NoNameServer as error:
                missing = missing or error
                continue
            if contact is not None:
                return contact
        if missing is not None:
            raise missing
        return None

    def announce(self, name: str, ok: bool = True) -> None:
        self.clients[0].announce(name, ok)

    def set(self, name: str, key: str, *values: str | int | float) -> Strings:
        return self.clients[0].set(name, key, *values)

    def introduce(self, name: str, properties: Mapping[str, Values]) -> None:
        introduce(self.clients[0], name, properties)

    def get(self, name: str, key: str) -> Strings:
        return self.clients[0].get(name, key)

    def list(self, prefix: str | None = None) -> Contacts:
        return self.clients[0].list(prefix)

    def close(self) -> None:
        for client in self.clients:
            client.close()

    def listen(self, port: int, welcome: Callable[[Any], object]) -> Callable[[], None]:
        """Let a port be called through all that can do so."""
        stops = [one.listen(port, welcome) for one in self.clients if isinstance(one, Medium)]

        def stop() -> None:
            for each in stops:
                each()

        return stop
