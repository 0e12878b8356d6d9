"""Log forwarding: what a program logs, as messages of its port `/log/HOST/PROGRAM/PID`.

    YARP_FORWARD_LOG_ENABLE=1 python my_program.py      and anywhere in the network: yarpy log

Rules: names, messages and variables are those of C++ YARP, and so is the one attempt to connect to
`/yarplogger`. It begins with the first port of a program. Whatever Python's logging makes a record
of is handed to a thread, so nobody who logs waits, and no handler of the program is touched. Who
comes late gets the last LINES; who is slower than the log is told how much is missing.
What the network itself logs is not forwarded: that would be about the forwarding, too.
"""

from __future__ import annotations

import atexit
import logging
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any, Final

from yarpy.config.configuration import flag
from yarpy.errors import LinkClosed, YarpError
from yarpy.link.outbound import Outbound
from yarpy.log import logger
from yarpy.port import connecting
from yarpy.port.hub import Hub
from yarpy.port.log_line import message_of, port_name
from yarpy.port.mailbox import Latest
from yarpy.wire.message import Packet

ENABLE: Final = "YARP_FORWARD_LOG_ENABLE"
LOGGER: Final = "/yarplogger"
LINES: Final = 1000  # kept for readers that are late
PATIENCE: Final = 2.0  # seconds for a reader to take a line
NETWORK: Final = frozenset(
    ("access", "link", "names", "name_server", "port", "transports", "zenoh")
)

Open = Callable[..., Hub]

log = logger("yarpy.port")
_begun: Forwarder | None = None
_lock = threading.Lock()  # two threads may open the first port


def begin(open_: Open) -> None:
    """Forward the log of this process from now on, if its environment says so. `open_` opens a
    port. Once is enough."""
    global _begun
    if _begun is not None or not flag(os.environ, ENABLE, False):
        return
    with _lock:
        if _begun is None:
            _begun = Forwarder(open_)
            _begun.attach()
            atexit.register(end)


def end() -> None:
    """Send what is left, and forward nothing any more."""
    global _begun
    with _lock:
        forwarder, _begun = _begun, None
    if forwarder is not None:
        forwarder.close()


class Forwarder:
    """Sends records to whoever reads its port, which opens with the first one."""

    def __init__(self, open_: Open) -> None:
        self._open = open_
        self._make: Callable[..., logging.LogRecord] = logging.LogRecord
        self._closed = False
        self._start_over()

    def _start_over(self) -> None:
        self._process = os.getpid()
        self._name = port_name(os.environ)
        self._lines: deque[Packet] = deque(maxlen=LINES)
        self._count = 0  # lines that were logged, the last of which are in `_lines`
        self._guard = threading.RLock()  # of these two; a signal handler may log as well
        self._news = threading.Event()
        self._thread: threading.Thread | None = None

    def attach(self) -> None:
        """Take every record that logging makes, at the levels that the program has set. A handler
        of ours would keep those away that logging and its users add where there is none."""
        self._make = logging.getLogRecordFactory()
        logging.setLogRecordFactory(self._record)

    def _record(self, *arguments: Any, **more: Any) -> logging.LogRecord:
        record = self._make(*arguments, **more)
        if not self._closed and record.name:
            self.take(record)
        return record

    def take(self, record: logging.LogRecord) -> None:
        """Keep a record for the thread that sends it. In any thread."""
        room, _, rest = str(record.name).partition(".")
        if room == "yarpy" and rest.partition(".")[0] in NETWORK:
            return
        if self._process != os.getpid():  # a child has neither this thread nor this port
            self._start_over()
        if self._thread is not None and self._thread.ident == threading.get_ident():
            return
        packet = Packet(message_of(record, self._name, os.environ))
        with self._guard:
            self._lines.append(packet)
            self._count += 1
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="yarpy log", daemon=True)
                self._thread.start()
        self._news.set()

    def close(self) -> None:
        """Send what is left, and give the name back."""
        if logging.getLogRecordFactory() == self._record:
            logging.setLogRecordFactory(self._make)
        self._closed = True
        self._news.set()
        if self._thread is not None and self._process == os.getpid():
            self._thread.join(2 * PATIENCE)

    # --- in the thread

    def _run(self) -> None:
        news = self._news
        try:
            hub = self._open(self._name, Latest(), on_connection=lambda event: news.set())
        except YarpError as error:
            self._closed = True
            log.warning("the log of this program is not forwarded: %s", error)
            return
        try:
            try:
                connecting.connect(hub, LOGGER, "fast_tcp", None)
            except YarpError:
                pass  # whoever comes later has to ask for it
            sent: dict[Outbound, int] = {}
            ended = behind = False
            while not ended:
                news.wait(PATIENCE if behind else None)
                news.clear()
                ended = self._closed
                sent = self._send_all(hub, sent)
                behind = any(number < self._count for number in sent.values())
        finally:
            hub.close()

    def _send_all(self, hub: Hub, before: dict[Outbound, int]) -> dict[Outbound, int]:
        """Bring every reader up to date. Taken and given: how many lines each of them has got."""
        sent: dict[Outbound, int] = {}
        for link in hub.outputs:
            with self._guard:
                count, lines = self._count, [*self._lines]
            first = count - len(lines)
            had = before.get(link, first)
            if had < first:
                lines.insert(0, self._gap(first - had))
                first -= 1
                had = first
            sent[link] = had + self._send(hub, link, lines[had - first :])
        return sent

    def _send(self, hub: Hub, link: Outbound, lines: list[Packet]) -> int:
        """Send these lines; how many the reader took."""
        until = time.monotonic() + PATIENCE
        for number, packet in enumerate(lines):
            try:
                if not link.send(packet, until):
                    return number
            except YarpError as error:
                hub.drop_output(link, str(error), lost=isinstance(error, LinkClosed))
                return number
        return len(lines)

    def _gap(self, lost: int) -> Packet:
        told = {"levelno": logging.WARNING, "msg": f"{lost} lines before this one are lost"}
        return Packet(message_of(logging.makeLogRecord(told), self._name, os.environ))
