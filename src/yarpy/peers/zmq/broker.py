"""The broker at which ZeroMQ programs of Wrapyfi meet: one for each computer.

    XPUB bound at HOST:5555       subscribers connect
    XSUB bound at HOST:5556       publishers connect
    ZEROMQ/CONNECTIONS            a topic of its own: JSON, how many subscribe to each topic

Rules: whoever needs the broker keeps one ready. It binds if nobody else has, also later: when the
program with the broker ends, another one's takes over, and sockets find it by themselves. A forked
process has its own.
"""

from __future__ import annotations

import errno
import json
import os
import threading
from typing import TYPE_CHECKING, Any, Final

from yarpy import fork
from yarpy.log import logger

if TYPE_CHECKING:
    import zmq

log = logger("yarpy.wrap")

PORT: Final = 5555  # of the XPUB; that of the XSUB is the next
MONITOR: Final = b"ZEROMQ/CONNECTIONS"
PAUSE: Final = 0.25  # seconds between two attempts to bind
_HEARD: Final = 100  # milliseconds between two looks whether to go on
_MOST: Final = 10_000  # topics that are counted

_brokers: dict[tuple[int, str, int, int], Broker] = {}
_lock = fork.lock()  # of the brokers


def keep_ready(host: str, pub_port: int = PORT, sub_port: int = PORT + 1) -> Broker:
    """A broker at this host, or one that waits for its turn."""
    key = os.getpid(), host, pub_port, sub_port
    with _lock:
        found = _brokers.get(key)
        if found is None:
            found = _brokers[key] = Broker(host, pub_port, sub_port)
        return found


class Broker:
    """Binds when it can, and hands on what publishers send to those who have subscribed."""

    def __init__(self, host: str, pub_port: int = PORT, sub_port: int = PORT + 1) -> None:
        self._addresses = f"tcp://{host}:{pub_port}", f"tcp://{host}:{sub_port}"
        self.bound = threading.Event()
        self._tried = threading.Event()
        self._stop = threading.Event()
        self._counts: dict[str, int] = {}
        self._thread = threading.Thread(
            target=self._run, name=f"yarpy zmq broker {host}:{pub_port}", daemon=True
        )
        self._thread.start()
        self._tried.wait(5.0)

    def close(self) -> None:
        """Give the addresses free."""
        self._stop.set()
        self._thread.join(5.0)

    def _run(self) -> None:
        import zmq

        context = zmq.Context()
        try:
            while not self._stop.is_set():
                sockets = self._bind(context)
                self._tried.set()
                if sockets is None:
                    self._stop.wait(PAUSE)
                    continue
                self.bound.set()
                try:
                    self._serve(*sockets)
                finally:
                    self.bound.clear()
                    for socket in sockets:
                        socket.close(linger=0)
        finally:
            context.destroy(linger=0)

    def _bind(self, context: zmq.Context[Any]) -> tuple[zmq.Socket[Any], zmq.Socket[Any]] | None:
        import zmq

        xpub, xsub = context.socket(zmq.XPUB), context.socket(zmq.XSUB)
        xpub.setsockopt(zmq.XPUB_VERBOSE, 1)
        try:
            for socket, address in zip((xpub, xsub), self._addresses, strict=True):
                socket.bind(address)
        except zmq.ZMQError as error:
            xpub.close(linger=0)
            xsub.close(linger=0)
            if error.errno not in (errno.EADDRINUSE, zmq.EADDRINUSE):
                log.debug("no broker at %s: %s", self._addresses[0], error)
                self._stop.set()  # another computer's address
            return None
        return xpub, xsub

    def _serve(self, xpub: zmq.Socket[Any], xsub: zmq.Socket[Any]) -> None:
        import zmq

        self._counts.clear()
        poller = zmq.Poller()
        poller.register(xpub, zmq.POLLIN)
        poller.register(xsub, zmq.POLLIN)
        while not self._stop.is_set():
            ready = dict(poller.poll(_HEARD))
            if xsub in ready:
                xpub.send_multipart(xsub.recv_multipart(copy=False), copy=False)
            if xpub in ready:
                frames = xpub.recv_multipart()
                xsub.send_multipart(frames)
                self._count(frames[0], xpub)

    def _count(self, data: bytes, xpub: zmq.Socket[Any]) -> None:
        """A subscription came or went."""
        if data[:1] not in (b"\0", b"\1"):
            return
        topic = data[1:].decode("utf-8", "replace")
        if data[:1] == b"\0":
            self._counts.pop(topic, None)
            self._counts[topic] = 0
        elif data[1:] != MONITOR:
            self._counts[topic] = self._counts.get(topic, 0) + 1
        while len(self._counts) > _MOST:
            del self._counts[next(iter(self._counts))]
        xpub.send_multipart([MONITOR, json.dumps(self._counts).encode()])
