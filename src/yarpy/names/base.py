"""The contract of a name service with ports, which are written against this and nothing else.

Rules: a client may be used from any thread. `NoNameServer` means that no server answered; an
unknown name is None, not an error.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol, runtime_checkable

from yarpy.contact import Contact

# A class with a method called `list` cannot spell this type inside its body.
Contacts = list[Contact]
Strings = list[str]
Values = Sequence[str | int | float]


@runtime_checkable
class NameClient(Protocol):
    """A name service as seen by its users.

    `allocates`: whether `register` hands out port numbers. If not, listen first on a number of the
    system's choice and register with host and port. Either way, a registration that names
    host and port is kept as it is.
    """

    @property
    def allocates(self) -> bool: ...

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        port_type: str | None = None,
    ) -> Contact:
        """Register `name` and return its complete contact; the service fills in what is None.

        name: `...` asks for a temporary name. A port that had the name before loses it.
        Raises AddressError when the service refuses, NoNameServer when nobody answers.
        """
        ...

    def unregister(self, name: str) -> None:
        """Unregister `name`; unknown names are ignored."""
        ...

    def query(self, name: str) -> Contact | None:
        """Return the address of `name`, or None when the service does not know it."""
        ...

    def announce(self, name: str, ok: bool = True) -> None:
        """Report that `name` listens now (persistent connections start), or does not answer."""
        ...

    def set(self, name: str, key: str, *values: str | int | float) -> Strings:
        """Replace the values of a property; returns them as stored, [] for an unknown name."""
        ...

    def get(self, name: str, key: str) -> Strings:
        """The values of a property, sorted; [] for an unknown name or key."""
        ...

    def list(self, prefix: str | None = None) -> Contacts:
        """Return all ports, or those at and below `prefix`, by name."""
        ...

    def close(self) -> None:
        """Close the connections; the client may be used again."""
        ...


@runtime_checkable
class Medium(Protocol):
    """A name service through which ports can be called as well, where there is no other way."""

    def listen(self, port: int, welcome: Callable[[Any], object], /) -> Callable[[], None]:
        """Let the port with that TCP port number be called: `welcome` gets each connection, a
        transport, in a thread of its own. Returns what ends that."""
        ...


@runtime_checkable
class Foreign(Protocol):
    """A name service of another system, which is no name server of YARP's.

    title: "names on Zenoh". instead: what those do who want a topic or a persistent connection,
    which only a name server keeps. hint: what to do where nobody answers. A plug-in of the group
    `yarpy.names` is called with what the configuration says, `open_names(host, port, namespace)`,
    with "" and 0 for the usual place, and returns a NameClient that is this, too.
    """

    title: str
    instead: str
    hint: str

    def place(self) -> str:
        """Return where it is, for people. Raises NoNameServer."""
        ...

    def address(self) -> tuple[str, int]:
        """Return what a configuration file says of where it is: a host and a number."""
        ...

    def alive(self) -> bool:
        """Return whether it can be used now."""
        ...

    def line(self, contact: Contact) -> str:
        """Return how `yarpy name list` shows an entry."""
        ...


def introduce(names: NameClient, name: str, properties: Mapping[str, Values]) -> None:
    """Set properties of `name`, then announce it: at once, if the service has such a method."""
    at_once = getattr(names, "introduce", None)
    if at_once is not None:
        at_once(name, properties)
        return
    for key, values in properties.items():
        names.set(name, key, *values)
    names.announce(name)
