"""Disconnecting: ends connections of a port of ours, from either end and in good order.

Rules: every end that somebody asks for, by admin message, port command or API, comes through here.
The other side is told, so that it does not take the end for a failure and dial again.
"""

from __future__ import annotations

from dataclasses import replace

from yarpy.contact import Contact, parse_contact
from yarpy.errors import NoNameServer, YarpError
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.port import probe
from yarpy.port.hub import Hub


def disconnect(hub: Hub, target: str) -> bool:
    """End what connecting to `target` has made, whichever way the messages go; see
    Port.disconnect."""
    wanted = parse_contact(target)
    name = wanted.label
    found, _ = disconnect_output(hub, name)
    for link in hub.inputs:
        if link.route.source == name and not link.carrier.push:
            close_input(hub, link)
            found = True
    return found


def close_output(hub: Hub, link: Outbound) -> None:
    """End one output in good order; a connectionless one by asking its receiver to drop us."""
    known = hub.drop_output(link)
    link.close()
    if known and link.carrier.connectionless:
        contact = _receiver(hub, link.route.target)
        if contact is not None:
            contact = replace(contact, name=link.route.peer or contact.name)
            try:
                probe.drop_input(contact, hub.name, secret_=hub.key)
            except (YarpError, OSError):
                pass  # gone already


def _receiver(hub: Hub, target: str) -> Contact | None:
    try:
        return hub.registration.locate(parse_contact(target))
    except YarpError:
        return None


def disconnect_output(hub: Hub, target: str) -> tuple[bool, str]:
    """Remove the outputs to `target`; whether there were any, and the line that says so."""
    tried = hub.crew.repair.give_up(hub, target, incoming=False)
    found = [link for link in hub.outputs if link.route.target == target]
    for link in found:
        close_output(hub, link)
    if found or tried:
        return True, f"Removed connection from {hub.name} to {target}"
    return False, f"Could not find an outgoing connection to {target}"


def disconnect_input(hub: Hub, source: str, by_sender: bool = False) -> tuple[bool, str]:
    """Remove the inputs from `source`; whether there were any, and the line that says so.

    `by_sender`: in the way in which senders of datagrams say goodbye, so they need not be told.
    """
    tried = hub.crew.repair.give_up(hub, source, incoming=True)
    found = [link for link in hub.inputs if link.route.source == source]
    told = [link for link in found if link.asking or (by_sender and link.carrier.connectionless)]
    if len(told) < len(found):
        _tell_sender(hub, source)
    for link in found:
        link.close()
    for link in found:
        if link.thread is not None and not link.asking:
            link.thread.join(2.0)
    if found or tried:
        return True, f"Removing connection from {source} to {hub.name}"
    return False, f"Could not find an incoming connection from {source}"


def close_input(hub: Hub, link: Inbound) -> None:
    """End one input from our side."""
    if not link.asking:
        _tell_sender(hub, link.route.source)
    link.close()


def _tell_sender(hub: Hub, source: str) -> None:
    """Let a sender know that we end the connection on purpose, so that it does not dial again."""
    try:
        hub.ask_to_leave(source)
    except NoNameServer:
        pass  # it will notice by itself
