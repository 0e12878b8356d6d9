"""Between TCP and Zenoh, for programs that speak no Zenoh: C++ YARP above all.

Rules: bytes are passed on as they are, by two threads for each connection; when one side ends, both
do. A listening socket leads to one port of one program, and is kept while the gateway is open, for
those who remember its number.
"""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable
from typing import Final

from yarpy.errors import YarpError
from yarpy.log import logger
from yarpy.peers.zenoh.tunnel.exchange import dial_inside
from yarpy.peers.zenoh.tunnel.pipe import ZenohPipe
from yarpy.transports.opener import CONNECT_TIMEOUT
from yarpy.transports.tcp import TcpListener, TcpTransport, dial

MOST: Final = 1000  # ports of others that have a number here
CONNECTIONS: Final = 1000  # that are passed on at once
_PIECE: Final = 1 << 17  # bytes that are read at once

log = logger("yarpy.zenoh")
_room = threading.Semaphore(CONNECTIONS)


class Gateway:
    """Listening sockets that lead into Zenoh. `call` makes a connection there."""

    def __init__(self, call: Callable[[str, int, float], ZenohPipe] = dial_inside) -> None:
        self._call = call
        self._doors: dict[tuple[str, int], TcpListener] = {}
        self._lock = threading.RLock()

    def number(self, host: str, port: int) -> int:
        """The TCP port number here that leads to that port inside Zenoh. Raises OSError."""
        with self._lock:
            door = self._doors.get((host, port))
            if door is not None:
                return door.port
            if len(self._doors) >= MOST:
                raise OSError(f"there are {MOST} ways into Zenoh here already")
            door = self._doors[host, port] = TcpListener()
        threading.Thread(
            target=self._accept, args=(door, host, port), name=f"yarpy gateway {host}", daemon=True
        ).start()
        return door.port

    def _accept(self, door: TcpListener, host: str, port: int) -> None:
        door.sock.setblocking(True)
        try:
            while True:
                sock, _ = door.accept()
                if door.closed:
                    sock.close()
                    return
                threading.Thread(target=self._enter, args=(sock, host, port), daemon=True).start()
        except OSError as error:
            if not door.closed:
                log.warning("nobody gets to %s:%d any more: %s", host, port, error)
        finally:
            door.release()

    def _enter(self, sock: socket.socket, host: str, port: int) -> None:
        try:
            pipe = self._call(host, port, CONNECT_TIMEOUT)
        except (YarpError, OSError) as error:
            log.info("no way to %s:%d: %s", host, port, error)
            sock.close()
            return
        pass_on(TcpTransport(sock), pipe)

    def close(self) -> None:
        """Listen no more; connections go on."""
        with self._lock:
            doors, self._doors = [*self._doors.values()], {}
        for door in doors:
            door.close()


def bring(pipe: ZenohPipe, host: str, port: int) -> None:
    """Pass on what comes out of Zenoh to a TCP port, until one of the two ends."""
    try:
        tcp = dial(host, port)
    except (YarpError, OSError) as error:
        log.info("no way to %s:%d: %s", host, port, error)
        pipe.close()
        return
    pass_on(tcp, pipe)


def pass_on(tcp: TcpTransport, pipe: ZenohPipe) -> None:
    """Pass on bytes both ways until one of the two ends; close both."""
    if not _room.acquire(blocking=False):
        log.warning("more than %d connections between TCP and Zenoh: one is refused", CONNECTIONS)
        tcp.close()
        pipe.close()
        return
    try:
        back = threading.Thread(target=_move, args=(tcp, pipe), name="yarpy gateway", daemon=True)
        back.start()
        _move(pipe, tcp)
        back.join()
    finally:
        _room.release()
        tcp.close()
        pipe.close()


def _move(source: TcpTransport | ZenohPipe, target: TcpTransport | ZenohPipe) -> None:
    view = memoryview(bytearray(_PIECE))
    try:
        while count := source.recv_into(view):
            target.send([bytes(view[:count])])
    except OSError as error:
        log.debug("a connection that is passed on has ended: %s", error)
    if isinstance(target, ZenohPipe):
        target.close()  # says goodbye behind what was sent
    else:
        target.interrupt()
