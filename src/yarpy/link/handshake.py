"""The two beginnings of a connection: dialling out, and answering a peer that dialled in.

Rules: a greeting has `PATIENCE` seconds. Which protocol an incoming connection speaks is decided
by its first eight bytes: the longest magic wins. Unknown bytes are answered with a text that helps
a person. With a key (auth.conf) both sides prove that they know it before anything else; but a
camera, or another server that is no port, has no key and is silent at first.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import Final

from yarpy import registry
from yarpy.carriers.auth import prove_acceptor, prove_initiator
from yarpy.carriers.base import MAGIC_SIZE, Carrier
from yarpy.contact import Contact, host_zid
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    RemoteProtocolError,
    Timeout,
    UnknownPlugin,
    YarpError,
)
from yarpy.link.admission import Gate, peer_of
from yarpy.link.driver import Driver
from yarpy.route import UNDECLARED, CarrierSpec, Declared, Route
from yarpy.transports.base import Answerable, Transport
from yarpy.transports.peer_timeout import PARAMETER, asked_timeout
from yarpy.transports.tcp import TcpTransport, dial
from yarpy.transports.tls_setting import FIRST_BYTE, WORD, has_certificate, required
from yarpy.wire.stream import DEFAULT_LIMIT

PATIENCE: Final = 10.0  # seconds for a whole greeting
PROVING: Final = 2.0  # seconds for the key exchange, as C++

HUNG_UP: Final = -1
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
    for carrier in registry.carriers if carriers is None else carriers:
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


def greet(
    contact: Contact,
    route: Route,
    *,
    key: bytes = b"",
    group: Callable[[str], tuple[str, int]] | None = None,
    limit: int = DEFAULT_LIMIT,
    timeout: float = PATIENCE,
) -> tuple[Driver, Carrier]:
    """Dial `contact` and open the connection that `route` describes.

    Raises UnknownPlugin, LinkClosed (nobody there, hung up), Timeout, RemoteProtocolError,
    LocalProtocolError.
    """
    route.host, route.port = contact.host, contact.port
    kind = find_carrier(route.spec)
    deadline = time.monotonic() + timeout
    secure = must_be_tls(contact.host) or route.spec.in_tls
    if secure and not (route.spec.in_tls or kind.medium):
        route.spec = route.spec.plus(WORD)
    if secure and kind.connectionless:
        raise LocalProtocolError(f"TLS protects no datagrams: take tls, not {kind.name}")
    if kind.connectionless and host_zid(contact.host):
        raise LocalProtocolError(f"{kind.name} does not go through Zenoh: take tcp")
    carrier = kind(route)
    silence = _silence(route)
    if kind.medium:
        driver = Driver(registry.media.load(kind.medium)(contact, route), limit)
    else:
        driver = call(contact, timeout, limit, group, secure)
    try:
        if key and not kind.medium and (not carrier.foreign or _speaks_first(driver)):
            driver.run(prove_initiator(driver.stream, key), time.monotonic() + PROVING)
        driver.run(carrier.greet(driver.stream), deadline)
        _limit_silence(driver, silence, route)
    except OSError as error:
        driver.transport.close()
        if isinstance(error, LinkClosed | Timeout):
            raise
        raise LinkClosed(f"cannot reach {contact.address} ({error.strerror or error})") from error
    except BaseException:
        driver.transport.close()
        raise
    return driver, carrier


def call(
    contact: Contact,
    timeout: float = PATIENCE,
    limit: int = DEFAULT_LIMIT,
    group: Callable[[str], tuple[str, int]] | None = None,
    secure: bool = False,
) -> Driver:
    """Dial `contact`; nothing is said yet. `secure`: in TLS, as always where that is required.

    Raises LinkClosed (nobody listens), Timeout, RemoteProtocolError (a certificate that is wrong).
    """
    deadline = time.monotonic() + timeout
    transport: Transport
    try:
        if host_zid(contact.host):
            transport = _dial_inside(contact, timeout, secure)
        else:
            tcp = transport = dial(contact.host, contact.port, timeout)
            if secure or required():
                transport = _in_tls(tcp, contact.host, deadline)
    except RemoteProtocolError as error:
        raise RemoteProtocolError(f"{contact.address}: {error}") from error
    except TimeoutError as error:
        raise Timeout(f"{contact.address} does not answer") from error
    except OSError as error:
        raise LinkClosed(
            f"nobody answers at {contact.address} ({error.strerror or error})"
        ) from error
    return Driver(transport, limit, group)


def must_be_tls(host: str) -> bool:
    """Whether a connection there must be TLS. Inside Zenoh it is the links of that that are."""
    return required() and not host_zid(host)


def _dial_inside(contact: Contact, timeout: float, secure: bool) -> Transport:
    if secure:
        raise LocalProtocolError(
            f"{contact.name or contact.address} is reached through Zenoh, whose routers pass "
            "messages on in TLS if they are at tls/HOST, but there is no TLS through them: take tcp"
        )
    from yarpy.transports.zenoh_exchange import dial_inside

    return dial_inside(contact.host, contact.port, timeout)


def _speaks_first(driver: Driver) -> bool:
    """Whether the peer speaks first, as only ports with a key do."""
    try:
        driver.run(driver.stream.more(1), time.monotonic() + LISTENING)
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
) -> tuple[Driver, Carrier] | None:
    """Answer a peer that dialled the port called `target`; None if it hung up without a word.

    gate: who may do what there. declared: what the port says of itself. silence: why it writes
    nothing that could be heard. Raises RemoteProtocolError for bytes that no carrier knows (the
    peer was told), AccessRefused, LinkClosed, Timeout.
    """
    deadline = time.monotonic() + PATIENCE
    opening = _opening(transport, bool(key), deadline)
    secure = opening == FIRST_BYTE and isinstance(transport, TcpTransport)
    asks_names = gate is not None and gate.asks_names
    if secure:
        assert isinstance(transport, TcpTransport)
        transport = _in_tls(transport, "", deadline, asks_names)
    elif opening == HUNG_UP:
        return None
    elif must_be_tls(_dialler(transport)):
        _turn_away(transport)
    driver = Driver(transport, limit)
    driver.silence = silence
    if key:
        driver.run(prove_acceptor(driver.stream, key), time.monotonic() + PROVING)
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
        names = getattr(transport, "peer_names", ())
        driver.admission = gate.admit(peer_of(_dialler(transport), reached, names, bool(key)))
    added = f"+{WORD}" if secure else ""
    carrier = kind(Route("", target, kind.name + added, port, reached, declared=declared))
    try:
        while (other := driver.run(carrier.welcome(driver.stream, first), deadline)) is not None:
            carrier = other  # the first bytes alone did not decide it
        try:
            _limit_silence(driver, _silence(carrier.route), carrier.route)
        except LocalProtocolError as error:
            driver.transport.close()  # not always the one that we were given
            raise RemoteProtocolError(str(error)) from error
    except RemoteProtocolError:
        with suppress(YarpError):
            driver.flush()  # the protocol's answer to that
        raise
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
    if seconds is None:
        return
    if not isinstance(driver.transport, TcpTransport):
        raise LocalProtocolError(
            f"{PARAMETER} is for connections over TCP, which {route.spec.base} does not keep"
        )
    driver.transport.limit_silence(seconds)


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
    transport: TcpTransport, host: str, deadline: float, asks_names: bool = False
) -> TcpTransport:
    """TLS on a new connection. Raises RemoteProtocolError, which says what to do, and Timeout."""
    from yarpy.transports.tls import explained, secured

    try:
        return secured(transport, host, deadline, asks_names)
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


def _dialler(transport: Transport) -> str:
    """The address of the peer that dialled us."""
    try:
        return transport.remote[0]
    except OSError:
        return ""
