"""Ports that a command opens, and what it connects them to.

Rules: a name that lives is never taken away. `...` without a name server is a port without a name:
it can still be connected to addresses (`/host:port`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

import yarpy
from yarpy.cli import log, signals
from yarpy.cli.stderr import warn

if TYPE_CHECKING:
    from yarpy.names.node_name import Category
    from yarpy.port.base import BasePort

P = TypeVar("P", bound="BasePort")

ANY = "..."
_BESIDE: Final = 9  # programs of one kind, before any name will do


def open_port(kind: Callable[..., P], name: str, category: Category = "", **options: Any) -> P:
    """`kind(name, **options)`, with the library's log shown. Raises AddressError, NoNameServer.

    category: what the port does with a topic, if that is its name (`/topic@/node`).

    The port closes with the command, at the latest: also when a signal comes while it opens.
    """
    if not name:
        raise yarpy.AddressError(
            f"the name of the port is empty (an unset variable?): `{ANY}` stands for any free one"
        )
    log.show()
    name = _with_category(name, category)
    _check_type(options.get("port_type", ""))
    with signals.held():
        try:
            port = kind(name, **options)
        except yarpy.NoNameServer:
            if name != ANY:
                raise
            port = kind("", **options)
            warn(f"no name server: this port has no name, others reach it at /{port.address}")
        click.get_current_context().call_on_close(port.close)
    return port


def open_another(kind: Callable[..., P], base: str, **options: Any) -> P:
    """As `open_port` with the name `base`, or `base/2` and so on for those that run beside it; any
    without a name server."""
    for number in range(1, _BESIDE + 1):
        try:
            return open_port(kind, base if number == 1 else f"{base}/{number}", **options)
        except yarpy.AddressError:
            continue  # taken
        except yarpy.NoNameServer:
            break
    return open_port(kind, ANY, **options)


def _check_type(port_type: str) -> None:
    """Warn of a type of a package (`std_msgs/String`) that nobody has; others are only words."""
    if "/" not in port_type:
        return
    try:
        yarpy.idl.load(port_type)
    except yarpy.UnknownType as error:
        warn(str(error))
    except yarpy.UnknownPlugin:
        pass  # what could know it is not installed


def _with_category(name: str, category: Category) -> str:
    """The name of a port, with what it does if it is that of a topic."""
    from yarpy.names.node_name import parse_node_name

    found = parse_node_name(name) if category else None
    if found is None or found.category:
        return name
    return f"{found.having(category)}" + (f"~{found.type}" if found.type else "")


def send_to(port: BasePort, target: str, carrier: str = "") -> None:
    """Send what `port` writes to `target`, which may be decorated (`udp://x`, `topic://t`)."""

    if _registered(port):
        yarpy.connect(port.name, target, carrier)
    else:
        port.connect(target, carrier or _carrier(target))


def hear_from(port: BasePort, source: str, carrier: str = "") -> None:
    """Have `source`, which may be decorated, send to `port`."""

    if _registered(port):
        yarpy.connect(source, port.name, carrier)
    else:
        port.listen_to(source, carrier or _carrier(source))


def _registered(port: BasePort) -> bool:

    try:
        return yarpy.query(port.name) is not None
    except yarpy.NoNameServer:
        return False


def _carrier(text: str) -> str:
    from yarpy.contact import parse_contact

    return parse_contact(text).carrier
