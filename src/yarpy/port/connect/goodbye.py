"""Goodbye: asking the ports that send to us to disconnect, before we end their connections.

Rules: without being asked they would take the end for a failure, and dial again.
Each is asked at the address that the name service knows; one that cannot be asked notices the end
by itself. Answers that are under way get a moment to leave.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence

from yarpy.errors import NoNameServer, YarpError
from yarpy.link.receive.inbound import Inbound
from yarpy.port.connect import probe
from yarpy.port.keep.registration import Registration


def ask_to_leave(registration: Registration, source: str) -> None:
    """Ask the port `source` to drop its connection to the port of `registration`.

    Raises NoNameServer if the name service does not answer.
    """
    names = registration.names
    if not source.startswith("/") or source == registration.name or names is None:
        return
    try:
        contact = names.query(source)
        if contact is not None and contact.carrier == "tcp":
            probe.drop_output(contact, registration.name, timeout=1.0, secret_=registration.key)
    except NoNameServer:
        raise
    except (YarpError, OSError):
        pass  # it will notice by itself


def ask_all_to_leave(registration: Registration, sources: Iterable[str]) -> bool:
    """Ask these ports in turn; no more once the name service does not answer. False if there is
    none any more. One that was silent for the moment that this may take may only be busy."""
    for source in sources:
        try:
            ask_to_leave(registration, source)
        except NoNameServer as error:
            return isinstance(error.__cause__, TimeoutError)
    return True


def let_answers_leave(links: Sequence[Inbound], seconds: float) -> None:
    """Wait until no question is open any more, which the end of reading has closed, and no command
    is being carried out, or `seconds` are over: a thread of the program may be holding one."""
    deadline = time.monotonic() + seconds
    for link in links:
        while link.answering and time.monotonic() < deadline:
            time.sleep(0.001)
