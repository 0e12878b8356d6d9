"""Acceptor: takes the new connections of a port.

Rules: a port that nobody talks to costs a socket and no thread: one waits for all ports
(`accept_loop`). A connection costs a thread only once it has said what it speaks, in eight bytes,
so a thousand silent ones cost a thousand file numbers and nothing else (`Pending`). How many are
served is limited (`Occupancy`). The last file numbers are the program's (`Descriptors`): when they
run short, the connection silent for longest is closed; if none is silent, the port takes none for
a while.
"""

from __future__ import annotations

import errno
import socket
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Final

from yarpy.facts import MAGIC_SIZE
from yarpy.link.begin.accept_loop import LOOP
from yarpy.link.begin.descriptors import Descriptors, allowed
from yarpy.link.begin.occupancy import Occupancy
from yarpy.link.begin.pending import Pending
from yarpy.link.cores import cores
from yarpy.link.flapping import Flapping
from yarpy.log import logger
from yarpy.threads import Thread
from yarpy.transports.socket_transport import MSG_DONTWAIT
from yarpy.transports.tcp import TcpListener

log = logger("yarpy.link")

AT_ONCE: Final = 64  # connections that are accepted before those that wait are looked at
AGAIN: Final = 0.25  # seconds until a port without descriptors looks for some again
_FULL: Final = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)
# Where the system does not wait for the whole word, the connection's thread does.
_ENOUGH: Final = MAGIC_SIZE if sys.platform != "win32" else 1
_PEEK: Final = int(socket.MSG_PEEK) | MSG_DONTWAIT


class Acceptor:
    """Listens on `port` (0: any free one) and hands each connection that speaks to `serve`.

    `speaks_first` is set when the accepting side must say the first word (a key exchange). Raises
    OSError if the port number is taken.
    """

    def __init__(
        self,
        name: str,
        port: int,
        serve: Callable[[socket.socket], None],
        speaks_first: bool = False,
    ) -> None:
        self._listener = TcpListener(port)
        self.port = self._listener.port
        self.name = name
        self._serve = serve
        self._speaks_first = speaks_first
        self.occupancy = Occupancy(name)
        self._pending = Pending(self.occupancy.share)
        self._descriptors = Descriptors()
        self._crowded = Flapping(name, "fewer silent connections wait again")
        self._short = Flapping(name, "takes connections again, there are free file descriptors")
        self._paused = False
        self._gone = False  # no socket is left
        # Free once that is so. An Event takes a lock in Python code, where an exception out of a
        # signal handler would leave it taken, and our thread, which serves all ports, would wait.
        self._gate = threading.Lock()
        self._gate.acquire()
        cores(), allowed()  # asked here, so that the first connection does not wait for it
        try:
            LOOP.enter(self._listener.sock, self)
        except BaseException:
            self._listener.release()
            raise

    @property
    def thread_id(self) -> int:
        """The kernel's id of the thread that waits for connections."""
        return (LOOP.thread and LOOP.thread.native_id) or -1

    # -- what the loop calls ----------------------------------------------------------------------

    def ready(self, sock: socket.socket) -> None:
        """Somebody comes, or speaks."""
        if sock is self._listener.sock:
            self._accept()
        else:
            self._wake(sock)
        self.look()

    def left(self) -> float | None:
        """Seconds until something is to be done though nobody speaks."""
        if self._gone:
            return None
        left = self._pending.left()
        if self._paused:
            left = AGAIN if left is None else min(AGAIN, left)
        return left

    def look(self) -> None:
        """Let those go who have been silent for too long; or all, if the port is closed."""
        if self._listener.closed:
            self._leave_all()
            return
        for sock in self._pending.overdue():
            self._let_go(sock)
        if self._paused:
            self._look_again()

    def _leave_all(self) -> None:
        if self._gone:
            return
        for sock in self._pending:
            LOOP.forget(sock)
        if not self._paused:
            LOOP.forget(self._listener.sock)
        self._listener.release()
        self._pending.clear()
        LOOP.leave(self)
        self._say_gone()

    # -- taking them ------------------------------------------------------------------------------

    def _accept(self) -> None:
        for _ in range(AT_ONCE):
            if self._listener.closed or not self._find_descriptor():
                return
            try:
                sock, (address, _) = self._listener.accept()
            except BlockingIOError:
                return
            except OSError as error:
                if error.errno in _FULL and not self._drop_oldest():
                    self._pause(error.strerror or "no resources")
                return
            if self._speaks_first:
                self._start(sock, address)
            else:
                self._enter(sock, address)

    def _find_descriptor(self) -> bool:
        if self._descriptors.take():
            if self._descriptors.plenty:
                self._short.over()
            return True
        if self._drop_oldest():
            return True
        self._pause("the last free file descriptors are the program's")
        return False

    def _pause(self, why: str) -> None:
        """Take none, until some are free again."""
        self._short.happened("takes no connections for now: %s (ulimit -n)", why)
        if not self._paused:
            self._paused = True
            LOOP.forget(self._listener.sock)

    def _look_again(self) -> None:
        if not self._listener.closed and self._descriptors.take():
            self._paused = False
            LOOP.watch(self._listener.sock, self)
            if self._descriptors.plenty:
                self._short.over()

    # -- those that are silent --------------------------------------------------------------------

    def _enter(self, sock: socket.socket, address: str) -> None:
        """Let a connection wait for its first words."""
        other = self._pending.crowded(address)
        if other is not None:
            self._crowded.happened("too many silent connections, the oldest are closed")
            self._let_go(other)
        with suppress(OSError):
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVLOWAT, MAGIC_SIZE)
        self._pending.enter(sock, address)
        LOOP.watch(sock, self)

    def _drop_oldest(self) -> bool:
        oldest = self._pending.oldest()
        if oldest is None:
            return False
        self._short.happened(
            "file descriptors run short: silent connections are closed (ulimit -n)"
        )
        self._let_go(oldest)
        return True

    def _let_go(self, sock: socket.socket) -> None:
        self._leave(sock)
        sock.close()

    def _leave(self, sock: socket.socket) -> str:
        LOOP.forget(sock)
        address = self._pending.leave(sock)
        if 2 * len(self._pending) < self.occupancy.share:
            self._crowded.over()
        return address

    def _wake(self, sock: socket.socket) -> None:
        """Serve a connection that has said what it speaks; one that only hung up was a probe."""
        if sock.fileno() < 0 or self._listener.closed:
            return  # it went a moment ago, or goes with all others
        address = self._leave(sock)
        try:
            if len(sock.recv(MAGIC_SIZE, _PEEK)) >= _ENOUGH:
                with suppress(OSError):
                    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVLOWAT, 1)
                self._start(sock, address)
                return
        except OSError:
            pass
        sock.close()

    # -- those that speak -------------------------------------------------------------------------

    def _start(self, sock: socket.socket, address: str) -> None:
        if not self.occupancy.admit(address):
            sock.close()
            return
        thread = Thread(
            target=self._run_one, args=(sock, address), name=f"yarpy {self.name} <- ?", daemon=True
        )
        try:
            thread.start()
        except RuntimeError as error:  # the system has no more threads, or Python is ending
            if threading.main_thread().is_alive():
                log.error("%s: a connection is refused: %s", self.name, error)
            self.occupancy.leave(address)
            sock.close()

    def _run_one(self, sock: socket.socket, address: str) -> None:
        try:
            self._serve(sock)
        finally:
            self.occupancy.leave(address)

    # -- ending -----------------------------------------------------------------------------------

    def abandon(self) -> None:
        """Close this process's copies of the sockets, in a forked process without our thread."""
        self._listener.release()
        self._pending.clear()
        self._say_gone()

    def _say_gone(self) -> None:
        self._gone = True
        with suppress(RuntimeError):  # it was said
            self._gate.release()

    def close(self) -> None:
        """Stop listening; connections that are being served are not touched."""
        self._listener.close()
        waits = threading.current_thread() is not LOOP.thread and not self._gone
        if waits and self._gate.acquire(timeout=5.0):
            self._gate.release()  # for whoever waits as well
