"""The accept loop: one thread that waits for new connections, for all ports of the process.

Rules: what it calls returns soon and waits for nobody; what fails there is logged, and the other
ports go on. The thread lives while there are ports. A forked process has none of its parent's:
`start_over`.
"""

from __future__ import annotations

import selectors
import socket
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Final, Protocol

from yarpy.log import logger
from yarpy.threads import Thread

log = logger("yarpy.link")

BRAKE: Final = 0.1  # seconds of rest after a failure, which might come again and again

# Whether a thread that waits already sees a socket that another one adds; if not, it is woken.
_SEES_MORE: Final = selectors.DefaultSelector.__name__ in ("EpollSelector", "KqueueSelector")


class ListeningPort(Protocol):
    """The listening socket of one port, and what to do with its connections. It is called in the
    loop's thread only."""

    @property
    def name(self) -> str:
        """For people: whose it is."""

    def ready(self, sock: socket.socket, /) -> None:
        """One of its sockets has something to read."""

    def left(self) -> float | None:
        """Seconds until `look` is to be called; None: not at all."""

    def look(self) -> None:
        """The time is over."""


class AcceptLoop:
    """Watches the sockets of ports. `enter` may be called by any thread, the rest by those that
    the loop calls."""

    def __init__(self) -> None:
        self._selector: selectors.BaseSelector | None = None
        self._waker: tuple[socket.socket, socket.socket] | None = None
        self.thread: threading.Thread | None = None
        self.start_over()

    def start_over(self) -> None:
        """Forget everything, in a process whose threads are gone: a forked one."""
        self._stop()
        self._lock = threading.RLock()  # of who is here, and whether there is a thread
        self._listening: set[ListeningPort] = set()
        self._due: dict[ListeningPort, float] = {}  # when `look` is to be called
        self._newcomers: deque[tuple[socket.socket, ListeningPort]] = deque()

    @property
    def listening(self) -> list[ListeningPort]:
        """All that are watched."""
        with self._lock:
            return list(self._listening)

    def enter(self, sock: socket.socket, port: ListeningPort) -> None:
        """Watch the listening socket of a new port."""
        with self._lock:
            if self.thread is None:
                self._start()
            self._listening.add(port)
            if self._waker is None:
                self.watch(sock, port)
            else:
                self._newcomers.append((sock, port))
                self._waker[1].send(b"\0")

    def watch(self, sock: socket.socket, port: ListeningPort) -> None:
        """From now on `port.ready` is called when there is something to read."""
        assert self._selector is not None
        self._selector.register(sock, selectors.EVENT_READ, port)

    def forget(self, sock: socket.socket) -> None:
        """Watch it no longer; it must still be open."""
        assert self._selector is not None
        self._selector.unregister(sock)

    def leave(self, port: ListeningPort) -> None:
        """It has no sockets any more."""
        with self._lock:
            self._listening.discard(port)

    # -- the thread -------------------------------------------------------------------------------

    def _start(self) -> None:
        self._selector = selector = selectors.DefaultSelector()
        if not _SEES_MORE:
            self._waker = socket.socketpair()
            selector.register(self._waker[0], selectors.EVENT_READ, None)
        name = "yarpy accept"
        self.thread = Thread(target=self._run, args=(selector,), name=name, daemon=True)
        try:
            self.thread.start()
        except BaseException:  # out of a signal handler it may run all the same, to its end
            self._stop()
            raise

    def _stop(self) -> None:
        if self._selector is not None:
            self._selector.close()
        for sock in self._waker or ():
            sock.close()
        self._selector = self._waker = self.thread = None

    def _run(self, selector: selectors.BaseSelector) -> None:
        while not self._is_over(selector):
            for key, _ in selector.select(self._until_due()):
                if key.data is None:
                    self._let_in()
                else:
                    assert isinstance(key.fileobj, socket.socket)
                    self._call(key.data, key.data.ready, key.fileobj)
            now = time.monotonic()
            for port in [one for one, due in self._due.items() if due <= now]:
                self._call(port, port.look)

    def _is_over(self, selector: selectors.BaseSelector) -> bool:
        """Return whether no port is left; then the thread with that selector is no longer the
        accepting one."""
        if self._listening and self._selector is selector:
            return False
        with self._lock:
            if self._selector is not selector:
                return True
            if not self._listening:
                self._stop()
            return not self._listening

    def _until_due(self) -> float | None:
        if not self._due:
            return None
        return max(0.0, min(self._due.values()) - time.monotonic())

    def _let_in(self) -> None:
        """Watch those that came while we waited."""
        assert self._waker is not None
        self._waker[0].recv(1)
        self.watch(*self._newcomers.popleft())

    def _call(self, port: ListeningPort, act: Callable[..., None], *arguments: object) -> None:
        try:
            act(*arguments)
            left = port.left()
        except Exception:
            log.exception("%s: a connection could not be accepted", port.name)
            time.sleep(BRAKE)
            left = BRAKE
        if left is None:
            self._due.pop(port, None)
        else:
            self._due[port] = time.monotonic() + left


LOOP: Final = AcceptLoop()
