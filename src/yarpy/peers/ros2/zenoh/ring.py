"""Ring: the newest messages of a topic, for one thread that waits for them in Zenoh itself.

Where a callback in a thread of Zenoh hands a message to the thread that reads, two threads have to
wake up one behind the other, and both need Python's lock; here one does.

Rules: waits in Zenoh have no limit, so an alarm wakes who waits: by a delete of the topic's own key
with the attachment `WAKE`, for this session alone. A reader that does not wait gets none, so none
pushes a message out; there is one ring for a key in a session (`Participant.claim`), and whoever
else hears the key there passes over what has that attachment.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Final

from yarpy import fork
from yarpy.log import logger
from yarpy.peers.zenoh.library import CALLS, WAKE
from yarpy.peers.zenoh.tunnel.alarm import CLOCK

log = logger("yarpy.ros2")

SPARE: Final = 4  # places beyond those for messages: WAKEs that came too late


class Ring:
    """A subscription, and its messages. `lock`: of the one who reads; `woken`: something else is
    to be looked at; `error`: what Zenoh raises. `left` is called when it is taken back."""

    def __init__(self, session: Any, key: str, kept: int, left: Callable[[], object]) -> None:
        from zenoh import ZError
        from zenoh.handlers import RingChannel

        self.error = ZError
        self.lock = CALLS.new_lock()
        self.woken = False
        self.most = kept + SPARE
        self._session, self._key, self._left = session, key, left
        self._deadline: float | None = None  # of the wait
        self._waiting = False
        self._alarm = 0.0  # when the clock rings, 0: it does not
        self._subscriber = session.declare_subscriber(key, RingChannel(self.most))
        handler = self._subscriber.handler
        self._recv = handler.recv
        #: The next sample, None where there is none yet. Raises `error`.
        self.look: Callable[[], Any] = handler.try_recv
        _OPEN[id(self)] = self

    def wait(self, deadline: float | None) -> Any:
        """Return the next sample; None if it was `woken`. At `deadline` (of time.monotonic) a WAKE
        comes. Raises `error` once it is taken back, or the session is closed."""
        self._deadline, self._waiting = deadline, True
        try:
            if deadline is not None and not 0 < self._alarm <= deadline:
                self._alarm = deadline
                CLOCK.set(deadline, self._ring)
            return None if self.woken else self._recv()
        finally:
            self._waiting = False

    def _ring(self) -> None:
        """In the thread of the clock."""
        self._alarm = 0.0
        deadline = self._deadline
        if not self._waiting or deadline is None:
            return
        if deadline > time.monotonic():  # of a later wait
            self._alarm = deadline
            CLOCK.set(deadline, self._ring)
        else:
            self.wake()

    def wake(self) -> None:
        """Have who waits return. Any thread may call, and a signal handler."""
        self.woken = True
        if not self._waiting:
            return
        try:
            if threading.current_thread() is threading.main_thread():  # also when the program ends
                self._send()
            else:
                with CALLS:
                    self._send()
        except Exception as error:  # the session is closed, which wakes everybody
            log.debug("not woken: %s", error)

    def _send(self) -> None:
        import zenoh

        local = zenoh.Locality.SESSION_LOCAL
        self._session.delete(self._key, attachment=WAKE, allowed_destination=local)

    def undeclare(self) -> None:
        """Take it back; what waits there is lost."""
        _OPEN.pop(id(self), None)
        self._left()
        self._subscriber.undeclare()


_OPEN: Final[dict[int, Ring]] = {}
_lost: Final[list[Ring]] = []


def _wake_all() -> None:
    """The program ends: nobody waits for what comes any more."""
    for ring in [*_OPEN.values()]:
        ring.wake()


def _lose_all() -> None:
    """In a forked process there are no sessions, and nobody may even close them."""
    _lost.extend(_OPEN.values())
    _OPEN.clear()


CALLS.waking.append(_wake_all)
fork.after_in_child(_lose_all)
