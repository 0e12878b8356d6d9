"""Assembly: opens a port - a hub, and the parts that act on it.

Rules: the only file that knows both. Hubs are opened here and nowhere else.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Final, Never

from yarpy.config.configuration import port_number
from yarpy.contact import check_text
from yarpy.link.begin.admission import Gate
from yarpy.names.base import NameClient
from yarpy.names.node_name import Category
from yarpy.port.answer import admin, command
from yarpy.port.connect import disconnecting, reconnect
from yarpy.port.connection import ConnectionEvent
from yarpy.port.graph import Role, find_role
from yarpy.port.hub import Actions, Hub
from yarpy.port.keep import fork, log_forwarding
from yarpy.port.keep.registration import Registration
from yarpy.port.mailbox import Mailbox
from yarpy.port.options import wrong
from yarpy.route import Declared
from yarpy.scope import OPENING, Scope, apart, moment
from yarpy.wire.stream import DEFAULT_LIMIT

ACTIONS: Final = Actions(admin.answer, command.obey, disconnecting.close_output, reconnect)


@apart
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
    on_connection: Callable[[ConnectionEvent], object] | None = None,
    register: bool = True,
    directory: bool = False,
    category: Category = "",
    role: Role | None = None,
    declared: Declared | None = None,
    timeout: float | None = None,
    gate: Callable[[str], Gate] | None = None,
    **unknown: Never,
) -> Hub:
    """A hub that listens and is registered; parameters as `Hub` and `Registration`. `tcp_port` 0 is
    any free one, or the one that the environment names for this port.

    A port whose name is that of a topic (`/topic@/node`), or that is given a `role`, joins the
    graph of its node; `category` says what it does there where its name does not. `declared`: what
    it says of itself in other systems. `timeout`: seconds for all of it, else OPENING. `gate`: as
    in PortOptions.

    Raises AddressError (name unusable, name or port in use), NoNameServer.
    """
    if unknown:
        raise wrong(unknown)
    if on_connection is not None and not callable(on_connection):
        raise TypeError(f"on_connection is a function of one argument, not {on_connection!r}")
    check_text(name)
    fork.prepare()
    role = role or find_role(name, category, port_type, names)
    if role is not None:
        name, names, declared = role.port_name, role.names, role.declared
        register = register and names is not None
    hub = Hub(
        Registration(name, names, port_type, register, renamed=role is not None),
        mailbox,
        ACTIONS,
        admits_outputs=admits_outputs,
        rpc=rpc,
        limit=limit,
        input_limit=input_limit,
        directory=directory,
        gate=gate,
    )
    hub.callbacks.program.on_connection = on_connection
    if declared is not None:
        hub.registration.declared = declared
    with Scope(moment(OPENING if timeout is None else timeout)):
        hub.open(tcp_port or port_number(hub.name, os.environ), host)
        if role is not None:
            try:
                role.join(hub, open_hub)
            except BaseException:
                hub.close()
                raise
    log_forwarding.begin(open_hub)
    return hub
