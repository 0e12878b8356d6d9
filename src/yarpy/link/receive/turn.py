"""Turn: who reads a connection's socket, its own thread or, by a lease, a thread of the program.

A message that the connection's thread reads costs a hop: the reader sleeps in the mailbox and has
to be woken. A reader that comes back at once for the next message reads it itself, under a lease:

1. The reader asks. Nothing happens before the connection's thread has a message in hand.
2. That thread grants the lease to the thread that has asked, hands the message over, and parks:
   now the lease is `open`. A reader that comes back sooner waits for that.
3. Whoever has the lease reads, acknowledges and obeys commands; it is `busy` meanwhile.
4. The lease is over when nothing has come for SILENCE, when the reader stays away for AWAY, when
   another thread reads as well, when it is revoked (another connection came, the thread got a
   priority), and with the connection. The connection's thread waits until the reader is out.
5. Nothing is read while a question is open that came under the lease, though the lease may be over:
   only its answer is written then. Its end wakes the thread, as does the end of the connection.

There is no lock, which a reader that is interrupted by a signal might keep: the reader says `busy`
and then looks whether the lease is `over`; the connection's thread says `over` and then looks
whether the reader is `busy`. So one of them sees the other. For the same reason a reader touches no
Condition or Event, which have locks of their own.

The connection's thread looks every AWAY seconds, but only while messages flow: on a silent port the
lease is over, and no thread looks at a clock.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final

from yarpy.scope import Waiter

SILENCE: Final = 0.05  # seconds without a message; 20 a second are still read directly
AWAY = 0.005  # seconds that a reader may work on a message before the connection's thread reads
LEAVING: Final = 0.0005  # seconds between looks whether the reader is out


class Lease:
    """The right of one thread to read a connection, until it is over."""

    __slots__ = ("_parked", "busy", "forsaken", "main", "open", "over", "reader", "seen")

    def __init__(self, reader: int) -> None:
        self.reader = reader  # the thread's identifier
        self.main = reader == threading.main_thread().ident
        self.open = False  # the connection's thread does nothing any more
        self._parked = Waiter()
        self.busy = False  # it is reading
        self.over = False
        self.forsaken = False  # closed by a signal handler above its reader, who is not waited for
        self.seen = time.perf_counter()  # when it was here last

    def begin(self) -> None:
        """The connection's thread does nothing any more."""
        self.open = True
        self._parked.wake()

    def wait(self, seconds: float) -> bool:
        """Wait until the lease is open; return False if that takes longer."""
        self._parked.wait(seconds)
        return self.open


class Turn:
    """The right to read one connection."""

    def __init__(self) -> None:
        self.lease: Lease | None = None
        self.asked = 0  # the thread that would like a lease
        self._changed = Waiter()  # wakes the parked thread
        self._dozing = False  # it waits for the end of a question, however long that takes

    @property
    def leased(self) -> bool:
        """Return whether a reader has a lease."""
        return self.lease is not None and not self.lease.over

    # -- the connection's thread ------------------------------------------------------------------

    def grant(self) -> Lease | None:
        """Return a lease for the thread that has asked for one, or None."""
        if not self.asked:
            return None
        self.lease = lease = Lease(self.asked)
        return lease

    def park(self, lease: Lease, is_question_open: Callable[[], bool]) -> None:
        """Open a lease, and wait until it is over, and its reader and a question of it done; unless
        it is forsaken."""
        lease.begin()
        while not lease.over or (not lease.forsaken and (lease.busy or is_question_open())):
            self._dozing = True
            if not is_question_open():  # last, else its end could be missed
                self._dozing = False
            self._changed.wait(None if self._dozing else LEAVING if lease.over else AWAY)
            self._dozing = False
            if not (lease.busy or lease.over):
                gone = time.perf_counter() - lease.seen > AWAY
                if gone and not is_question_open():
                    self.asked = 0
                    lease.over = True

    # -- the reader -------------------------------------------------------------------------------

    def ask(self, reader: int) -> None:
        """Ask for a lease for this thread from the next message on."""
        self.asked = reader

    def end(self) -> None:
        """End the lease. Any thread may call."""
        self.asked = 0
        if self.lease is not None:
            self.lease.over = True
        self._changed.wake()

    def stir(self) -> None:
        """A question has come to its end."""
        if self._dozing:
            if self.lease is not None:
                self.lease.seen = time.perf_counter()
            self._changed.wake()
