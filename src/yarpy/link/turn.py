"""Turn: who reads a connection's socket, its own thread or, by a lease, the port's reader.

A message that the thread reads costs a hop: the reader sleeps in the mailbox and has to be woken. A
reader that comes back at once for the next message reads it itself, under a direct-read lease:

1. The reader asks. Nothing happens before the thread has a message in hand.
2. The thread grants the lease before it hands that message over, then it parks: when the reader
   comes back, the lock is free or about to be.
3. The thread that holds the lock reads, acknowledges and obeys commands. The reader releases it
   with each message.
4. The lease ends when nothing has come for SILENCE, when the reader stays away for AWAY, when it is
   revoked (another connection came, the thread got a priority), and with the connection.
5. Nothing is read while a question is open that came under the lease; its end wakes the thread.

The thread looks every AWAY seconds, but only while messages flow: on a silent port the lease is
over, the thread sleeps in the socket, the reader in the mailbox, and no thread looks at a clock.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final

SILENCE: Final = 0.05  # seconds without a message; 20 a second are still read directly
AWAY = 0.005  # seconds that a reader may work on a message before the thread takes over


class Turn:
    """The right to read one connection."""

    def __init__(self) -> None:
        self.lock = threading.Lock()  # its holder reads
        self.asked = False  # a reader would like the lease
        self.leased = False  # the thread leaves reading to it
        self.seen = 0.0  # when the reader was last here
        self._changed = threading.Event()  # wakes the parked thread
        self._dozing = False  # it waits for the end of a question, however long that takes

    # -- the connection's thread ------------------------------------------------------------------

    def grant(self) -> bool:
        """Let a reader that has asked read from now on; whether there is one."""
        self.seen = time.perf_counter()
        self.leased = self.asked
        return self.leased

    def park(self, is_question_open: Callable[[], bool]) -> None:
        """Wait until the lease is over."""
        while self.leased:
            self._dozing = True
            if not is_question_open():  # checked last, else the question's end could be missed
                self._dozing = False
            self._changed.wait(None if self._dozing else AWAY)
            self._dozing = False
            self._changed.clear()
            if self.leased and self.lock.acquire(blocking=False):  # else it is being read
                try:
                    gone = time.perf_counter() - self.seen > AWAY
                    if gone and not is_question_open():
                        self.asked = self.leased = False
                finally:
                    self.lock.release()

    # -- the reader -------------------------------------------------------------------------------

    def ask(self) -> None:
        """Ask for a lease from the next message on."""
        self.asked = True

    def take(self, seconds: float) -> bool:
        """Take the lock under the lease; False if there is none, or other threads keep it."""
        if not self.leased or not self.lock.acquire(timeout=seconds):
            return False
        if not self.leased:
            self.lock.release()
            return False
        return True

    def leave(self) -> None:
        """The end of `take`."""
        self.seen = time.perf_counter()
        self.lock.release()

    def end(self) -> None:
        """End the lease: the thread reads on as soon as the lock is free. Any thread may call."""
        self.asked = self.leased = False
        self._changed.set()

    def stir(self) -> None:
        """A question has come to its end."""
        if self._dozing:
            self.seen = time.perf_counter()
            self._changed.set()
