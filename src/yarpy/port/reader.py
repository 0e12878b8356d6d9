"""Reading ports: the loop over what comes in, out of the mailbox or straight from the socket.

The mailbox is always right. Direct reading is a shortcut for the case that matters most, a loop
around one connection: it saves waking a second thread for every message.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

from yarpy.errors import PortClosed, Timeout, YarpError
from yarpy.link.inbound import Inbound
from yarpy.link.receiver import PATIENCE
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Latest
from yarpy.port.writer import Writer
from yarpy.wire.message import Message

# A reader that comes back within this many seconds may read the socket itself.
_QUICK = 0.005
# One that wants the newest and works longer than this between messages leaves reading to the link's
# thread, which drops what is old and keeps no sender waiting.
_NEWEST_QUICK = 0.001


class ReadingPort(Writer):
    """A port that is read from. Subclasses choose the mailbox, which is the reading policy."""

    def __init__(self, hub: Hub, spin: bool) -> None:
        super().__init__(hub)
        self._mailbox = hub.mailbox
        self._reader = Reader(hub, spin)

    def read(self, timeout: float | None = None) -> Message:
        """The next message, waiting for one if needed.

        Raises Timeout after `timeout` seconds, PortClosed if the port is closed or interrupted.
        """
        return self._reader.read(timeout)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        return self._reader.poll()

    @property
    def waiting(self) -> int:
        """Messages that came and were not read yet."""
        return self._mailbox.waiting

    def __iter__(self) -> Iterator[Message]:
        """Messages until the port is closed or interrupted."""
        try:
            while True:
                yield self.read()
        except PortClosed:
            return


class Reader:
    """Reading from a hub: out of the mailbox, or directly from the one link there is.

    The mailbox is always right. Direct reading is a shortcut for the case that matters most, a loop
    around one connection: it saves waking a second thread for every message.
    """

    def __init__(self, hub: Hub, spin: bool = False) -> None:
        self._hub = hub
        self._mailbox = hub.mailbox
        self._spin = spin
        self._sole: Inbound | None = None
        self._left = 0.0
        # Questions read straight from a link and not answered yet, each with the thread at it.
        self._asking: dict[threading.Thread, tuple[Inbound, Message]] = {}
        self._settle = getattr(hub.mailbox, "settle", None)
        self._newest = isinstance(hub.mailbox, Latest)
        self._quick = _NEWEST_QUICK if self._newest else _QUICK
        hub.on_inputs = self._look_again

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        return self._mailbox.poll()

    def _look_again(self) -> None:
        """Connections came or went: only a sole, unscheduled one may be read directly."""
        inputs = self._hub.inputs
        sole = inputs[0] if len(inputs) == 1 and not inputs[0].carrier.connectionless else None
        old, self._sole = self._sole, sole
        if old is not None and old is not sole:
            old.wanted = False

    def read(self, timeout: float | None) -> Message:
        """See Port.read."""
        deadline = None if timeout is None else time.monotonic() + timeout
        self._finish()
        late = self._newest and self._was_long()
        while True:
            link = self._sole
            if link is not None and link.wanted and not self._hub.mailbox.waiting:
                message = self._directly(link, deadline, late)
                if message is not None:
                    return message
            elif link is not None and link.sched.policy < 1 and self._is_quick():
                link.wanted = True
            message = self._from_mailbox(link, deadline)
            if message is not None:
                self._left = time.perf_counter()
                return message
            if deadline is not None and time.monotonic() >= deadline:
                raise Timeout(f'nothing came to "{self._hub.name}" within {timeout} s')

    def _was_long(self) -> bool:
        """Whether the reader was away for so long that it gives the turn up if it kept a sender
        waiting.

        Not before it has looked itself once more: the newest is there, while the link's thread
        would begin with the oldest. Who wants every message keeps the turn: a busy writer in the
        same process makes every turn of its reader late, and handing each message over by another
        thread would make it later still.
        """
        link = self._sole
        if link is None or not link.wanted or self._spin:
            return False
        return time.perf_counter() - link.visited > self._quick

    def _is_quick(self) -> bool:
        """Whether the reader comes back fast enough to be worth the turn."""
        return self._spin or time.perf_counter() - self._left < self._quick

    def _from_mailbox(self, link: Inbound | None, deadline: float | None) -> Message | None:
        left = None if deadline is None else max(0.0, deadline - time.monotonic())
        if link is not None and link.wanted:
            # The turn may become free at any moment; do not sleep past it.
            left = PATIENCE if left is None else min(left, PATIENCE)
        return self._mailbox.take(left)

    def _directly(self, link: Inbound, deadline: float | None, late: bool) -> Message | None:
        hub = self._hub
        if not link.borrow():
            return None
        try:
            late = late and not link.idle()
            while not (self._mailbox.waiting or self._mailbox.stopped) and link.wanted:
                until = deadline
                if until is not None and until - time.monotonic() > PATIENCE:
                    until = None
                message = link.fetch(until, self._spin, self._newest)
                if message is not None:
                    if message.answer is not None:
                        if self._settle is None:
                            link.settle(message)
                        else:
                            self._asking[threading.current_thread()] = link, message
                    if hub.mailbox.stopped:
                        hub.mailbox.put(link, message)  # which drops and counts it
                        _leave_unanswered(link, message)
                        return None
                    return message
                if deadline is not None and time.monotonic() >= deadline:
                    return None
            return None
        finally:
            link.give_back()
            if late:
                link.release()

    def _finish(self) -> None:
        """This thread is done with the message it took last, and threads that ended with theirs."""
        if self._settle is not None:
            self._settle()
        if not self._asking:
            return
        own = threading.current_thread()
        for thread in tuple(self._asking):
            if thread is own or not thread.is_alive():
                link, message = self._asking.pop(thread, (None, None))
                if link is not None and message is not None:
                    _leave_unanswered(link, message)


def _leave_unanswered(link: Inbound, message: Message) -> None:
    try:
        link.settle(message)
    except YarpError:
        pass  # who asked has gone
