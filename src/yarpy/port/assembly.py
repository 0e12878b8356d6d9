"""Assembly: opens a port - a hub, and everybody who acts on it.

Rules: the only file that knows both. Hubs are opened here and nowhere else.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Final

from yarpy.config.configuration import port_number
from yarpy.names.base import NameClient
from yarpy.port import admin, command, disconnecting, fork, reconnect
from yarpy.port.connection import ConnectionEvent
from yarpy.port.hub import Crew, Hub
from yarpy.port.mailbox import Mailbox
from yarpy.port.registration import Registration
from yarpy.wire.stream import DEFAULT_LIMIT

CREW: Final = Crew(admin.answer, command.obey, disconnecting.close_output, reconnect)


def open_hub(
    name: str,
    mailbox: Mailbox,
    names: NameClient | None = None,
    *,
    tcp_port: int = 0,
    host: str = "",
    port_type: str = "",
    admits_outputs: bool = True,
    rpc: bool = False,
    limit: int = DEFAULT_LIMIT,
    on_connection: Callable[[ConnectionEvent], None] | None = None,
    register: bool = True,
) -> Hub:
    """A hub that listens and is registered; parameters as `Hub` and `Registration`. `tcp_port` 0 is
    any free one, or the one that the environment names for this port.

    Raises AddressError (name unusable, name or port in use), NoNameServer.
    """
    fork.prepare()
    hub = Hub(
        Registration(name, names, port_type, register),
        mailbox,
        CREW,
        admits_outputs=admits_outputs,
        rpc=rpc,
        limit=limit,
    )
    hub.callbacks.on_connection = on_connection
    hub.open(tcp_port or port_number(hub.name, os.environ), host)
    return hub
