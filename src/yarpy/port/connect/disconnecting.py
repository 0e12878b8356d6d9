"""Disconnecting: ends connections of a port of ours, from either end and in good order.

Rules: every disconnection on request, by admin message, port command or API, comes through here.
The other side is told, so that it does not take the end for a failure and dial again.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Final

from yarpy import scope
from yarpy.callback_thread import waited_by
from yarpy.contact import Contact, parse_contact
from yarpy.errors import NoNameServer, YarpError
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.port.connect import goodbye, probe
from yarpy.port.hub import Hub
from yarpy.threads import Thread

log = logger("yarpy.port")

LAST_WORDS: Final = 0.5  # seconds for datagrams to arrive that were sent before the end


def disconnect(hub: Hub, target: str) -> bool:
    """End what connecting to `target` has made, whichever way the messages go; see
    Port.disconnect."""
    wanted = parse_contact(target)
    name = wanted.label
    found, _ = disconnect_output(hub, name)
    for link in hub.inputs.links:
        if link.route.source == name and not link.carrier.push:
            close_input(hub, link)
            found = True
    return found


def close_output(hub: Hub, link: Outbound) -> None:
    """End one output in good order. A receiver that would not notice, or would dial us again, is
    asked to drop us."""
    try:
        _close_output(hub, link)
    except BaseException:  # out of a signal handler: nobody else knows the connection any more
        link.sender.fail()
        raise


def _close_output(hub: Hub, link: Outbound) -> None:
    counter = link.counter
    drops, unconfirmed = counter.drops, counter.unconfirmed
    _take_leave(hub, link)
    lost, unsure = counter.drops - drops, counter.unconfirmed - unconfirmed
    if link.carrier.delivery.connectionless:
        unsure = 0  # a reader that is closing answers nobody who asks how many datagrams came
    elif link.left:
        unsure = 0  # a reader that goes by itself wants no more, such as a page that is closed
    if (lost or unsure) and not (link.log or link.carrier.delivery.lossy):
        log.warning(
            "%s: %s did not take all that was written before the connection was closed: %d "
            "messages are lost, %d may have arrived or not",
            hub.name,
            link.route.target,
            lost,
            unsure,
        )


def _take_leave(hub: Hub, link: Outbound) -> None:
    known = hub.outputs.drop(link)
    pulled = not link.carrier.push and link.route.target.startswith("/")
    contact = None
    if known and (link.carrier.delivery.connectionless or pulled):
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
    link.wait_sent(time.monotonic() + min(LAST_WORDS, scope.remaining()))
    confirmation, left, came = link.sender.confirmation, link.counter.messages, -1
    deadline = time.monotonic() + min(LAST_WORDS, scope.remaining())
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
    tried = hub.actions.reconnect.give_up(hub, target, incoming=False)
    found = [link for link in hub.outputs.links if link.route.target == target]
    for link in found:
        close_output(hub, link)
    if found or tried:
        return True, f"Removed connection from {hub.name} to {target}"
    return False, f"Could not find an outgoing connection to {target}"


def disconnect_input(hub: Hub, source: str, by_sender: bool = False) -> tuple[bool, str]:
    """Remove the inputs from `source`; whether there were any, and the line that says so.

    `by_sender`: in the way in which senders of datagrams say goodbye, so they need not be told.
    """
    tried = hub.actions.reconnect.give_up(hub, source, incoming=True)
    found = [link for link in hub.inputs.links if link.route.source == source]
    if by_sender and not tried:  # it may be ending by itself just now
        hub.actions.reconnect.over(hub, source)
    for link in found:
        link.foresee_end()
    try:
        if any(
            _dials_again(link)
            for link in found
            if not (by_sender and link.carrier.delivery.connectionless)
        ):
            _tell_sender(hub, source)
    finally:
        for link in found:
            link.close()
    for link in found:
        if link.thread is not None and not link.asking:
            link.thread.join(min(2.0, scope.remaining()))
    if found or tried:
        return True, f"Removing connection from {source} to {hub.name}"
    return False, f"Could not find an incoming connection from {source}"


def close_input(hub: Hub, link: Inbound) -> None:
    """End one input from our side. In a callback, that happens when it returns: the connection's
    own thread has to answer the sender's goodbye."""
    if link.thread is waited_by() and not link.asking:
        name = f"yarpy close {link.route}"
        Thread(target=_end_input, args=(hub, link), name=name, daemon=True).start()
    else:
        _end_input(hub, link)


def _end_input(hub: Hub, link: Inbound) -> None:
    link.foresee_end()
    try:
        if _dials_again(link):
            _tell_sender(hub, link.route.source)
    finally:
        link.close()


def _dials_again(link: Inbound) -> bool:
    """Return whether the sender of an input would take the end for a failure: not one that asks for
    it, nor one that was dialled by us."""
    return link.carrier.push and not link.asking


def _tell_sender(hub: Hub, source: str) -> None:
    """Let a sender know that we end the connection on purpose, so that it does not dial again."""
    try:
        goodbye.ask_to_leave(hub.registration, source)
    except NoNameServer:
        pass  # it will notice by itself
