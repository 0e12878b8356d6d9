"""The name services that commands talk to: the first of those in use, and all of them."""

from __future__ import annotations

from yarpy.errors import LocalProtocolError
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.names.default import DEFAULT


def server() -> YarpNameClient:
    """The client of the first name server. Raises NoNameServer when none is configured."""
    found = services()[0]
    if not isinstance(found, YarpNameClient):
        raise LocalProtocolError("this takes a name server; start one with `yarpy server`")
    return found


def services() -> list[NameClient]:
    """Return the name services in use, in their order. Raises NoNameServer when none is
    configured."""
    found = DEFAULT.current()
    return [*getattr(found, "clients", [found])]
