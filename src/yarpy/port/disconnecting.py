"""Disconnecting: ends connections of a port of ours, from either end and in good order.

Rules: every disconnection on request, by admin message, port command or API, comes through here.
The other side is told, so that it does not take the end for a failure and dial again.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Final

from yarpy.contact import Contact, parse_contact
from yarpy.errors import NoNameServer, YarpError
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.port import farewell, probe
from yarpy.port.hub import Hub

LAST_WORDS: Final = 0.5  # seconds for datagrams to arrive that were sent before the end


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
    """End one output in good order. A receiver that would not notice, or would dial us again, is
    asked to drop us."""
    known = hub.drop_output(link)
    pulled = not link.carrier.push and link.route.target.startswith("/")
    contact = None
    if known and (link.carrier.connectionless or pulled):
        contact = _receiver(hub, link.route.target)
        if contact is not None and contact.carrier != "tcp":
            contact = None
    if contact is not None:
        contact = replace(contact, name=link.route.peer or contact.name)
    if not pulled:
        if contact is not None:
            _ask_what_came(hub, link, contact)
        link.close()
    if contact is not None:
        try:
            probe.drop_input(contact, hub.name, secret_=hub.key)
        except (YarpError, OSError):
            pass  # gone already
    if pulled:
        link.close()


def _ask_what_came(hub: Hub, link: Outbound, contact: Contact) -> None:
    """Ask the receiver of datagrams, if it counts them, until all came or no more come."""
    link.wait_sent(LAST_WORDS)
    confirmation, left, came = link.sender.confirmation, link.counter.messages, -1
    deadline = time.monotonic() + LAST_WORDS
    try:
        while left and link.active and confirmation.witness and time.monotonic() < deadline:
            told = probe.connection(contact, "in", hub.name, hub.key)
            before, came = came, int(told.get("received", 0)) if told is not None else 0
            confirmation.told(left, came)
            if came >= left or came == before:
                return
            time.sleep(0.02)
    except LookupError:
        confirmation.told(left, left)  # it lives, and does not count
    except (YarpError, OSError):
        pass  # gone already


def _receiver(hub: Hub, target: str) -> Contact | None:
    try:
        return hub.registration.locate(parse_contact(target))
    except YarpError:
        return None


def disconnect_output(hub: Hub, target: str) -> tuple[bool, str]:
    """Remove the outputs to `target`; whether there were any, and the line that says so."""
    tried = hub.crew.reconnect.give_up(hub, target, incoming=False)
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
    tried = hub.crew.reconnect.give_up(hub, source, incoming=True)
    found = [link for link in hub.inputs if link.route.source == source]
    if any(_dials_again(link) for link in found if not (by_sender and link.carrier.connectionless)):
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
    if _dials_again(link):
        _tell_sender(hub, link.route.source)
    link.close()


def _dials_again(link: Inbound) -> bool:
    """Whether its sender would take the end for a failure: not one that asks for it, nor one that
    was dialled by us."""
    return link.carrier.push and not link.asking


def _tell_sender(hub: Hub, source: str) -> None:
    """Let a sender know that we end the connection on purpose, so that it does not dial again."""
    try:
        farewell.ask_to_leave(hub.registration, source)
    except NoNameServer:
        pass  # it will notice by itself
