"""Connecting: makes the connections of a port of ours: for its program, for a message from outside,
or for `reconnect`.

Rules: a connection that cannot be made is an error of yarpy.errors, whose text says why; `refusal`
finds the line that C++ has for it. A port makes one attempt at a time to reach a target.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any, Final

from yarpy import scope
from yarpy.carriers.base import Carrier
from yarpy.carriers.hosted import LISTENS
from yarpy.contact import Contact, parse_contact, reach
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import (
    AccessRefused,
    LinkClosed,
    LocalProtocolError,
    LoginRefused,
    NotAllowed,
    PortClosed,
    RemoteProtocolError,
    Timeout,
    UnknownName,
    UnknownPlugin,
    WrongPort,
    YarpError,
)
from yarpy.link.begin.admission import scripts_allowed
from yarpy.link.begin.handshake import GREETING, asked_carrier, find_carrier, greet
from yarpy.link.driver import Driver
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.monitors.chain import Chain, refused_there
from yarpy.names.address import is_local, is_loopback
from yarpy.port.connect import identity, probe, refusal
from yarpy.port.connect.choosing import choose, instead
from yarpy.port.connect.disconnecting import close_output
from yarpy.port.connect.target import agreed, is_topic, joined, refuse_medium, unknown
from yarpy.port.hub import Hub
from yarpy.route import CarrierSpec, Route, masked, parse_carrier
from yarpy.threads import Thread

JOINING: Final = 2.0  # seconds for a receiver to join a multicast group, on a busy computer
_POLL: Final = 0.05  # seconds between attempts to reach a port that is not there yet


# -- for programs ---------------------------------------------------------------------------------


def connect(
    hub: Hub,
    target: str,
    carrier: str,
    lost: Route | None = None,
    again: bool = False,
) -> None:
    """Connect `hub` to `target`, in place of the connection `lost` that broke, if given; see
    Port.connect. `again`: try for as long as the call under way has time."""
    wanted = parse_contact(target)
    if not isinstance(carrier, str):
        raise TypeError(f'a carrier is a text such as "tcp", not {carrier!r}')
    if not wanted.carrier or ":/" not in target:  # what is written in front of a target counts
        refuse_medium(carrier)
        wanted = replace(wanted, carrier=carrier)
    elif is_topic(wanted):
        wanted = replace(wanted, carrier=agreed(carrier, wanted.carrier).whole)
    _connect(hub, wanted, target, lost, again)


def _connect(
    hub: Hub,
    wanted: Contact,
    target: str,
    lost: Route | None = None,
    again: bool = False,
) -> None:
    """As `connect`; `target` is what the program calls it."""
    asked_carrier(parse_carrier(wanted.carrier))  # no time makes that one come
    limit = scope.until() if again else None
    unknown_: YarpError | None = None
    while True:
        try:
            dial(hub, wanted, lost, own=lost is None or lost.spec.own)
            return
        except PortClosed:
            raise
        except YarpError as error:
            if isinstance(error, UnknownName):
                # Whose name is near is asked while there is time for it.
                told = unknown_ = unknown_ or _told(hub, wanted, masked(target), error)
            else:
                told = _told(hub, wanted, masked(target), error)
            # A camera locks those out who try a wrong password again and again.
            final = isinstance(error, AccessRefused)
            if final or limit is None or time.monotonic() >= limit:
                raise told from None  # the same in fewer words, which a reader would see first
        scope.sleep(_POLL)


def _told(hub: Hub, wanted: Contact, target: str, error: YarpError) -> YarpError:
    """The error with what it was about in front."""
    if isinstance(error, UnknownPlugin):
        return error
    told = isinstance(error, WrongPort) or wanted.reaches.topic
    if isinstance(error, UnknownName) and not told:
        return unknown(target, hub.service(), wanted.carrier)
    if isinstance(error, LoginRefused):
        return LoginRefused(f'"{hub.name}" is not admitted to "{target}": {error}')
    over = parse_carrier(wanted.carrier).base
    return type(error)(f'"{hub.name}" cannot connect to "{target}" over {over}: {error}')


def subscribe(hub: Hub, source: str, carrier: str) -> None:
    """Ask the port `source` to send to `hub`; see BasePort.listen_to."""
    contact = parse_contact(source)
    if is_topic(contact):
        spec = agreed(carrier, contact.carrier)
        spec = spec if LISTENS in spec.tokens else spec.plus(LISTENS)
        _connect(hub, replace(contact, carrier=spec.whole), source)
        return
    if contact.reachable:
        kind = asked_carrier(parse_carrier(contact.carrier))
        if not kind.push:
            connect(hub, source, carrier)
            return
        if kind.reaches.foreign:
            raise LocalProtocolError(
                f'"{masked(source)}" is for writing: say what to read, such as '
                f"{kind.name}+{LISTENS}.TOPIC"
            )
    else:
        names = hub.service()
        found = names.query(contact.name) if names is not None else None
        if found is None:
            raise unknown(source, names)
        contact = found
    if not asked_carrier(parse_carrier(carrier)).push:
        connect(hub, source, carrier)
        return
    identity.confirm(contact, identity.properties_of(hub.service()), hub.key)
    own = hub.registration.registered
    target = hub.name if own else f"/{hub.contact.address}"
    # Nobody can find out what a port without a name speaks: it chooses itself.
    chosen = None if carrier or own else choose(contact, hub.service(), own=True)
    reply: list[Any] = []
    if chosen is not None and instead(chosen) is not None:
        reply = probe.ask(contact, ["add", joined(target, chosen.whole)], secret_=hub.key)
    if not reply or reply[0] != 0:
        reply = probe.ask(contact, ["add", joined(target, carrier)], secret_=hub.key)
    if not reply or reply[0] != 0:
        line = plain_text(reply[1]).strip() if len(reply) > 1 else ""
        raise refusal.error(line, f'"{source}" -> "{hub.name}"')


# -- one attempt ----------------------------------------------------------------------------------


def dial(
    hub: Hub,
    wanted: Contact,
    lost: Route | None = None,
    own: bool = False,
) -> CarrierSpec:
    """Connect `hub` to the destination `wanted`, once; an existing connection to it is replaced.
    `lost` is one that broke.

    `own`: its program says so, not somebody on the network.

    Raises UnknownName, WrongPort, NoNameServer, UnknownPlugin, NotAllowed, LinkClosed,
    LoginRefused, LocalProtocolError, RemoteProtocolError, PortClosed.
    """
    scripts = lost.spec.scripts if lost is not None else scripts_allowed()
    spec = replace(parse_carrier(wanted.carrier), own=own, scripts=scripts)
    contact = hub.registration.locate(wanted)
    if contact is None:
        raise UnknownName(f'no port "{wanted.name}" is registered')
    if not wanted.carrier:
        spec = choose(contact, hub.service(), own)
    if hub.inputs.mailbox.blocks and contact.port == hub.port and is_local(contact.host):
        raise NotAllowed(
            f'"{hub.name}" cannot be connected to itself: a write waits until it is read, and both '
            "would be done here; a BufferedPort() or a callback reads meanwhile"
        )
    if (hub.outputs.rpc or not hub.outputs.admitted) and reach(spec.base).topic:
        spec = spec.plus("srv")  # questions go to services
    if contact.reaches.foreign and spec.base == "tcp":
        spec = replace(
            parse_carrier(contact.carrier), own=own, scripts=scripts
        )  # it speaks nothing else
    kind = find_carrier(spec)
    why = kind.reaches.cpp if contact.name else ""
    if kind.reaches.same_program:
        why = f"in another program, which the carrier {kind.name} would crash: use tcp"
    if why and not probe.is_ours(contact, secret_=hub.key):
        raise NotAllowed(refusal.useless(contact, why))
    target = wanted.label
    with hub.callbacks.later(), hub.dialling.alone(target):
        replaced = [old for old in hub.outputs.links if old.route.target == target]
        for old in replaced:
            close_output(hub, old)
        started = time.perf_counter()
        try:
            _check(hub, kind, spec)
            spec = open_output(hub, contact, target, spec, lost)
        except YarpError:
            for old in replaced:  # it was good until now
                hub.actions.reconnect.output_lost(hub, old.route)
            raise
        # One that broke before is replaced; this one may have broken already.
        hub.actions.reconnect.give_up(hub, target, before=started)
    return spec


def _check(hub: Hub, kind: type[Carrier], spec: CarrierSpec) -> None:
    """Refuse what this port does not do, or this carrier."""
    if spec.log not in (None, "in"):
        raise NotAllowed(f"Logger configured as log.{spec.log}, but only log.in is supported")
    if kind.push and spec.log is None:
        if not hub.outputs.admitted:
            raise NotAllowed("Outputs not allowed")
        if hub.outputs.rpc and any(map(_asks, hub.outputs.links)):
            raise NotAllowed("RPC output already connected")
    unheard = spec.recv if kind.push else spec.send
    if unheard and not kind.reaches.told:
        raise LocalProtocolError(
            f"{kind.name} does not tell the {'receiver' if kind.push else 'sender'} of "
            f"{', '.join(name for name, _ in unheard)}: take another carrier, or attach it to "
            "that port by the administrative message atch"
        )


def _asks(link: Outbound) -> bool:
    """Return whether an output is one that questions go to; not those of loggers and onlookers."""
    return not link.log and not link.carrier.delivery.lossy


def open_output(
    hub: Hub,
    contact: Contact,
    target: str,
    spec: CarrierSpec,
    lost: Route | None = None,
    timeout: float | None = None,
) -> CarrierSpec:
    """Dial `contact` and take the connection in; `lost` is the one that it takes the place of,
    `timeout` the seconds for which its listener may be silent then. What it goes over in the end.
    Raises as `dial`."""
    other = instead(spec)
    try:
        return _open_output(hub, contact, target, spec, lost, timeout)
    except (LinkClosed, LocalProtocolError, RemoteProtocolError):
        if other is None:
            raise
    return _open_output(hub, contact, target, other, lost, timeout)


def _open_output(
    hub: Hub,
    contact: Contact,
    target: str,
    spec: CarrierSpec,
    lost: Route | None,
    timeout: float | None,
) -> CarrierSpec:
    """As `open_output`, over `spec` alone."""
    route = Route(hub.name, target, spec, contact.port, declared=hub.registration.declared)
    try:
        chain = hub.monitoring.outgoing(route)
    except UnknownPlugin:
        raise
    except YarpError as error:  # what a monitor has met is not what became of this connection
        raise LocalProtocolError(str(error)) from error
    try:
        try:
            driver, speaker = _greet(hub, contact, route, lost, timeout)
        except (LinkClosed, Timeout):
            other = _other_address(hub, contact)
            if other is None:
                raise
            driver, speaker = _greet(hub, other, route, lost, timeout)
            contact = other
        try:
            if not route.peer and not identity.is_nameless(route):
                identity.learn(contact, route, hub.key)
            _take(hub, contact, driver, speaker, chain)
        except BaseException:
            driver.transport.close()
            raise
        return route.spec
    except (YarpError, OSError) as error:
        if chain is not None:
            chain.close()
        if isinstance(error, LinkClosed):
            _complain(hub, target)
        if isinstance(error, YarpError) and not isinstance(error, Timeout):
            raise
        raise LinkClosed(str(error)) from error


def _take(
    hub: Hub, contact: Contact, driver: Driver, speaker: Carrier, chain: Chain | None
) -> None:
    """Make an open connection one of the port. Raises YarpError."""
    route = speaker.route
    if not speaker.push:
        # With a pull carrier the side that dials receives.
        route.source, route.target = route.target, hub.name
        source = Inbound(hub.inputs, driver, speaker)
        hub.inputs.take(source)
        Thread(target=hub.inputs.serve, args=(source,), daemon=True).start()
        return
    if speaker.delivery.broadcast or route.spec.recv:
        _wait_for_member(hub, contact, speaker, driver)
    link = Outbound(driver, speaker)
    link.ride(chain)
    if route.spec.recv and link.ended():
        raise LocalProtocolError(f'"{route.target}" hung up: {refused_there(route.spec, route)}')
    hub.outputs.add(link)


def _greet(
    hub: Hub, contact: Contact, route: Route, lost: Route | None, timeout: float | None
) -> tuple[Driver, Carrier]:
    """Open the connection, once the listener is known to be the port that is meant."""
    if lost is not None and lost.peer:
        found = identity.confirm_again(contact, lost, hub.key, timeout)
    else:
        known = identity.properties_of(hub.service())
        found = identity.confirm(contact, known, hub.key, timeout, secure=route.spec.in_tls)
    route.peer, route.yarp4 = found
    return greet(
        contact,
        route,
        key=hub.key,
        group=hub.registration.group,
        limit=hub.limit,
        timeout=timeout or GREETING,
    )


def _wait_for_member(hub: Hub, contact: Contact, carrier: Carrier, driver: Driver) -> None:
    """Wait until the receiver says that it has our connection, or ends it.

    It does not say so by itself: a multicast greeting has no answer, so the first messages would
    be lost; and the monitors at its end are set up only after the greeting was answered, which may
    take it some time.
    """
    alone = carrier.delivery.connectionless
    deadline = time.monotonic() + (JOINING if alone else GREETING)
    question = [Vocab("list"), Vocab("in"), hub.name]
    try:
        while time.monotonic() < deadline and scope.left():
            if not alone and driver.transport.ended():
                return
            input_ = probe.ask(contact, question, timeout=JOINING, secret_=hub.key)
            if (
                input_
                and parse_carrier(plain_text(input_.find("carrier", ""))).base == carrier.name
            ):
                return
            time.sleep(0.002)
    except (YarpError, OSError):
        pass  # a receiver that answers no questions


def _other_address(hub: Hub, contact: Contact) -> Contact | None:
    """Return another address of a port on a host with several networks that can be reached from
    here, if there is one.

    It told the name server all its addresses; a port that answers there must have the right name.
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


def _complain(hub: Hub, target: str) -> None:
    """Tell the name service about a registered port that nobody answers for."""
    names = hub.service()
    if names is None:
        return
    try:
        names.announce(target, False)
    except YarpError:
        pass  # it is not our business to be heard
