"""The name server that commands talk to: the first of those in use."""

from __future__ import annotations

from yarpy.errors import LocalProtocolError
from yarpy.names.client import YarpNameClient
from yarpy.names.default import DEFAULT


def server() -> YarpNameClient:
    """The client of the first name server. Raises NoNameServer when none is configured."""
    found = DEFAULT.current()
    found = getattr(found, "clients", [found])[0]
    if not isinstance(found, YarpNameClient):
        raise LocalProtocolError("this takes a name server; start one with `yarpy server`")
    return found
