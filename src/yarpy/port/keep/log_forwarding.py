"""Log forwarding: what a program logs, as messages of its port `/log/HOST/PROGRAM/PID`.

    YARP_FORWARD_LOG_ENABLE=1 python my_program.py      and anywhere in the network: yarpy log

Rules: names, messages and variables are those of C++ YARP, and so is the one attempt to connect to
`/yarplogger`. It begins with the first port of a program. Whatever Python's logging makes a record
of is handed to a thread, so nobody who logs waits, and no handler of the program is touched.
What the network itself logs is not forwarded: that would be about the forwarding, too.
"""

from __future__ import annotations

import atexit
import logging
import os
import threading
from collections.abc import Callable
from typing import Any, Final

from yarpy import fork
from yarpy.config.configuration import flag
from yarpy.log import logger
from yarpy.port.keep.log_line import message_of, port_name
from yarpy.port.keep.log_sender import LOGGER, TIMEOUT, LogSender, Open
from yarpy.shipped import TRANSPORTS
from yarpy.wire.message import Packet

ENABLE: Final = "YARP_FORWARD_LOG_ENABLE"
NETWORK: Final = frozenset(
    (
        *("access", "link", "names", "name_server", "port", "transports"),
        *(row.name for row in TRANSPORTS.values() if row.hosts),  # they lead to ports
    )
)

log = logger("yarpy.port")
_begun: Forwarder | None = None
_lock = fork.lock()  # two threads may open the first port


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
        # Of the start, as in C++; looking them up for each line takes longer than to write it.
        self._environment = {k: v for k, v in os.environ.items() if k.startswith("YARP_FORWARD_")}
        self._sender = LogSender(self._open, self._name, self._gap, LOGGER)

    def attach(self) -> None:
        """Take every record that logging makes, at the levels that the program has set. A handler
        of ours would keep those away that logging and its users add where there is none."""
        self._make = logging.getLogRecordFactory()
        logging.setLogRecordFactory(self._record)

    def _record(self, *arguments: Any, **more: Any) -> logging.LogRecord:
        record = self._make(*arguments, **more)
        if not (self._closed or self._sender.closed) and record.name:
            self.take(record)
        return record

    def take(self, record: logging.LogRecord) -> None:
        """Keep a record for the thread that sends it. In any thread."""
        room, _, rest = str(record.name).partition(".")
        if room == "yarpy" and rest.partition(".")[0] in NETWORK:
            return
        if self._process != os.getpid():  # a child has neither this thread nor this port
            self._start_over()
        if self._sender.ident == threading.get_ident():
            return
        self._sender.put([Packet(message_of(record, self._name, self._environment))])

    def close(self) -> None:
        """Send what is left, and give the name back."""
        if logging.getLogRecordFactory() == self._record:
            logging.setLogRecordFactory(self._make)
        self._closed = True
        self._sender.close(2 * TIMEOUT if self._process == os.getpid() else 0.0)

    def _gap(self, lost: int) -> Packet:
        told = {"levelno": logging.WARNING, "msg": f"{lost} lines before this one are lost"}
        return Packet(message_of(logging.makeLogRecord(told), self._name, self._environment))
