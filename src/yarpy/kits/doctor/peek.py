"""Peek: what a port sends just now, seen by becoming one of its readers for a moment.

Rules: the port sends to us as to any reader that dialled it; we take messages at once, so nobody
waits for us, and leave after the first, or after a second. Nothing else changes for it. What comes
has a size limit.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Final

from yarpy.contact import Contact
from yarpy.data.stamp import Stamp
from yarpy.errors import Timeout, YarpError
from yarpy.limit import DOCTOR_MESSAGE
from yarpy.link.begin.handshake import greet
from yarpy.link.receive.receiver import Receiver
from yarpy.names.default import secret
from yarpy.route import Route
from yarpy.wire import framing

TIMEOUT: Final = 1.0  # seconds
NAME: Final = "doctor"  # without a slash, so that it displaces nobody


@dataclass(frozen=True, slots=True)
class Peek:
    """A message that a port wrote: the name of its type ("" for no message), bytes, its stamp,
    and the time of arrival (seconds since 1970). `error` says why nothing is known."""

    kind: str = ""
    size: int = 0
    stamp: Stamp | None = None
    time: float = 0.0
    error: str = ""


def peek(contact: Contact, timeout: float = TIMEOUT) -> Peek:
    """Look at the next message that a port writes."""
    try:
        route = Route(NAME, contact.name, "tcp")
        driver, carrier = greet(contact, route, key=secret(), limit=DOCTOR_MESSAGE, timeout=timeout)
    except (YarpError, OSError) as error:
        return Peek(error=str(error))
    try:
        driver.stream.write(*framing.encode_text_command("r"))
        driver.flush(time.monotonic() + timeout)
        receiver = Receiver(driver, carrier)
        message = receiver.advance(time.monotonic() + timeout)
        came = time.time()
        receiver.settle(message)
        receiver.send_acks()
        return Peek(kind_of(message), len(message.payload), message.stamp, came)
    except Timeout:
        return Peek()
    except (YarpError, OSError) as error:
        return Peek(error=str(error))
    finally:
        driver.transport.close()


def kind_of(message: object) -> str:
    """The type of a message's value; "data" where it cannot be told."""
    try:
        return type(message.value).__name__  # type: ignore[attr-defined]
    except YarpError:
        return "data"
