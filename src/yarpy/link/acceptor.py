"""Acceptor: the thread of a port that takes new connections.

Rules: a connection costs a thread only once it has said something, so a thousand silent ones cost a
thousand file numbers and nothing else. When those run out, the one silent for longest is closed.
"""

from __future__ import annotations

import errno
import socket
import threading
import time
from collections.abc import Callable
from typing import Final

from yarpy.log import logger
from yarpy.transports.tcp import TcpListener

log = logger("yarpy.link")

MAX_SILENT: Final = 4096
_FULL: Final = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)


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
        self._silent: dict[int, socket.socket] = {}
        self.thread = threading.Thread(target=self._run, name=f"yarpy {name}", daemon=True)
        self.thread.start()

    def _run(self) -> None:
        listener = self._listener
        try:
            while not listener.closed:
                for number in listener.wait(self._silent, None):
                    sock = self._silent.pop(number, None)
                    if sock is not None:
                        self._wake(sock)
                    elif not listener.closed:
                        self._accept()
        finally:
            listener.release()
            for sock in self._silent.values():
                sock.close()

    def _accept(self) -> None:
        try:
            sock, _ = self._listener.accept()
        except OSError as error:
            if error.errno in _FULL and not self._drop_oldest():
                log.error("%s: cannot take more connections: %s", self._name, error.strerror)
                time.sleep(0.1)
            return
        if self._speaks_first:
            self._start(sock)
            return
        if len(self._silent) >= MAX_SILENT:
            self._drop_oldest()
        self._silent[sock.fileno()] = sock

    def _wake(self, sock: socket.socket) -> None:
        """Serve a connection that has sent something; one that only hung up was a probe."""
        try:
            if sock.recv(1, socket.MSG_PEEK):
                self._start(sock)
                return
        except OSError:
            pass
        sock.close()

    def _drop_oldest(self) -> bool:
        for number in self._silent:
            self._silent.pop(number).close()
            log.warning("%s: too many silent connections, the oldest was closed", self._name)
            return True
        return False

    def _start(self, sock: socket.socket) -> None:
        thread = threading.Thread(
            target=self._serve, args=(sock,), name=f"yarpy {self._name} <- ?", daemon=True
        )
        try:
            thread.start()
        except RuntimeError as error:  # the system has no more threads
            log.error("%s: a connection is refused: %s", self._name, error)
            sock.close()

    def abandon(self) -> None:
        """Close this process's copies of the sockets, in a forked process without our thread."""
        self._listener.release()
        for sock in self._silent.values():
            sock.close()

    def close(self) -> None:
        """Stop listening; connections that are being served are not touched."""
        self._listener.close()
        if threading.current_thread() is not self.thread:
            self.thread.join(5.0)
