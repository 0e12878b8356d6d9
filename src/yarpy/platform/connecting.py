"""A connection that is being made, and that another thread may give up.

    Linux, macOS    a socket that is shut down wakes who waits for it
    Windows         only one that is connected can be shut down: whoever waits looks in between

Rules: afterwards the socket has the time limit of the attempt; whoever made it closes it.
"""

from __future__ import annotations

import socket
import sys
from contextlib import suppress
from typing import Any

if sys.platform == "win32":
    import errno
    import select
    import threading
    import time

    from yarpy.platform.waiting import SLICE

    class Connecting:
        """An attempt to connect `sock` within `timeout` seconds."""

        def __init__(self, sock: socket.socket, timeout: float) -> None:
            self._sock = sock
            self._timeout = timeout
            self._given_up = threading.Event()

        def run(self, address: Any) -> None:
            """Connect. Raises OSError: TimeoutError, ConnectionAbortedError where it was given
            up, ConnectionRefusedError ..."""
            until = time.monotonic() + self._timeout
            self._sock.setblocking(False)
            code = self._sock.connect_ex(address)
            while code == errno.EWOULDBLOCK:
                if self._given_up.is_set():
                    raise ConnectionAbortedError("given up")
                left = until - time.monotonic()
                if left <= 0.0:
                    raise TimeoutError("timed out")
                sockets = [self._sock]
                _, ready, failed = select.select([], sockets, sockets, min(left, SLICE))
                if failed or ready:
                    code = self._sock.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
            if code:
                import ctypes

                raise ctypes.WinError(code)
            self._sock.settimeout(self._timeout)

        def give_up(self) -> None:
            """Have `run` end soon, with an error; any thread may call this."""
            self._given_up.set()

else:

    class Connecting:
        """An attempt to connect `sock` within `timeout` seconds."""

        def __init__(self, sock: socket.socket, timeout: float) -> None:
            self._sock = sock
            sock.settimeout(timeout)

        def run(self, address: Any) -> None:
            """Connect. Raises OSError: TimeoutError, another one where it was given up,
            ConnectionRefusedError ..."""
            self._sock.connect(address)

        def give_up(self) -> None:
            """Have `run` end soon, with an error; any thread may call this."""
            with suppress(OSError):  # it was not begun, or has failed
                self._sock.shutdown(socket.SHUT_RDWR)
