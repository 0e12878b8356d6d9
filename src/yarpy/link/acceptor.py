"""Acceptor: the thread of a port that takes new connections.

Rules: a connection costs a thread only once it has said what it speaks, in eight bytes, so a
thousand silent ones cost a thousand file numbers and nothing else (`Lobby`). How many are served
is limited (`Occupancy`). The last file numbers are the program's (`Descriptors`): when they run
short, the connection silent for longest is closed; if none is silent, the port takes none for a
while.
"""

from __future__ import annotations

import errno
import selectors
import socket
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Final

from yarpy.carriers.base import MAGIC_SIZE
from yarpy.link.descriptors import Descriptors
from yarpy.link.episode import Episode
from yarpy.link.lobby import Lobby
from yarpy.link.occupancy import Occupancy
from yarpy.log import logger
from yarpy.transports.base import MSG_DONTWAIT
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
        self._name = name
        self._serve = serve
        self._speaks_first = speaks_first
        self.occupancy = Occupancy(name)
        self._lobby = Lobby(self.occupancy.share)
        self._descriptors = Descriptors()
        self._crowded = Episode(name, "fewer silent connections wait again")
        self._short = Episode(name, "takes connections again, there are free file descriptors")
        self._paused = False
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener.sock, selectors.EVENT_READ)
        self.thread = threading.Thread(target=self._run, name=f"yarpy {name}", daemon=True)
        self.thread.start()

    def _run(self) -> None:
        listener, lobby = self._listener, self._lobby
        try:
            while not listener.closed:
                left = lobby.left()
                if self._paused:
                    left = AGAIN if left is None else min(AGAIN, left)
                for key, _ in self._selector.select(left):
                    if key.fileobj is listener.sock:
                        self._accept()
                    else:
                        assert isinstance(key.fileobj, socket.socket)
                        self._wake(key.fileobj)
                for sock in lobby.overdue():
                    self._let_go(sock)
                if self._paused:
                    self._look_again()
        finally:
            self._selector.close()
            listener.release()
            lobby.clear()

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
            self._selector.unregister(self._listener.sock)

    def _look_again(self) -> None:
        if not self._listener.closed and self._descriptors.take():
            self._paused = False
            self._selector.register(self._listener.sock, selectors.EVENT_READ)
            if self._descriptors.plenty:
                self._short.over()

    # -- those that are silent --------------------------------------------------------------------

    def _enter(self, sock: socket.socket, address: str) -> None:
        """Let a connection wait for its first words."""
        other = self._lobby.crowded(address)
        if other is not None:
            self._crowded.happened("too many silent connections, the oldest are closed")
            self._let_go(other)
        with suppress(OSError):
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVLOWAT, MAGIC_SIZE)
        self._lobby.enter(sock, address)
        self._selector.register(sock, selectors.EVENT_READ)

    def _drop_oldest(self) -> bool:
        oldest = self._lobby.oldest()
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
        self._selector.unregister(sock)
        address = self._lobby.leave(sock)
        if 2 * len(self._lobby) < self.occupancy.share:
            self._crowded.over()
        return address

    def _wake(self, sock: socket.socket) -> None:
        """Serve a connection that has said what it speaks; one that only hung up was a probe."""
        if sock.fileno() < 0:
            return  # it went a moment ago
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
        thread = threading.Thread(
            target=self._run_one, args=(sock, address), name=f"yarpy {self._name} <- ?", daemon=True
        )
        try:
            thread.start()
        except RuntimeError as error:  # the system has no more threads, or Python is ending
            if threading.main_thread().is_alive():
                log.error("%s: a connection is refused: %s", self._name, error)
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
        self._selector.close()
        self._listener.release()
        self._lobby.clear()

    def close(self) -> None:
        """Stop listening; connections that are being served are not touched."""
        self._listener.close()
        if threading.current_thread() is not self.thread:
            self.thread.join(5.0)
