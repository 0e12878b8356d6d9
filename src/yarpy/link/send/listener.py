"""Listener: what a reader says while we write to it, as its protocol has it say.

Rules: between messages, under the sender's lock; never while acknowledgements are due, or while the
reader does not take what was sent before. A protocol that sees its rules broken ends the
connection, after its last words. A reader that has promised signs of life (`idle_timeout`) and
gives none is taken for gone.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from yarpy.errors import RemoteProtocolError, Timeout, YarpError
from yarpy.link.ending import NEVER, NOW, moment
from yarpy.link.send.sender import Hold
from yarpy.log import logger

if TYPE_CHECKING:
    from yarpy.link.send.sender import Sender
    from yarpy.wire.steps import Steps

log = logger("yarpy.link")

MOST: Final = 64  # reads at a time
ATTENTION: Final = 0.5  # seconds of each wait for a reader to say something
TIMEOUT: Final = 0.1  # seconds for the protocol's answer to leave


class Listener:
    """Of one connection; `steps` is what its protocol does."""

    def __init__(self, sender: Sender, steps: Steps[None]) -> None:
        self._sender = sender
        self._driver = sender.driver
        self._steps = steps

    def attend(self) -> None:
        """Hear what the reader says as soon as it does, in this thread, until the end."""
        transport = self._driver.transport
        if transport.sock is None:
            return
        self.hear(ATTENTION)  # some of it may have come with the greeting
        silence = self._sender.carrier.limits.idle_timeout
        heard, since = self._driver.bytes_in, time.monotonic()
        while not self._sender.broken:
            before = self._driver.bytes_in
            if before != heard:
                heard, since = before, time.monotonic()
            elif silence is not None and time.monotonic() - since > silence:
                self._miss(silence)
            if transport.wait_readable(ATTENTION):
                since = time.monotonic()  # it may wait for somebody who is sending
                self.hear(ATTENTION)
                if self._driver.bytes_in == before and not self._sender.broken:
                    time.sleep(TIMEOUT)  # somebody is sending to a peer that takes nothing

    def hear(self, timeout: float = 0.0) -> None:
        """Let the protocol deal with what the reader said meanwhile, unless others are sending for
        longer than that."""
        sender = self._sender
        until = time.monotonic() + timeout if timeout else NOW
        hold = Hold(sender, until, NEVER)
        try:
            hold.take()
            if not hold.held:
                return  # next time
            if sender.broken or sender.window.open:
                return  # what comes then may be an acknowledgement
            if sender.halfway:
                return  # nobody is answered who does not take what was sent before
            try:
                self._answer()
            except (StopIteration, YarpError) as end:
                if isinstance(end, RemoteProtocolError):
                    sender.reason, route = str(end), sender.route
                    log.warning("%s: %s is disconnected: %s", route.source, route.target, end)
                self._say_last_words()
                sender.give_up()
        finally:
            hold.give()

    def _miss(self, silence: float) -> None:
        """End the connection to a reader that gives no signs of life."""
        sender = self._sender
        sender.reason = f"it has given no sign of life for {silence:g} s"
        route = sender.route
        log.warning("%s: %s is disconnected: %s", route.source, route.target, sender.reason)
        sender.fail()

    def _answer(self) -> None:
        """Let the protocol take what there is, and send what it says to that. Raises
        StopIteration, and what the protocol raises, at the end of the connection."""
        sender, driver = self._sender, self._driver
        next(self._steps)
        for _ in range(MOST):
            if not driver.try_fill():
                break
            next(self._steps)
        if sender.carrier.delivery.at_once:
            if not sender.flush(NOW):
                sender.follow()
        elif not driver.send(moment(TIMEOUT)):
            raise Timeout("the reader does not take the answer")

    def _say_last_words(self) -> None:
        try:
            self._driver.send(moment(TIMEOUT))
        except YarpError:
            pass  # the peer has gone
