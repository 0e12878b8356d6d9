"""Questions to a port from outside, as every YARP tool asks them: one by one over short text
connections, or by a Caller, again and again over one.

Rules: whoever asks has no port of its own; un-rooted sender names, so that nobody is displaced; a
time limit always. Source: core-3 sections 5.1, 6.3, 6.4.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from types import TracebackType
from typing import Final, Self

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.link.driver import Driver
from yarpy.link.handshake import find_carrier, greet
from yarpy.link.outbound import Outbound
from yarpy.names.default import secret
from yarpy.route import Route, parse_carrier
from yarpy.wire.message import ADMIN, CALL, Message, Packet

ANONYMOUS: Final = "anon_rpc"  # the name C++ tools give themselves
TIMEOUT = 3.0  # seconds; a port that lives answers in milliseconds


def ask(
    contact: Contact,
    question: Sequence[object],
    *,
    key: str = "a",
    name: str = "admin",
    timeout: float = TIMEOUT,
    secret_: bytes | None = None,
) -> Bottle:
    """The answer to an administrative question (`key` "a") or to data ("d").

    Raises LinkClosed, Timeout, RemoteProtocolError.
    """
    route = Route(name, contact.name or f"/{contact.address}", "text_ack")
    driver, carrier = greet(
        contact, route, key=secret() if secret_ is None else secret_, timeout=timeout
    )
    link = Outbound(driver, carrier)
    try:
        reply = link.call(Packet(list(question), key=key), timeout)
        return Bottle() if reply is None else reply.as_(Bottle)
    finally:
        driver.transport.close()


def describe(
    contact: Contact, name: str = "<ping>", timeout: float = TIMEOUT, secret_: bytes | None = None
) -> list[str]:
    """The lines in which a port describes itself and its connections (port command `*`)."""
    return _lines(contact, "*", name, timeout, secret_)


def drop_input(
    contact: Contact, source: str, timeout: float = TIMEOUT, secret_: bytes | None = None
) -> str:
    """Ask a port to drop what comes from `source`: how connectionless senders say goodbye.

    Returns the line it says.
    """
    route = Route("admin", contact.name, "text")
    driver, _ = greet(contact, route, key=secret() if secret_ is None else secret_, timeout=timeout)
    try:
        driver.stream.write(f"~{source}\r\nq\r\n".encode())
        driver.flush()
        driver.run(driver.stream.read_line(), _deadline(timeout))  # the welcome
        return driver.run(driver.stream.read_line(), _deadline(timeout)).decode("utf-8", "replace")
    finally:
        driver.transport.close()


def drop_output(
    contact: Contact, target: str, timeout: float = TIMEOUT, secret_: bytes | None = None
) -> None:
    """Ask a port to stop sending to `target`; it ends the connection in good order."""
    _lines(contact, f"!{target}", "admin", timeout, secret_)


def is_alive(contact: Contact, key: bytes = b"") -> bool:
    """Whether the port of that name really listens at that address."""
    try:
        lines = _lines(contact, "*", "<ping>", 1.0, key)
    except (YarpError, OSError):
        return False
    return bool(lines) and lines[0].startswith(f"This is {contact.name} at ")


def answers(contact: Contact, timeout: float = TIMEOUT) -> bool:
    """Whether a YARP port answers there (`yarp exists`)."""
    try:
        reply = ask(contact, [Vocab("ver")], timeout=timeout)
    except (YarpError, OSError):
        return False
    return bool(reply) and plain_text(reply[0]) in ("ver", "dict")


def is_ours(contact: Contact, timeout: float = TIMEOUT, secret_: bytes | None = None) -> bool:
    """Whether a port is one of yarpy, not of C++ YARP. Raises as `ask`."""
    reply = ask(contact, [Vocab("stat")], timeout=timeout, secret_=secret_)
    return not reply or reply[0] != Vocab("fail")


def _lines(
    contact: Contact, command: str, name: str, timeout: float, secret_: bytes | None
) -> list[str]:
    route = Route(name, contact.name, "text_ack")
    driver, _ = greet(contact, route, key=secret() if secret_ is None else secret_, timeout=timeout)
    try:
        driver.stream.write(command.encode() + b"\r\n")
        driver.flush()
        return list(_until_ack(driver, timeout))
    finally:
        driver.transport.close()


def _until_ack(driver: Driver, timeout: float) -> list[str]:
    lines: list[str] = []
    deadline = _deadline(timeout)
    while len(lines) < 10_000:
        line = driver.run(driver.stream.read_line(), deadline).decode("utf-8", "replace")
        if line == "<ACK>":
            break
        lines.append(line)
    return lines


def _deadline(timeout: float) -> float:
    return time.monotonic() + timeout


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
        timeout: float = 10.0,
    ) -> None:
        if not find_carrier(parse_carrier(carrier).base).replies:
            raise LocalProtocolError(f'"{carrier}" carries no replies; call over tcp')
        route = Route(name, contact.name or f"/{contact.address}", carrier, contact.port)
        driver, speaker = greet(contact, route, key=secret(), timeout=timeout)
        self._link = Outbound(driver, speaker)
        self._key = ADMIN if admin else CALL

    def ask(self, question: object, timeout: float | None = None) -> Message | None:
        """The answer to `question`, None if the port gives none.

        Raises Timeout, LinkClosed; after either, this caller is of no more use.
        """
        return self._link.call(Packet(question, key=self._key), timeout)

    def close(self) -> None:
        """Say goodbye and hang up."""
        self._link.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
