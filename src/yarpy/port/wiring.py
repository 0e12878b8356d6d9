"""Connecting and disconnecting a port of ours: errors for programs where `command` has lines for
people."""

from __future__ import annotations

import time

from yarpy.contact import parse_contact
from yarpy.data.text import plain_text
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    LoginRefused,
    UnknownName,
    UnknownPlugin,
    YarpError,
)
from yarpy.link.handshake import find_carrier
from yarpy.port import command, probe
from yarpy.port.hub import Hub
from yarpy.route import masked, parse_carrier

_POLL = 0.05


def connect(hub: Hub, target: str, carrier: str, timeout: float | None) -> None:
    """Connect `hub` to `target`; see Port.connect."""
    wanted = parse_contact(target)
    if wanted.reachable and ":/" in target:
        carrier = wanted.carrier  # as with names, what is written in front of it counts
    kind = find_carrier(parse_carrier(carrier).base)
    text = target if wanted.carrier and not wanted.reachable else command.joined(target, carrier)
    deadline = None if timeout is None else time.monotonic() + timeout
    while True:
        try:
            command.connect(hub, text)
            return
        except command.Refused as error:
            # A camera locks those out who try a wrong password again and again.
            final = isinstance(error.__cause__, LoginRefused)
            if final or deadline is None or time.monotonic() >= deadline:
                raise explained(hub, target, kind.name, error) from error.__cause__
        time.sleep(_POLL)


def disconnect(hub: Hub, target: str) -> bool:
    """End what `connect` has made, whichever way the messages go; see Port.disconnect."""
    wanted = parse_contact(target)
    name = wanted.name or f"/{wanted.address}/"
    found, _ = command.disconnect_output(hub, name)
    for link in hub.inputs:
        if link.route.source == name and not link.carrier.push:
            command.close_input(hub, link)
            found = True
    return found


def explained(hub: Hub, target: str, carrier: str, error: command.Refused) -> YarpError:
    """The error of the tree that fits a refusal."""
    cause, line, target = error.__cause__, str(error), masked(target)
    if isinstance(cause, UnknownPlugin):
        return cause
    if isinstance(cause, LoginRefused):
        return LoginRefused(f'"{hub.name}" is not admitted to "{target}": {cause}')
    if line.startswith("Do not know"):
        return unknown(target, hub.service())
    if line.startswith("Cannot connect"):
        return LinkClosed(
            f'"{hub.name}" cannot connect to "{target}" over {carrier}: {cause or "no answer"}'
        )
    return LocalProtocolError(f'"{hub.name}" cannot connect to "{target}": {line}')


def unknown(name: str, names: object) -> UnknownName:
    """The error for a name that nobody knows, with the nearest one that somebody does."""
    from difflib import get_close_matches

    near: list[str] = []
    try:
        known = [contact.name for contact in names.list()]  # type: ignore[attr-defined]
        near = get_close_matches(name, known, n=1)
    except (YarpError, AttributeError):
        pass
    hint = f'did you mean "{near[0]}"?' if near else "is its program running?"
    return UnknownName(f'no port "{name}" is registered: {hint} (`yarpy name list` shows all)')


def subscribe(hub: Hub, source: str, carrier: str) -> None:
    """Ask the port `source` to send to `hub`; see BasePort.listen_to."""
    contact = parse_contact(source)
    if not contact.reachable:
        names = hub.service()
        found = names.query(contact.name) if names is not None else None
        if found is None:
            raise unknown(source, names)
        contact = found
    if not find_carrier(parse_carrier(carrier).base).push:
        connect(hub, source, carrier, None)
        return
    target = hub.name if hub.registration.registered else f"/{hub.contact.address}"
    reply = probe.ask(contact, ["add", command.joined(target, carrier)], secret_=hub.key)
    if not reply or reply[0] != 0:
        text = plain_text(reply[1]).strip() if len(reply) > 1 else "no answer"
        raise LocalProtocolError(f'"{source}" does not send to "{hub.name}": {text}')
