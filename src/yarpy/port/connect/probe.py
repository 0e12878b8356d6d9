"""Questions to a port from outside, as every YARP tool asks them: one by one over short text
connections, or by a Caller, again and again over one.

Rules: the asking side has no port of its own; its name has no slash in front, so that it displaces
no connection; there is always a time limit, for the whole of it, and never a later one than that
of the call under way. Before a port is told to end a connection it is asked
for its name, over the same connection: a number that a name service remembers may belong to another
port by now.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Final, NamedTuple, Self, TypeVar

from yarpy import registry, scope
from yarpy.carriers.auth import prove_initiator
from yarpy.contact import Contact, reach
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, Timeout, WrongPort, YarpError
from yarpy.link.begin.handshake import GREETING, PROVING, call, find_carrier, greet
from yarpy.link.driver import Driver
from yarpy.link.ending import moment
from yarpy.link.send.outbound import Outbound
from yarpy.names.default import secret
from yarpy.route import Route, parse_carrier
from yarpy.transports.tls_setting import WORD
from yarpy.wire.message import ADMIN, CALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

Answer = TypeVar("Answer")

ANONYMOUS: Final = "anon_rpc"  # the name C++ tools give themselves
TIMEOUT = 3.0  # seconds; a port that lives answers in milliseconds
_LONGEST: Final = 4096  # bytes of a line with one name or two in it
# [stat]: only ports of yarpy know it; [bus], which would load ROS there: all others but YARP 4.
_STAT: Final = b"a\r\n[stat] in ?\r\n"
_BUS: Final = b"a\r\n[bus]\r\n"
#: the answer of C++ to an administrative command that it does not know
_UNKNOWN: Final = b'[fail] "send [help] for list of valid commands"'
_ACKNOWLEDGED: Final = b"<ACK>"
VERSION: Final = 1.0  # seconds to tell it, behind the name


def ask(
    contact: Contact,
    question: Sequence[object],
    *,
    key: str = "a",
    name: str = "admin",
    timeout: float = TIMEOUT,
    secret_: bytes | None = None,
    secure: bool = False,
) -> Bottle:
    """The answer to an administrative question (`key` "a") or to data ("d"). `secure`: it is asked
    in TLS.

    Raises LinkClosed, Timeout, RemoteProtocolError.
    """
    spoken = f"text_ack+{WORD}" if secure else "text_ack"
    route = Route(name, contact.name or f"/{contact.address}", spoken)
    deadline = _deadline(timeout)
    driver, carrier = greet(
        contact, route, key=secret() if secret_ is None else secret_, timeout=timeout
    )
    link = Outbound(driver, carrier)
    try:
        with scope.waking(lambda: driver.transport.interrupt()):
            until = max(deadline, time.monotonic() + 0.001)
            reply = link.call(Packet(list(question), key=key), until)
        return Bottle() if reply is None else reply.as_(Bottle)
    finally:
        driver.transport.close()


def is_refused(error: BaseException) -> bool:
    """Return whether the host says that nobody listens there: the only proof that a port is gone. A
    host that cannot be reached may come back."""
    return isinstance(error.__cause__, ConnectionRefusedError)


def connection(
    contact: Contact, side: str, peer: str, secret_: bytes | None = None, secure: bool = False
) -> Property | None:
    """Return the statistics of the connection with `peer` on that side ("in" or "out") of the port
    at `contact`; None if there is none. Raises LookupError if it is no port of yarpy, and as
    `ask`."""
    reply = ask(contact, [Vocab("stat"), Vocab(side), peer], secret_=secret_, secure=secure)
    if reply and reply[0] == Vocab("fail"):
        raise LookupError(f"{contact} does not count")
    return Property.from_bottle(_pairs(reply[0])) if reply else None


def _pairs(item: object) -> Bottle:
    """The `(key value)` lists of a connection; a dict by now, or still a list."""
    if isinstance(item, dict):
        return Bottle([key, value] for key, value in item.items())
    return item if isinstance(item, Bottle) else Bottle(item if isinstance(item, list) else [])


def describe(
    contact: Contact, name: str = "<ping>", timeout: float = TIMEOUT, secret_: bytes | None = None
) -> list[str]:
    """The lines in which a port describes itself and its connections (port command `*`)."""
    return _lines(contact, "*", name, timeout, secret_)


class Listener(NamedTuple):
    """The answers of a port about itself. name: "" if it has none. yarp4: it is of C++ YARP 4."""

    name: str = ""
    yarp4: bool = False


def who(
    contact: Contact,
    timeout: float = TIMEOUT,
    secret_: bytes | None = None,
    secure: bool = False,
) -> str:
    """Return the name that the port at `contact` gives itself; "" if it is no YARP port.

    `secure`: it is asked in TLS.

    Everything is said at once, so that it costs one journey there and back. Raises LinkClosed
    (nobody listens there), Timeout (it is silent).
    """

    def ask(driver: Driver, deadline: float) -> str:
        return driver.run(_introduction(driver.stream), deadline)

    return _meet(contact, ask, "", timeout, secret_, secure)


def introduce(
    contact: Contact,
    timeout: float = TIMEOUT,
    secret_: bytes | None = None,
    secure: bool = False,
) -> Listener:
    """Return the name of a port that is about to be dialled, and how messages are spelled for it.

    Takes and raises as `who`, and costs no further journey but where C++ answers.
    """

    def ask(driver: Driver, deadline: float) -> Listener:
        name = driver.run(_introduction(driver.stream, _STAT), deadline)
        return Listener(name, bool(name) and _speaks_yarp4(driver, deadline))

    return _meet(contact, ask, Listener(), timeout, secret_, secure)


def _meet(
    contact: Contact,
    ask: Callable[[Driver, float], Answer],
    otherwise: Answer,
    timeout: float,
    secret_: bytes | None,
    secure: bool,
) -> Answer:
    """Dial and `ask`; return `otherwise` if it is no YARP port, or one with another key."""
    deadline = _deadline(timeout)
    driver = call(contact, timeout, secure=secure)
    key = secret() if secret_ is None else secret_
    try:
        with scope.waking(lambda: driver.transport.interrupt()):
            if key:
                driver.run(prove_initiator(driver.stream, key), min(deadline, _deadline(PROVING)))
            return ask(driver, deadline)
    except Timeout as error:
        raise Timeout(
            f"what listens at {contact.address} does not say who it is; its program may be stopped "
            "or busy"
        ) from error
    except (YarpError, OSError):
        return otherwise
    finally:
        driver.transport.close()


def _introduction(stream: ByteStream, further: bytes = b"") -> Steps[str]:
    """Its name, which it says first when it describes itself. `further`: a question whose answer
    follows."""
    stream.write(b"CONNACK admin\r\n*\r\n" + further)
    welcome = yield from stream.read_line(_LONGEST)
    if not welcome.startswith(b"Welcome"):
        return ""
    return _own_name((yield from stream.read_line(_LONGEST)).decode("utf-8", "replace"))


def _speaks_yarp4(driver: Driver, deadline: float) -> bool:
    """Return whether it is of C++ YARP 4; whoever does not say so is not."""
    try:
        return driver.run(_version_known(driver.stream), min(deadline, _deadline(VERSION)))
    except (YarpError, OSError):
        return False


def _version_known(stream: ByteStream) -> Steps[bool]:
    """Read the rest of the description and the answer to _STAT, and ask what is left to ask."""
    while (yield from stream.read_line(_LONGEST)) != _ACKNOWLEDGED:
        pass
    if (yield from stream.read_line(_LONGEST)) != _UNKNOWN:
        return False
    while (yield from stream.read_line(_LONGEST)) != _ACKNOWLEDGED:
        pass
    stream.write(_BUS)
    return (yield from stream.read_line(_LONGEST)) == _UNKNOWN


def _own_name(line: str) -> str:
    """The name in the first line of a port's description of itself."""
    head, _, rest = line.partition("This is ")
    name, at, _ = rest.rpartition(" at ")
    return name if at and not head else ""


class AdminConnection:
    """One connection to the port at `contact` for several questions, such as its name and what
    depends on that. Raises as `ask`. Not for several threads at once."""

    def __init__(
        self, contact: Contact, timeout: float = TIMEOUT, secret_: bytes | None = None
    ) -> None:
        self._deadline = _deadline(timeout)
        route = Route("admin", contact.name or f"/{contact.address}", "text_ack")
        key = secret() if secret_ is None else secret_
        self._driver, carrier = greet(contact, route, key=key, timeout=timeout)
        self._link = Outbound(self._driver, carrier)

    def name(self) -> str:
        """The name that the port gives itself; "" if it cannot say."""
        with scope.waking(lambda: self._driver.transport.interrupt()):
            return _own_name((_asked(self._driver, "*", self._deadline) or [""])[0])

    def ask(self, question: Sequence[object]) -> Bottle:
        """The answer to an administrative question."""
        with scope.waking(lambda: self._driver.transport.interrupt()):
            left = max(0.001, self._deadline - time.monotonic())
            reply = self._link.call(Packet([*question], key=ADMIN), moment(scope.left(left)))
            return Bottle() if reply is None else reply.as_(Bottle)

    def close(self) -> None:
        """Hang up."""
        self._driver.transport.close()


def drop_input(
    contact: Contact, source: str, timeout: float = TIMEOUT, secret_: bytes | None = None
) -> list[str]:
    """Ask a port to drop what comes from `source`: how connectionless senders say goodbye.

    Returns what it says to that. Raises WrongPort if another port listens there.
    """
    return _told(contact, f"~{source}", timeout, secret_)


def drop_output(
    contact: Contact, target: str, timeout: float = TIMEOUT, secret_: bytes | None = None
) -> list[str]:
    """Ask a port to stop sending to `target`; it ends the connection in good order.

    Returns and raises as `drop_input`.
    """
    return _told(contact, f"!{target}", timeout, secret_)


def is_alive(contact: Contact, key: bytes = b"") -> bool:
    """Return whether the port of that name answers at that address."""
    try:
        return who(contact, secret_=key) == contact.name
    except YarpError:
        return False


def answers(contact: Contact, timeout: float = TIMEOUT) -> bool:
    """Return whether a YARP port answers there (`yarp exists`)."""
    try:
        reply = ask(contact, [Vocab("ver")], timeout=timeout)
    except (YarpError, OSError):
        return False
    return bool(reply) and plain_text(reply[0]) in ("ver", "dict")


def is_ours(contact: Contact, timeout: float = TIMEOUT, secret_: bytes | None = None) -> bool:
    """Return whether a port is one of yarpy, not of C++ YARP. Raises as `ask`."""
    reply = ask(contact, [Vocab("stat")], timeout=timeout, secret_=secret_)
    return not reply or reply[0] != Vocab("fail")


def _told(contact: Contact, command: str, timeout: float, secret_: bytes | None) -> list[str]:
    """Tell the port called `contact.name`, and no other, to do something."""
    deadline = _deadline(timeout)
    with _text_line(contact, "admin", timeout, secret_) as driver:
        found = _own_name((_asked(driver, "*", deadline) or [""])[0])
        if contact.name and found and found != contact.name:
            raise another_port(contact, contact.name, found)
        return _asked(driver, command, deadline)


def another_port(contact: Contact, wanted: str, found: str) -> WrongPort:
    """The error for a number that belongs to another port than the one called `wanted`."""
    who = f'"{found}"' if found else "something that does not say its name"
    hint = f": start the program of {wanted} again" if wanted != f"/{contact.address}" else ""
    return WrongPort(f'{who} listens at {contact.address}, not "{wanted}"{hint}')


def _lines(
    contact: Contact, command: str, name: str, timeout: float, secret_: bytes | None
) -> list[str]:
    deadline = _deadline(timeout)
    with _text_line(contact, name, timeout, secret_) as driver:
        return _asked(driver, command, deadline)


@contextmanager
def _text_line(
    contact: Contact, name: str, timeout: float, secret_: bytes | None
) -> Iterator[Driver]:
    route = Route(name, contact.name, "text_ack")
    driver, _ = greet(contact, route, key=secret() if secret_ is None else secret_, timeout=timeout)
    try:
        with scope.waking(lambda: driver.transport.interrupt()):
            yield driver
    finally:
        driver.transport.close()


def _asked(driver: Driver, command: str, deadline: float) -> list[str]:
    """The lines that answer a port command."""
    driver.stream.write(command.encode() + b"\r\n")
    lines: list[str] = []
    while len(lines) < 10_000:
        line = driver.run(driver.stream.read_line(), deadline).decode("utf-8", "replace")
        if line == "<ACK>":
            break
        lines.append(line)
    return lines


def _deadline(timeout: float) -> float:
    return time.monotonic() + scope.left(timeout)


class Caller:
    """One connection to the port at `contact` for questions and answers, dialled when made.

    With `admin` they are administrative ones (`[ver]`, `[list] [in]` ...). Raises LinkClosed,
    Timeout, UnknownPlugin, LocalProtocolError (a carrier without replies). Not for several threads
    at once.
    """

    def __init__(
        self,
        contact: Contact,
        name: str = ANONYMOUS,
        *,
        carrier: str = "tcp",
        admin: bool = False,
        timeout: float = GREETING,
    ) -> None:
        spoken = registry.carriers.facts(parse_carrier(contact.carrier).base)
        if reach(carrier).topic:
            carrier = f"{carrier}+srv"  # questions go to services
        elif spoken.reaches.foreign and not (admin and spoken.magic):
            carrier = contact.carrier  # what ports answer, too, is administered as any port
        if not find_carrier(parse_carrier(carrier)).replies:
            raise LocalProtocolError(f'"{carrier}" carries no replies; call over tcp')
        route = Route(name, contact.name or f"/{contact.address}", carrier, contact.port)
        driver, speaker = greet(contact, route, key=secret(), timeout=timeout)
        self._link = Outbound(driver, speaker)
        self._key = ADMIN if admin else CALL

    def ask(self, question: object, timeout: float | None = None) -> Message | None:
        """The answer to `question`, None if the port gives none.

        Raises Timeout, LinkClosed; after either, this caller is of no more use.
        """
        seconds = scope.left(math.inf if timeout is None else timeout)
        with scope.waking(lambda: self._link.driver.transport.interrupt()):
            until = None if seconds == math.inf else moment(seconds)
            return self._link.call(Packet(question, key=self._key), until)

    def close(self) -> None:
        """Say goodbye and hang up."""
        self._link.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()
