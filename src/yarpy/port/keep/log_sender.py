"""Log sender: a port that tells whoever reads it what was logged, also those who come late.

Rules: who puts lines in never waits; a thread sends them. Who comes late gets the last ones that
are kept; who is slower than the log is told how much is missing. It connects once, by itself, to
the logger if that is there; others have to ask.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
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
TIMEOUT: Final = 2.0  # seconds for a reader to take a line
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
        self._lines: deque[Packet] = deque(maxlen=LINES if kept is None else kept)
        self._count = 0  # lines that came, the last of which are in `_lines`
        self._guard = threading.RLock()  # of these two; a signal handler may log as well
        self._news = Waiter()
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
            if self._thread is None and not self.closed:
                self._thread = Thread(target=self._run, name="yarpy log", daemon=True)
                self._thread.start()
        self._news.wake()

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
        try:
            if self._target:
                try:
                    connecting.connect(hub, self._target, "fast_tcp")
                except YarpError:
                    pass  # whoever comes later has to ask for it
            sent: dict[Outbound, int] = {}
            ended = behind = False
            while not ended:
                if not behind:
                    news.wait()
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
        for link in hub.outputs.links:
            with self._guard:
                count, lines = self._count, [*self._lines]
            first = count - len(lines)
            had = before.get(link, first)
            if had < first:
                lines.insert(0, self._gap(first - had))
                first -= 1
                had = first
            part = lines[had - first : had - first + _BATCH]
            took = self._send(hub, link, part)
            stuck = stuck or took < len(part)
            sent[link] = had + took
        return sent, stuck

    def _send(self, hub: Hub, link: Outbound, lines: list[Packet]) -> int:
        """Send these lines; how many the reader took."""
        until = time.monotonic() + TIMEOUT
        for number, packet in enumerate(lines):
            try:
                if not link.send(packet, until):
                    return number
            except YarpError as error:
                hub.outputs.drop(link, str(error), lost=isinstance(error, LinkClosed))
                return number
        return len(lines)
