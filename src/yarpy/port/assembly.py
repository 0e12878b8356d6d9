"""Assembly: opens a port - a hub, and the parts that act on it.

Rules: the only file that knows both. Hubs are opened here and nowhere else.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Final

from yarpy.config.configuration import port_number
from yarpy.contact import check_text
from yarpy.names.base import NameClient
from yarpy.names.node_name import Category
from yarpy.port import admin, command, disconnecting, fork, log_forwarding, reconnect
from yarpy.port.connection import ConnectionEvent
from yarpy.port.hub import Crew, Hub
from yarpy.port.mailbox import Mailbox
from yarpy.port.part import Part, find_part
from yarpy.port.registration import Registration
from yarpy.route import Declared
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
    input_limit: int | None = None,
    on_connection: Callable[[ConnectionEvent], None] | None = None,
    register: bool = True,
    directory: bool = False,
    category: Category = "",
    part: Part | None = None,
    declared: Declared | None = None,
) -> Hub:
    """A hub that listens and is registered; parameters as `Hub` and `Registration`. `tcp_port` 0 is
    any free one, or the one that the environment names for this port.

    A port whose name is that of a topic (`/topic@/node`), or that is given a `part`, joins the
    graph of its node; `category` says what it does there where its name does not. `declared`: what
    it says of itself in other systems.

    Raises AddressError (name unusable, name or port in use), NoNameServer.
    """
    check_text(name)
    fork.prepare()
    part = part or find_part(name, category, port_type, names)
    if part is not None:
        name, names, declared = part.port_name, part.names, part.declared
        register = register and names is not None
    hub = Hub(
        Registration(name, names, port_type, register, renamed=part is not None),
        mailbox,
        CREW,
        admits_outputs=admits_outputs,
        rpc=rpc,
        limit=limit,
        input_limit=input_limit,
        directory=directory,
    )
    hub.callbacks.on_connection = on_connection
    if declared is not None:
        hub.registration.declared = declared
    hub.open(tcp_port or port_number(hub.name, os.environ), host)
    if part is not None:
        try:
            part.join(hub, open_hub)
        except BaseException:
            hub.close()
            raise
    log_forwarding.begin(open_hub)
    return hub
