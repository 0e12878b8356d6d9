"""Port commands: what connects and disconnects a port, in the words that telnet users see.

Rules: every change of connections that somebody asks for, by admin message, port command or API,
comes through `connect`, `disconnect_output` or `disconnect_input`; each returns the line C++ YARP
says.
"""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from typing import Final

from yarpy.contact import Contact, parse_contact
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    LoginRefused,
    NoNameServer,
    PortClosed,
    RemoteProtocolError,
    Timeout,
    UnknownPlugin,
    YarpError,
)
from yarpy.link.handshake import find_carrier, greet
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.names.address import is_loopback
from yarpy.port import probe
from yarpy.port.hub import Hub
from yarpy.route import CarrierSpec, Route, masked, parse_carrier
from yarpy.wire.message import Message

NOT_ADMITTED: Final = "Not admitted to"  # how a line begins that tells of a password
JOINING: Final = 0.5  # seconds for a receiver to join a multicast group
HELP = (
    "This is a YARP port.  Here are the commands it responds to:",
    "*       Gives a description of this port",
    "d       Signals the beginning of input for the port's owner",
    'do      The same as "d" except replies should be suppressed ("data-only")',
    "q       Disconnects",
    "r       Reverse connection type to be a reader",
    "/port   Requests to send output to /port",
    "!/port  Requests to stop sending output to /port",
    "~/port  Requests to stop receiving input from /port",
    "a       Signals the beginning of an administrative message",
    "?       Gives this help",
)
NOT_UNDERSTOOD = (
    "Port command not understood.",
    "Type d to send data to the port's owner.",
    "Type ? for help.",
)


class Refused(YarpError):
    """A connection cannot be made; the text is C++'s line, `__cause__` knows more."""


def obey(hub: Hub, link: Inbound, message: Message) -> list[str]:
    """Carry out a port command that came over `link`; the lines to answer a person with."""
    key, rest = message.key, message.text
    if key == "/":
        try:
            return [connect(hub, "/" + rest)]
        except Refused as error:
            return [str(error)]
    if key == "!":
        return [disconnect_output(hub, rest)[1]]
    if key == "~":
        asked_for_itself = link.route.source == rest
        _, line = disconnect_input(hub, rest, by_sender=True)
        return [] if asked_for_itself else [line]
    if key == "*":
        return describe(hub)
    if key in ("?", "h"):
        return [*HELP]
    return [*NOT_UNDERSTOOD]


def describe(hub: Hub) -> list[str]:
    """What a port says of itself and its connections."""
    lines = [f"This is {hub.name} at tcp://{hub.contact.host}:{hub.port}/"]
    for output in hub.outputs:
        route = output.route
        lines.append(
            f"There is an output connection from {hub.name} to {route.target} using {route.carrier}"
        )
    if not hub.outputs:
        lines.append("There are no outgoing connections")
    for link in hub.inputs:
        route = link.route
        lines.append(
            f"There is an input connection from {route.source} to {hub.name} using {route.carrier}"
        )
    if not hub.inputs:
        lines.append("There are no incoming connections")
    return lines


def connect(hub: Hub, text: str, timeout: float | None = None) -> str:
    """Connect `hub` to the destination `text` (`/name`, `carrier://name`, `/host:port`).

    An existing connection to the same port is replaced. Raises Refused.
    """
    shown = masked(text)
    try:
        wanted = parse_contact(text)
    except AddressError as error:
        raise Refused(f"Do not know how to connect to {shown}") from error
    spec = parse_carrier(wanted.carrier or "tcp")
    contact = locate(hub, wanted)
    if contact is None:
        raise Refused(f"Do not know how to connect to {shown}")
    target = wanted.name or f"/{wanted.address}/"
    with hub.dialling.alone(target):
        return _connect(hub, shown, contact, target, spec)


def _connect(hub: Hub, text: str, contact: Contact, target: str, spec: CarrierSpec) -> str:
    """The rest of `connect`, while nobody else dials the target."""
    hub.crew.repair.give_up(hub, target)
    if contact.name:
        for old in hub.outputs:
            if old.route.target == target:
                close_output(hub, old)
    try:
        kind = find_carrier(spec.base)
    except UnknownPlugin as error:
        raise Refused(f"Cannot connect to {text}") from error
    if spec.log not in (None, "in"):
        raise Refused(f"Logger configured as log.{spec.log}, but only log.in is supported")
    if kind.push and spec.log is None:
        if not hub.admits_outputs:
            raise Refused("Outputs not allowed")
        if hub.rpc and any(map(_asks, hub.outputs)):
            raise Refused("RPC output already connected")
    unheard = spec.recv if kind.push else spec.send
    if unheard and (kind.foreign or not kind.introduces):
        raise Refused(
            f"{kind.name} does not tell the {'receiver' if kind.push else 'sender'} of "
            f"{', '.join(name for name, _ in unheard)}: take another carrier, or attach it to "
            "that port by the administrative message atch"
        )
    open_output(hub, contact, target, spec, text)
    line = f"Added connection from {hub.name} to {text}"
    if spec.log == "in":
        line += f"; {hub.name} will forward messages and replies (if any) to {target}"
    return line


def _asks(link: Outbound) -> bool:
    """Whether an output is one that questions go to; not those of loggers and onlookers."""
    return not link.log and not link.carrier.lossy


def open_output(hub: Hub, contact: Contact, target: str, spec: CarrierSpec, text: str = "") -> None:
    """Dial `contact` and take the connection in. Raises Refused."""
    route = Route(hub.name, target, spec, contact.port)
    try:
        chain = hub.monitoring.outgoing(route)
    except YarpError as error:
        raise Refused(f"Cannot connect to {text or target}: {error}") from error
    try:
        try:
            driver, speaker = greet(
                contact, route, key=hub.key, group=hub.registration.group, limit=hub.limit
            )
        except (LinkClosed, Timeout):
            other = _other_address(hub, contact)
            if other is None:
                raise
            driver, speaker = greet(
                other, route, key=hub.key, group=hub.registration.group, limit=hub.limit
            )
            contact = other
    except (YarpError, OSError) as error:
        if chain is not None:
            chain.close()
        _complain(hub, target, error)
        if isinstance(error, LoginRefused):
            raise Refused(f"{NOT_ADMITTED} {text or target}: {error}") from error
        line = f"Cannot connect to {text or target}"
        if isinstance(error, LocalProtocolError | RemoteProtocolError):
            line += f": {error}"  # they met, and one of them knows what to change
        raise Refused(line) from error
    if speaker.push:
        if speaker.broadcast:
            _wait_for_member(hub, contact, speaker.name)
        link = Outbound(driver, speaker)
        link.chain = chain
        if spec.recv:
            _wait_for_member(hub, contact, speaker.name)
            if link.ended():
                if chain is not None:
                    chain.close()
                monitors = ", ".join(name for name, _ in spec.recv)
                reason = f'"{target}" hung up: its log tells what is wrong with {monitors} there'
                raise Refused(f"Cannot connect to {text or target}: {reason}") from LinkClosed(
                    reason
                )
        try:
            hub.add_output_link(link)
        except PortClosed as error:
            if chain is not None:
                chain.close()
            raise Refused(f"Cannot connect to {text or target}") from error
    else:
        # Who dials a pull carrier is the one that receives.
        route.source, route.target = target, hub.name
        source = Inbound(hub, driver, speaker)
        try:
            hub.take_input(source)
        except YarpError as error:
            raise Refused(f"Cannot connect to {text or target}: {error}") from error
        threading.Thread(target=hub.serve_input, args=(source,), daemon=True).start()


def _wait_for_member(hub: Hub, contact: Contact, carrier: str) -> None:
    """Wait until the receiver says that it has our connection.

    It does not say so by itself: a multicast greeting has no answer, and the first messages would
    miss it; and what rides on its end is looked at after the greeting was answered.
    """
    deadline = time.monotonic() + JOINING
    question = [Vocab("list"), Vocab("in"), hub.name]
    try:
        while time.monotonic() < deadline:
            input_ = probe.ask(contact, question, timeout=JOINING, secret_=hub.key)
            if parse_carrier(plain_text(input_.find("carrier", ""))).base == carrier:
                return
            time.sleep(0.002)
    except (YarpError, OSError):
        pass  # a receiver that answers no questions


def _other_address(hub: Hub, contact: Contact) -> Contact | None:
    """Where else a port on a host with several networks can be reached from here, if anywhere.

    It told the name server all its addresses; whoever answers there has to have the right name.
    """
    names = hub.service()
    if names is None or not contact.name:
        return None
    try:
        addresses = names.get(contact.name, "ips")
    except YarpError:
        return None
    for address in addresses:
        other = replace(contact, host=address)
        if address == contact.host or is_loopback(address):
            continue
        if probe.is_alive(other, hub.key):
            return other
    return None


def _complain(hub: Hub, target: str, error: Exception) -> None:
    """Tell the name service about a registered port that nobody answers for."""
    names = hub.service()
    if names is None or not isinstance(error, LinkClosed):
        return
    try:
        names.announce(target, False)
    except YarpError:
        pass  # it is not our business to be heard


def locate(hub: Hub, wanted: Contact) -> Contact | None:
    """Where a destination is; None if no name service knows. Raises Refused if none answers."""
    if wanted.reachable:
        return wanted
    names = hub.service() if wanted.name.startswith("/") else None
    if names is None:
        return None
    try:
        return names.query(wanted.name)
    except YarpError as error:
        raise Refused(f"Cannot connect to {wanted.name}") from error


def close_output(hub: Hub, link: Outbound) -> None:
    """End one output in good order; a connectionless one by asking its receiver to drop us."""
    known = hub.drop_output(link)
    link.close()
    if known and link.carrier.connectionless:
        contact = _receiver(hub, link.route.target)
        if contact is not None:
            try:
                probe.drop_input(contact, hub.name, secret_=hub.key)
            except (YarpError, OSError):
                pass  # gone already


def _receiver(hub: Hub, target: str) -> Contact | None:
    try:
        return locate(hub, parse_contact(target))
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


def joined(dest: str, carrier: str) -> str:
    """Destination and carrier as one text, the way C++ puts them together."""
    if not carrier:
        return dest
    bare = parse_contact(dest) if dest else None
    if bare is not None and bare.carrier and not bare.reachable:
        dest = bare.name
    if bare is not None and bare.reachable:
        return f"{carrier}://{bare.address}{bare.name}"
    return f"{carrier}:/{dest}"


__all__ = ["NOT_ADMITTED", "Refused", "connect", "describe", "joined", "obey"]
