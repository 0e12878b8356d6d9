"""The server of a page lets in so many, from one other computer only a part of them, and waits a
limited time for what they ask.

Rules: a request is there VIEW_SECONDS after its connection was opened or its last answer was sent,
however slowly its bytes come; else the connection ends. What is done with it is the handler's
(`server`), which calls `expect` and `has_come`.
"""

from __future__ import annotations

import socket
import threading
import time
from collections import Counter
from contextlib import suppress
from http.server import ThreadingHTTPServer
from typing import Any, Final

from yarpy.limit import VIEW_CLIENTS, VIEW_SECONDS
from yarpy.link.begin.admission import same_computer
from yarpy.log import logger

FROM_ELSEWHERE: Final = VIEW_CLIENTS // 4  # connections from one other computer

log = logger("yarpy.view")


class LimitedServer(ThreadingHTTPServer):
    """Has a thread for each connection."""

    daemon_threads = True
    block_on_close = False
    request_queue_size = 64

    def __init__(self, address: tuple[str, int], handler: Any) -> None:
        self._lock = threading.Lock()  # of both
        self._open: Counter[str] = Counter()  # connections by where they come from
        self._due: dict[socket.socket, float] = {}  # until when a request has to come
        super().__init__(address, handler)

    def expect(self, connection: socket.socket) -> None:
        """A request begins to be waited for."""
        with self._lock:
            self._due[connection] = time.monotonic() + VIEW_SECONDS

    def has_come(self, connection: socket.socket) -> None:
        """The request is there."""
        with self._lock:
            self._due.pop(connection, None)

    def service_actions(self) -> None:
        """End connections whose request has not come; called several times a second."""
        now = time.monotonic()
        with self._lock:
            late = [one for one, until in self._due.items() if until < now]
            for one in late:
                del self._due[one]
                with suppress(OSError):
                    one.shutdown(socket.SHUT_RDWR)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Let a connection in, or end it."""
        where = client_address[0]
        here = same_computer(where, request.getsockname()[0])
        with self._lock:
            some, all_ = self._open[where], self._open.total()
            room = all_ < VIEW_CLIENTS and (here or some < FROM_ELSEWHERE)
            if room:
                self._open[where] += 1
        if room:
            super().process_request(request, client_address)
            return
        log.warning("a page at %s is turned away: %d connections are open", where, all_)
        self.shutdown_request(request)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Serve a connection to its end."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            where = client_address[0]
            with self._lock:
                self._due.pop(request, None)
                self._open[where] -= 1
                if not self._open[where]:
                    del self._open[where]

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Errors of a connection are no errors of the program."""
        log.debug("a page has gone", exc_info=True)
