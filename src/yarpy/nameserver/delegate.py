"""Delegates: name services of other systems that a name server tells of its ports, and asks.

Rules: contracts alone. A delegate is found by name (registry kind `delegates`): its plug-in is
called as `open_delegate(place, context)`, `place` being what the user says of where the other
system is, "" for the usual place; it has an attribute `about` for people. None of the methods waits
but `query`, which does so for a second or two at most, and `close`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.nameserver.command import NameService


@dataclass(frozen=True, slots=True)
class DelegateContext:
    """The server's side that a delegate may use: the `service`, the server's own `name` and `host`,
    and `obey`, which carries out a command."""

    service: NameService
    name: str
    host: str
    obey: Callable[[Bottle], None]


class Delegate(Protocol):
    """Stands between a name server and the names of another system."""

    about: str

    def registered(self, name: str) -> None:
        """Take note that a name was registered at the server, or its address changed."""

    def announced(self, name: str) -> None:
        """Take note that a port listens."""

    def unregistered(self, name: str) -> None:
        """Take note that a name is gone."""

    def query(self, name: str) -> Contact | None:
        """Return where a name is that the server does not know; None if nobody does."""

    def close(self) -> None:
        """Take back what was told, and end."""
