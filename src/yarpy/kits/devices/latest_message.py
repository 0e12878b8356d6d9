"""The latest message of a remote output, as long as it is fresh.

Rules: only the latest counts; it is decoded once, on first access. Access before the first message
waits for it; a timeout says why none came. After a sender restarts, its output is connected again.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import Generic, TypeVar

from yarpy.errors import Timeout, YarpError
from yarpy.kits.devices.closeable import Closeable
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.wire.message import Message

T = TypeVar("T")


class LatestMessage(Closeable, Generic[T]):
    """Listens to the port `source`. `timeout`: seconds after which a message no longer counts."""

    def __init__(
        self,
        source: str,
        local: str,
        carrier: str,
        timeout: float,
        names: NameClient | None,
        decode: Callable[[Message], T],
    ) -> None:
        self.source = source
        self._carrier = carrier
        self._timeout = timeout
        self._decode = decode
        self._changed = threading.Condition()  # guards the three below
        self._message: Message | None = None
        self._arrival = 0.0
        self._count = 0
        self._known: tuple[Message, T] | None = None
        with ExitStack() as resources:
            self._port = resources.enter_context(
                BufferedPort(local, callback=self._take, names=names)
            )
            self._listen()
            self._resources = resources.pop_all()

    def value(self) -> T:
        """The latest message. Raises Timeout (nothing fresh), DecodeError."""
        message = self._fresh()
        known = self._known
        if known is None or known[0] is not message:
            known = self._known = message, self._decode(message)
        return known[1]

    def time(self) -> float:
        """Its time: the sender's, or else the time of arrival. Raises Timeout."""
        message = self._fresh()
        stamp = message.stamp
        if stamp is not None:
            return stamp.time
        return time.time() - (time.monotonic() - self._arrival)

    def renew(self) -> None:
        """Wait until `value` is newer than this call, at most the timeout."""
        with self._changed:
            # The next message may have been measured before this call; the one after it was not.
            enough = self._count + 2
            self._changed.wait_for(lambda: self._count >= enough, self._timeout)

    def _take(self, message: Message) -> None:
        with self._changed:
            self._message, self._arrival = message, time.monotonic()
            self._count += 1
            self._changed.notify_all()

    def _fresh(self) -> Message:
        if not self._port.inputs:
            self._listen_again()
        if not self._is_fresh():
            with self._changed:
                self._changed.wait_for(self._is_fresh, self._timeout)
        message = self._message
        if message is None or not self._is_fresh():
            raise Timeout(
                f'nothing came from "{self.source}" for {self._timeout} s: the robot has stopped '
                "or publishes more slowly (then use a larger timeout)"
            )
        return message

    def _is_fresh(self) -> bool:
        return self._message is not None and time.monotonic() - self._arrival <= self._timeout

    def _listen_again(self) -> None:
        """Connect again after the connection was lost: perhaps the sender was restarted."""
        try:
            self._listen()
        except YarpError as error:
            if not self._is_fresh():
                raise Timeout(f'nothing comes from "{self.source}": {error}') from error

    def _listen(self) -> None:
        self._port.listen_to(self.source, self._carrier)
        self._port.wait_for_inputs(1, self._timeout)  # it dials us
