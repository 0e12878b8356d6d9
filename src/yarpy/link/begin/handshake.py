"""The two beginnings of a connection: dialling out, and answering a peer that dialled in.

Rules: a greeting has `TIMEOUT` seconds, ours `GREETING` with dialling, or what the call under way
has left (`scope`), which also ends it. Which protocol an incoming connection speaks is decided
by its first eight bytes: the longest magic wins. Unknown bytes are answered with a text that helps
a person. With a key (auth.conf) both sides prove that they know it before anything else; but a
camera, or another server that is no port, has no key and is silent at first.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from typing import Final

from yarpy import registry, scope
from yarpy.carriers.auth import prove_acceptor, prove_initiator
from yarpy.carriers.base import Carrier, refuse_unknown
from yarpy.contact import Contact
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    RemoteProtocolError,
    Timeout,
    UnknownPlugin,
    YarpError,
)
from yarpy.facts import MAGIC_SIZE, TransportRow
from yarpy.link.begin.admission import Gate, Rival, Room, any_number, no_rival, peer_of
from yarpy.link.begin.greeting import Greeting, GroupOf, driver_of
from yarpy.link.combine import combine
from yarpy.link.driver import Driver
from yarpy.log import readable
from yarpy.route import UNDECLARED, CarrierSpec, Declared, Route
from yarpy.transports.base import Address, Answerable, Transport
from yarpy.transports.opener import Opener
from yarpy.transports.peer_timeout import PARAMETER, asked_timeout
from yarpy.transports.tls_setting import FIRST_BYTE, WORD, has_certificate, required
from yarpy.wire.framing import encode_refusal
from yarpy.wire.stream import DEFAULT_LIMIT

TIMEOUT: Final = 10.0  # seconds for a whole greeting of a peer that has dialled
GREETING: Final = 5.0  # seconds for one of ours, at most: a call under way may have less left
PROVING: Final = 2.0  # seconds for the key exchange, as C++

HUNG_UP: Final = -1
UNPROVED: Final = (
    "it hung up instead of proving that it knows our key: it has another one (compare both sides' "
    "auth.conf), or looked whether somebody listens here"
)
HESITATION: Final = 0.3  # seconds that a port with a key waits to see whether TLS comes
LISTENING: Final = 1.0  # seconds within which a port with a key begins to prove it

TLS_ALONE: Final = b"* This port speaks TLS alone: take https, or the carrier tls.\r\n"
UNKNOWN_PROTOCOL: Final = (
    b"* Error. Protocol not found.\r\n"
    b"* Hello. You appear to be trying to communicate with a YARP Port.\r\n"
    b"* The first 8 bytes sent to a YARP Port are critical for identifying the\r\n"
    b"* protocol you wish to speak.\r\n"
    b"* The first 8 bytes you sent were not associated with any particular protocol.\r\n"
    b'* If you are a human, try typing "CONNECT foo" followed by a <RETURN>.\r\n'
    b'* The 8 bytes "CONNECT " correspond to a simple text-mode protocol.\r\n'
    b"* Goodbye.\r\n"
)


def recognise(
    first: bytes, carriers: Iterable[type[Carrier]] | None = None
) -> type[Carrier] | None:
    """The carrier whose magic matches most of the `first` eight bytes, or None."""
    best, length = None, 0
    for carrier in registry.carriers.beginning(first) if carriers is None else carriers:
        found = carrier.recognises(first)
        if found > length:
            best, length = carrier, found
    return best


def find_carrier(spec: CarrierSpec) -> type[Carrier]:
    """The class of a carrier. Raises UnknownPlugin with the nearest match, LocalProtocolError for a
    carrier string that lacks something."""
    base = spec.base
    try:
        carrier: type[Carrier] = registry.carriers.load(base)
    except UnknownPlugin:
        if base not in registry.monitors.names():
            raise
        raise UnknownPlugin(
            f'"{base}" is not a carrier but a monitor, which rides on one: use tcp+recv.{base}, or '
            f"tcp+send.{base} at the sender's end"
        ) from None
    if not (isinstance(carrier, type) and issubclass(carrier, Carrier)):
        raise UnknownPlugin(f'"{base}" is installed, but is not a Carrier class')
    return carrier.of(spec)


def asked_carrier(spec: CarrierSpec) -> type[Carrier]:
    """As `find_carrier`, for what somebody asks of us: LocalProtocolError also for an addition that
    the carrier does not know. Peers may add what they like."""
    carrier = find_carrier(spec)
    if carrier.words is not None:
        refuse_unknown(spec, carrier.words)
    return carrier


def greet(
    contact: Contact,
    route: Route,
    *,
    key: bytes = b"",
    group: GroupOf | None = None,
    limit: int = DEFAULT_LIMIT,
    timeout: float = GREETING,
) -> tuple[Driver, Carrier]:
    """Dial `contact` and open the connection that `route` describes.

    Raises UnknownPlugin, LinkClosed (nobody there, hung up), Timeout, RemoteProtocolError,
    LocalProtocolError.
    """
    route.host, route.port = contact.host, contact.port
    kind = find_carrier(route.spec)
    timeout = scope.left(timeout)
    deadline = time.monotonic() + timeout
    way = way_to(contact, kind)
    secure = must_be_tls(way) or route.spec.in_tls
    if secure and not (route.spec.in_tls or kind.over == way.name):
        route.spec = route.spec.plus(WORD)
    refused = combine(kind.name, kind.over, way, secure)
    if refused:
        raise LocalProtocolError(refused)
    carrier = kind(route)
    silence = _silence(route)
    if kind.over == way.name:
        opener: type[Opener] = registry.transports.load(way.name)
        driver = driver_of(opener.dial(contact, timeout, route), limit)
    else:
        driver = call(contact, timeout, limit, secure)
    greeting = Greeting(driver, group)
    try:
        with scope.waking(lambda: greeting.driver.transport.interrupt()):
            proves = key and kind.over != way.name
            if proves and (not kind.reaches.foreign or _speaks_first(driver, deadline)):
                proving = min(deadline, time.monotonic() + PROVING)
                driver.run(prove_initiator(driver.stream, key), proving)
            greeting.run(carrier.greet(driver.stream), deadline)
            _limit_silence(greeting.driver, silence, route)
    except OSError as error:
        greeting.driver.transport.close()
        if isinstance(error, LinkClosed | Timeout):
            raise
        raise LinkClosed(f"cannot reach {contact.address} ({error.strerror or error})") from error
    except BaseException:
        greeting.driver.transport.close()
        raise
    return greeting.driver, carrier


def call(
    contact: Contact,
    timeout: float = GREETING,
    limit: int = DEFAULT_LIMIT,
    secure: bool = False,
) -> Driver:
    """Dial `contact`; nothing is said yet. `secure`: in TLS, as always where that is required.

    Raises LinkClosed (nobody listens), Timeout, RemoteProtocolError (a certificate that is wrong).
    """
    timeout = scope.left(timeout)
    deadline = time.monotonic() + timeout
    try:
        way = way_to(contact)
        secure = secure or must_be_tls(way)
        if secure and way.no_tls:
            raise LocalProtocolError(f"{contact.name or contact.address}: {way.no_tls}")
        opener: type[Opener] = registry.transports.load(way.name)
        transport = opener.dial(contact, timeout)
        if secure:
            try:
                with scope.waking(transport.interrupt):
                    transport = _in_tls(transport, contact.host, deadline)
            except BaseException:
                transport.close()
                raise
    except RemoteProtocolError as error:
        raise RemoteProtocolError(f"{contact.address}: {error}") from error
    except TimeoutError as error:
        raise Timeout(f"{contact.address} does not answer") from error
    except OSError as error:
        raise LinkClosed(
            f"nobody answers at {contact.address} ({error.strerror or error})"
        ) from error
    return driver_of(transport, limit)


def way_to(contact: Contact, kind: type[Carrier] | None = None) -> TransportRow:
    """Return the transport that a connection to `contact` begins on: what has no host is reached
    over that of the carrier alone."""
    if kind is not None and kind.reaches.topic:
        return registry.transports.facts(kind.over)
    return registry.transports.of_host(contact.host)


def must_be_tls(way: TransportRow) -> bool:
    """Return whether a connection over a transport must be TLS: of some it is the links below that
    are."""
    return required() and not way.no_tls


def _speaks_first(driver: Driver, deadline: float) -> bool:
    """Return whether the peer speaks first, as only ports with a key do."""
    try:
        driver.run(driver.stream.more(1), min(deadline, time.monotonic() + LISTENING))
    except Timeout:
        return False
    return True


def welcome(
    transport: Answerable,
    target: str,
    port: int,
    *,
    key: bytes = b"",
    limit: int = DEFAULT_LIMIT,
    carriers: Iterable[type[Carrier]] | None = None,
    gate: Gate | None = None,
    declared: Declared = UNDECLARED,
    silence: str = "",
    room: Room = any_number,
    rival: Rival = no_rival,
) -> tuple[Driver, Carrier] | None:
    """Answer a peer that dialled the port called `target`; None if it hung up without a word.

    gate: who may do what there. declared: what the port says of itself. silence: why it writes
    nothing that could be heard. room: whether another sender of datagrams finds a place.
    rival: why another sender of a name is not taken.
    Raises RemoteProtocolError for bytes that no carrier knows (the
    peer was told), AccessRefused, LinkClosed, Timeout.
    """
    deadline = time.monotonic() + TIMEOUT
    way = registry.transports.facts(transport.scheme)
    opening = _opening(transport, bool(key), deadline)
    secure = opening == FIRST_BYTE and transport.sock is not None
    asks_names = gate is not None and gate.asks_names
    if secure:
        transport = _in_tls(transport, "", deadline, asks_names)
    elif opening == HUNG_UP:
        return None
    elif must_be_tls(way):
        _turn_away(transport)
    driver = driver_of(transport, limit)
    driver.silence = silence
    driver.room, driver.rival = room, rival
    if key:
        try:
            driver.run(prove_acceptor(driver.stream, key), time.monotonic() + PROVING)
        except LinkClosed:
            raise LinkClosed(UNPROVED) from None
    try:
        first = bytes(driver.run(driver.stream.read_exact(MAGIC_SIZE), deadline))
    except LinkClosed:
        return None
    kind = recognise(first, carriers)
    if kind is None:
        driver.stream.write(UNKNOWN_PROTOCOL)
        driver.flush()
        raise RemoteProtocolError(f"no carrier begins with the bytes {first!r}")
    reached = _reached(transport)
    if gate is not None:
        ends = _ends(transport)
        here = reached if way.proves else ""
        peer = peer_of(ends[0][0] if ends else "", here, transport.peer_names, bool(key))
        known = replace(peer, page=kind.reaches.page, ends=ends if way.proves else ())
        driver.admission = gate.admit(known)
    added = f"+{WORD}" if secure else ""
    carrier = kind(Route("", target, kind.name + added, port, reached, declared=declared))
    greeting = Greeting(driver)
    try:
        while True:
            other = greeting.run(carrier.welcome(greeting.driver.stream, first), deadline)
            if other is None:
                break
            carrier = other  # the first bytes alone did not decide it
        driver = greeting.driver  # not always the one that we began with
        try:
            _limit_silence(driver, _silence(carrier.route), carrier.route)
        except LocalProtocolError as error:
            driver.transport.close()
            raise RemoteProtocolError(str(error)) from error
    except RemoteProtocolError:
        with suppress(YarpError):
            greeting.driver.flush()  # the protocol's answer to that
        raise
    except (YarpError, OSError):
        raise
    except Exception as error:  # a defect of ours, which a stranger may have found
        why = f"a defect: its greeting led to {type(error).__name__}: {error}"
        with suppress(YarpError):
            greeting.driver.stream.write(encode_refusal(readable(f"the port has {why}")))
            greeting.driver.flush()
        raise RemoteProtocolError(why) from error
    return driver, carrier


def _silence(route: Route) -> int | None:
    """The seconds without a word after which a connection takes its peer's host for dead, if it has
    a limit of its own. Raises LocalProtocolError."""
    said = route.spec.value(PARAMETER)
    try:
        return None if said is None else asked_timeout(said)
    except ValueError as error:
        raise LocalProtocolError(str(error)) from error


def _limit_silence(driver: Driver, seconds: int | None, route: Route) -> None:
    if seconds is not None and not driver.transport.limit_silence(seconds):
        raise LocalProtocolError(
            f"{PARAMETER} is for connections over TCP, which {route.spec.base} does not keep"
        )


def _opening(transport: Answerable, speaks_first: bool, deadline: float) -> int:
    """The first byte of the peer that dialled us, left unread; 0 if we do not wait for it.

    A port with a key speaks first, so it waits for a moment only, and only for TLS.
    """
    if speaks_first and not (has_certificate() or required()):
        return 0
    left = max(deadline - time.monotonic(), 0.001)
    transport.limit_waiting(HESITATION if speaks_first else left)
    try:
        return transport.peek()
    except (BlockingIOError, TimeoutError):
        if speaks_first:
            return 0
        raise Timeout("the peer is silent") from None
    except OSError:
        return HUNG_UP
    finally:
        transport.limit_waiting(None)


def _in_tls(
    transport: Transport, host: str, deadline: float, asks_names: bool = False
) -> Answerable:
    """Begin TLS on a new connection. Raises LocalProtocolError where there is no socket,
    RemoteProtocolError, which says what to do, and Timeout."""
    from yarpy.transports.tls import explained, secured

    if transport.sock is None:
        raise LocalProtocolError(f"there is no TLS over {transport.scheme}: take tcp")
    try:
        return secured(transport.sock, host, deadline, asks_names)
    except (BlockingIOError, TimeoutError) as error:
        raise Timeout("the peer is silent in the middle of TLS") from error
    except OSError as error:
        raise RemoteProtocolError(explained(error)) from error


def _turn_away(transport: Transport) -> None:
    """Tell a peer that came without TLS that TLS is required."""
    try:
        transport.send([TLS_ALONE])
    except OSError:
        pass  # they have gone
    raise RemoteProtocolError("it came without TLS, which YARPY_TLS requires here")


def _reached(transport: Transport) -> str:
    """Our address that the peer dialled."""
    try:
        return transport.local[0]
    except OSError:
        return ""  # closed meanwhile; the next read finds out


def _ends(transport: Transport) -> tuple[Address, ...]:
    """Return the address of the peer that dialled us, and ours; nothing if it has hung up."""
    try:
        return transport.remote, transport.local
    except OSError:
        return ()
