"""Refusals: the lines in which ports say that a connection cannot be made, and our errors.

Rules: one table, read both ways: what a port of ours answers, and what another port's answer means.
The lines are those of C++ YARP, which gives no reasons; we add one behind a
colon.

    >>> line(UnknownName('no port "/b" is registered'), "tcp://b")
    'Do not know how to connect to tcp://b'
    >>> error("Cannot connect to tcp://b", '"/a" -> "/b"')
    LinkClosed('"/a" -> "/b" was refused: Cannot connect to tcp://b')
"""

from __future__ import annotations

from typing import Final

from yarpy.contact import Contact, reach
from yarpy.errors import (
    AccessRefused,
    AddressError,
    LinkClosed,
    LoginRefused,
    NotAllowed,
    UnknownName,
    WrongPort,
    YarpError,
)
from yarpy.wire.framing import REFUSED

# From outside one cannot tell whose fault it is that a port cannot connect: its peer may not be
# there yet, a camera that still starts, a program that died.
_TABLE: Final[tuple[tuple[type[YarpError], str, type[YarpError]], ...]] = (
    # our error, the line, what that line means in the answer of another port
    (WrongPort, "Cannot connect to {to}: {why}", LinkClosed),
    (UnknownName, "Do not know how to connect to {to}", UnknownName),
    (AddressError, "Do not know how to connect to {to}", UnknownName),
    (LoginRefused, "Not admitted to {to}: {why}", LoginRefused),
    (AccessRefused, "No access to {to}: {why}", AccessRefused),
    (NotAllowed, "{why}", NotAllowed),
    (YarpError, "Cannot connect to {to}: {why}", LinkClosed),
)


def useless(contact: Contact, why: str) -> str:
    """Return why no connection with a port of C++ YARP is made; `why` is a fact of the carrier."""
    return f'"{contact.name or contact.address}" is a port of C++ YARP, {why}'


def line(error: YarpError, to: str) -> str:
    """Return the line to answer when connecting to `to` fails with `error`. The first row that fits
    counts."""
    form = next(form for kind, form, _ in _TABLE if isinstance(error, kind))
    if reach(to.partition(":")[0]).topic and not form.endswith("{why}"):
        form += ": {why}"  # C++ YARP knows no such targets, nor lines for them
    return form.format(to=to, why=error)


def error(line: str, what: str) -> YarpError:
    """Return the error that the answer `line` of a port to the request `what` stands for. What is
    like no other row is a reason of that port's own."""
    kind: type[YarpError] = AccessRefused if line.startswith(REFUSED) else NotAllowed
    for _, form, meant in _TABLE:
        start = form.partition("{")[0]
        if start and line.startswith(start):
            kind = meant
    return kind(f"{what} was refused: {line or 'no answer'}")
