"""Listener: what a reader says while we write to it, as its protocol has it say.

Rules: between messages, under the sender's lock; never while acknowledgements are due, or while the
reader does not take what was sent before. A protocol that sees its rules broken ends the
connection, after its last words.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from yarpy.errors import RemoteProtocolError, YarpError
from yarpy.log import logger
from yarpy.transports.base import SocketTransport

if TYPE_CHECKING:
    from yarpy.link.sender import Sender
    from yarpy.wire.steps import Steps

log = logger("yarpy.link")

MOST: Final = 64  # reads at a time
ATTENTION: Final = 0.5  # seconds of each wait for a reader to say something
PATIENCE: Final = 0.1  # seconds for the protocol's answer to leave


class Listener:
    """Of one connection; `steps` is what its protocol does."""

    def __init__(self, sender: Sender, steps: Steps[None]) -> None:
        self._sender = sender
        self._driver = sender.driver
        self._steps = steps

    def attend(self) -> None:
        """Hear what the reader says as soon as it does, in this thread, until the end."""
        transport = self._driver.transport
        if not isinstance(transport, SocketTransport):
            return
        self.hear(ATTENTION)  # some of it may have come with the greeting
        while not self._sender.broken:
            before = self._driver.bytes_in
            if transport.wait_readable(ATTENTION):
                self.hear(ATTENTION)
                if self._driver.bytes_in == before and not self._sender.broken:
                    time.sleep(PATIENCE)  # somebody is sending to a peer that takes nothing

    def hear(self, timeout: float = 0.0) -> None:
        """Let the protocol deal with what the reader said meanwhile, unless others are sending for
        longer than that."""
        sender = self._sender
        if not sender.lock.acquire(timeout=timeout):
            return  # next time
        try:
            if sender.broken or sender.window.open:
                return  # what comes then may be an acknowledgement
            if sender.halfway:
                return  # nobody is answered who does not take what was sent before
            driver = self._driver
            next(self._steps)
            for _ in range(MOST):
                if not driver.try_fill():
                    break
                next(self._steps)
            if sender.carrier.delivery.at_once:
                sender.flush_at_once()
                return
            driver.transport.limit_waiting(PATIENCE)
            driver.flush()
            driver.transport.limit_waiting(None)
        except (StopIteration, YarpError) as end:
            if isinstance(end, RemoteProtocolError):
                sender.reason, route = str(end), sender.route
                log.warning("%s: %s is disconnected: %s", route.source, route.target, end)
            self._say_last_words()
            sender.give_up()
        finally:
            sender.lock.release()

    def _say_last_words(self) -> None:
        try:
            self._driver.transport.limit_waiting(PATIENCE)
            self._driver.flush()
        except YarpError:
            pass  # the peer has gone
