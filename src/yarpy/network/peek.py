"""Peek: a look at what a port writes, from outside and without slowing it down.

Rules: the looking side dials the port and asks to read (`r`), so that the port takes it for a
passing reader, and cuts it off if it stops reading. A thread of its own reads at once whatever
comes and keeps the newest message. A port that answers questions writes none: `questions` shows
what it was asked and what it said to that, a pair in each message (`+log.in`).
"""

from __future__ import annotations

import contextlib
import time
from typing import Final, Self

from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.limit import PEEK_MESSAGE
from yarpy.link.begin.handshake import greet
from yarpy.link.receive.receiver import Receiver
from yarpy.names.default import secret
from yarpy.route import Route
from yarpy.threads import Thread
from yarpy.wire import framing
from yarpy.wire.message import CALL, DATA, Message

NAME: Final = "peek"  # no name of a port: it displaces no connection
TIMEOUT: Final = 2.0  # seconds for the port to let us in


class Peek:
    """The newest message of the port at `contact`, until `close`.

    Raises LinkClosed, Timeout, AccessRefused.
    """

    def __init__(self, contact: Contact, questions: bool = False) -> None:
        route = Route(NAME, contact.name, "fast_tcp+log.in" if questions else "fast_tcp")
        self._driver, carrier = greet(
            contact, route, key=secret(), limit=PEEK_MESSAGE, timeout=TIMEOUT
        )
        self._receiver = Receiver(self._driver, carrier)
        self._newest: Message | None = None
        self.count = 0  # messages that came
        self.at = 0.0  # when the newest did, of time.monotonic
        self.ended = ""  # why nothing comes any more
        try:
            self._driver.stream.write(*framing.encode_text_command("r"))
            self._driver.flush(time.monotonic() + TIMEOUT)
        except BaseException:
            self._driver.transport.close()
            raise
        self._thread = Thread(target=self._run, name=f"yarpy peek {contact.name}")
        self._thread.daemon = True
        self._thread.start()

    @property
    def newest(self) -> Message | None:
        """The newest message; None before the first."""
        return self._newest

    def close(self) -> None:
        """Look no longer."""
        with contextlib.suppress(OSError):
            self._driver.transport.interrupt()
        self._thread.join(1.0)
        self._driver.transport.close()

    def _run(self) -> None:
        try:
            while True:
                message = self._receiver.advance(None)
                if message.key not in (DATA, CALL):
                    self.ended = "the port ends the connection"
                    return
                self._receiver.release()
                self._newest = message
                self.count += 1
                self.at = time.monotonic()
        except (YarpError, OSError) as error:
            self.ended = str(error) or "the port ends the connection"
        finally:
            self._driver.transport.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()
