"""Log sender: a port that tells whoever reads it what was logged, also those who come late.

Rules: who puts lines in never waits; a thread sends them. Who comes late gets the last ones that
are kept. Who is slower than the log gets all from memory, as long as that is not more than AHEAD
lines, and is told how much is missing then. It connects once, by itself, to the logger if that is
there; others have to ask.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from itertools import islice
from typing import Final

from yarpy.errors import LinkClosed, YarpError
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.port.connect import connecting
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Latest
from yarpy.scope import Waiter
from yarpy.threads import Thread
from yarpy.wire.message import Packet

LOGGER: Final = "/yarplogger"
LINES: Final = 1000  # kept for readers that are late
AHEAD: Final = 20_000  # kept for a reader that is behind
TIMEOUT: Final = 2.0  # seconds for a reader to take a line
GATHER: Final = 0.01  # seconds between sends, where lines come without a pause
_BATCH: Final = 500  # lines sent before there is another look at who reads

Open = Callable[..., Hub]

log = logger("yarpy.port")


class LogSender:
    """Sends packets from a port called `name`, which opens with the first one.

    open_: opens a port. gap: makes the packet that stands for so many lost ones. target: what to
    connect to, once; "" for nothing. kept: packets for readers that are late, else LINES.
    """

    def __init__(
        self,
        open_: Open,
        name: str,
        gap: Callable[[int], Packet],
        target: str = "",
        kept: int | None = None,
    ) -> None:
        self._open, self._name, self._gap, self._target = open_, name, gap, target
        self.closed = False
        self._kept = LINES if kept is None else kept
        self._lines: deque[Packet] = deque()
        self._count = 0  # lines that came, the last of which are in `_lines`
        self._wanted: int | None = None  # the first of them that a reader has not got; None: none
        self._guard = threading.RLock()  # of these three; a signal handler may log as well
        self._news = Waiter()
        self._hub: Hub | None = None  # once it is open
        self._thread: threading.Thread | None = None

    @property
    def ident(self) -> int | None:
        """Return the thread that sends, None before it began."""
        return None if self._thread is None else self._thread.ident

    def put(self, packets: Sequence[Packet]) -> None:
        """Send these. In any thread; nobody waits."""
        with self._guard:
            self._lines.extend(packets)
            self._count += len(packets)
            hub = self._hub
            # Looked at when the lines are there: whoever connects from now on wakes the thread.
            idle = hub is not None and not hub.outputs.links
            if idle:
                self._wanted = None
            self._forget()
            if self._thread is None and not self.closed:
                self._thread = Thread(target=self._run, name="yarpy log", daemon=True)
                self._thread.start()
        if not idle:  # else the thread has nothing to do
            self._news.wake()

    def _forget(self) -> None:
        """Keep no more lines than somebody may want. The lock is held."""
        lines = self._lines
        surplus = len(lines) - self._kept
        if surplus > 0 and self._wanted is not None:
            unwanted = self._wanted - (self._count - len(lines))
            surplus = min(surplus, max(unwanted, len(lines) - max(AHEAD, self._kept)))
        for _ in range(surplus):
            lines.popleft()

    def open(self) -> None:
        """Open the port now, before there is anything to send."""
        self.put(())

    def close(self, seconds: float = 2 * TIMEOUT) -> None:
        """Send what is left in so many seconds, and give the name back."""
        self.closed = True
        self._news.wake()
        if self._thread is not None and self._thread.ident and seconds > 0:
            self._thread.join(seconds)

    # --- in the thread

    def _run(self) -> None:
        news = self._news
        try:
            hub = self._open(self._name, Latest(), on_connection=lambda event: news.wake())
        except YarpError as error:
            self.closed = True
            log.warning("the log of %s is not sent: %s", self._name, error)
            return
        self._hub = hub
        try:
            if self._target:
                try:
                    connecting.connect(hub, self._target, "fast_tcp")
                except YarpError:
                    pass  # whoever comes later has to ask for it
            news.wake()  # what came meanwhile
            sent: dict[Outbound, int] = {}
            ended = behind = False
            again = 0.0  # when lines are sent again: a burst leaves in few sends
            while not ended:
                if not behind:
                    news.wait()
                    if not self.closed and (rest := again - time.monotonic()) > 0:
                        time.sleep(rest)
                again = time.monotonic() + GATHER
                ended = self.closed
                sent, stuck = self._send_all(hub, sent)
                behind = any(number < self._count for number in sent.values())
                if behind and stuck and not ended:
                    news.wait(TIMEOUT)
                elif behind and not stuck:
                    ended = False  # there is more
        finally:
            hub.close()

    def _send_all(self, hub: Hub, before: dict[Outbound, int]) -> tuple[dict[Outbound, int], bool]:
        """Send every reader some of what it has not got; return how many lines each of them has
        got, and whether one took less than it could have."""
        sent: dict[Outbound, int] = {}
        stuck = False
        with self._guard:
            late = self._count - min(self._kept, len(self._lines))
            places = {link: before.get(link, late) for link in hub.outputs.links}
            self._wanted = min(places.values(), default=None)
        for link, had in places.items():
            with self._guard:
                first = self._count - len(self._lines)
                at = max(had, first)
                part = [*islice(self._lines, at - first, at - first + _BATCH)]
            gap = at > had
            if gap:
                part.insert(0, self._gap(at - had))
            took = self._send(hub, link, part)
            stuck = stuck or took < len(part)
            sent[link] = had if not took else at + took - gap
        with self._guard:
            self._wanted = min(sent.values(), default=None)
            self._forget()
        return sent, stuck

    def _send(self, hub: Hub, link: Outbound, lines: list[Packet]) -> int:
        """Send these lines; how many the reader took."""
        if lines and self._send_burst(hub, link, lines):
            return len(lines)
        until = time.monotonic() + TIMEOUT
        sender, last = link.sender, len(lines) - 1
        try:
            for number, packet in enumerate(lines):
                sender.more = number < last
                try:
                    if not link.send(packet, until):
                        return number
                except YarpError as error:
                    hub.outputs.drop(link, str(error), lost=isinstance(error, LinkClosed))
                    return number
        finally:
            sender.more = False
        return len(lines)

    def _send_burst(self, hub: Hub, link: Outbound, lines: list[Packet]) -> bool:
        """Send these lines in one piece; False where each has to be sent by itself."""
        try:
            return link.send_burst(lines)
        except YarpError as error:
            hub.outputs.drop(link, str(error), lost=isinstance(error, LinkClosed))
            return False
