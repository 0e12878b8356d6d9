"""Gather: one thread that reads many connections, each of which sends little.

A message costs a connection's own thread mostly its waking and the wait for Python's lock. Where a
port only keeps what comes, one thread that waits for all of its connections does with a third.

Rules: as of a lease (`turn.py`), whose reader is the gathering thread; no clock ends it. That
thread waits for no connection: what cannot be done at once is left to the connection's own thread,
which takes the next PAUSE seconds, too. That is the rest of a message, a large message, a command,
many messages in one go, an acknowledgement that the sender has no room for, and the end.
"""

from __future__ import annotations

import selectors
import socket
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Final

from yarpy.errors import YarpError
from yarpy.link.receive.inbound import Inbound
from yarpy.link.receive.receiver import FRESH
from yarpy.link.receive.turn import LEAVING, Lease, Turn
from yarpy.log import logger
from yarpy.threads import Thread
from yarpy.transports.socket_transport import SocketTransport
from yarpy.wire.message import DATA
from yarpy.wire.stream import LARGE

log = logger("yarpy.link")

PAUSE: Final = 0.5  # seconds that a connection is read by its own thread again
MANY: Final = 32  # messages in one go; a connection acknowledges 64 at once

# Whether a thread that waits already sees a socket that another one adds.
ABLE: Final = selectors.DefaultSelector.__name__ in ("EpollSelector", "KqueueSelector")


class Gather:
    """Reads the connections that it attends. Its thread lives while one of them is silent."""

    def __init__(self) -> None:
        self._lock = threading.Lock()  # of who is watched, and whether there is a thread
        self._turns: set[GatheredTurn] = set()
        self._watch: Watch | None = None  # while there is a thread

    @property
    def watched(self) -> int:
        """Return how many connections are silent, and watched."""
        return len(self._turns)

    def attend(self, link: Inbound) -> None:
        """Read for a connection whose own thread has not begun, unless it is of a kind that is not
        read in one go."""
        transport, carrier = link.driver.transport, link.carrier
        if (
            isinstance(transport, SocketTransport)
            and transport.recv_call is not None
            and link.driver.whole
            and not carrier.delivery.connectionless
            and carrier.limits.idle_timeout is None
            and not link.guarded
        ):
            link.turn = GatheredTurn(self, link, transport.sock)

    def add(self, turn: GatheredTurn) -> None:
        """Watch a connection."""
        with self._lock:
            if self._watch is None:
                watch = Watch()
                run = partial(self._run, watch)
                Thread(target=run, name="yarpy gather", daemon=True).start()
                self._watch = watch
            self._turns.add(turn)
            self._watch.selector.register(turn.sock, selectors.EVENT_READ, turn)

    def remove(self, turn: GatheredTurn) -> None:
        """Watch it no longer, if that is not so already."""
        with self._lock:
            if turn in self._turns and self._watch is not None:
                self._turns.discard(turn)
                self._watch.selector.unregister(turn.sock)
                if not self._turns:
                    self._watch.waker.send(b"\0")
                    self._watch = None

    def _run(self, watch: Watch) -> None:
        with watch.selector, watch.waker, watch.woken:
            while True:
                for key, _ in watch.selector.select():
                    if key.data is None:
                        return  # nobody is left
                    key.data.gather()


class Watch:
    """The connections that a gathering thread waits for, and a socket that tells it to end."""

    def __init__(self) -> None:
        self.selector = selectors.DefaultSelector()
        self.woken, self.waker = socket.socketpair()
        self.selector.register(self.woken, selectors.EVENT_READ, None)


class GatheredTurn(Turn):
    """The right to read one connection, of its own thread or of the gathering one."""

    def __init__(self, gather: Gather, link: Inbound, sock: socket.socket) -> None:
        super().__init__()
        self.sock = sock
        self._gather = gather
        self._link = link
        self._due = 0.0  # when it may be gathered again
        self.asked = 1  # always, but after `end`

    def grant(self) -> Lease | None:
        if time.monotonic() < self._due or self._link.chain is not None:
            return None
        self.lease = lease = Lease(0)
        return lease

    def park(self, lease: Lease, is_question_open: Callable[[], bool]) -> None:
        receiver, stream = self._link.receiver, self._link.driver.stream
        receiver.send_acks()
        if not (stream.waiting or lease.over or is_question_open()):
            self._gather.add(self)
            try:
                while not lease.over:
                    self._changed.wait(None)
            finally:
                self._gather.remove(self)
            while lease.busy and not lease.forsaken:
                self._changed.wait(LEAVING)
        lease.over = True
        self._due = time.monotonic() + PAUSE

    # -- the gathering thread ----------------------------------------------------------------------

    def gather(self) -> None:
        """Something has come: read it, or leave it to the connection's own thread."""
        lease = self.lease
        if lease is None or lease.over:
            return
        lease.reader, lease.busy = threading.get_ident(), True
        try:
            if lease.over or self._read():
                return
        except YarpError:
            pass  # the connection's own thread meets the same end at once, and reports it
        except BaseException:
            log.exception("%s: connection %s fails", self._link.owner.name, self._link.route)
            self._link.receiver.tear()
        finally:
            lease.busy = False
        self._gather.remove(self)
        lease.over = True
        self._changed.wake()

    def _read(self) -> bool:
        """Hand on what has come; return False if the connection's own thread has to go on."""
        link = self._link
        receiver, carrier, stream = link.receiver, link.carrier, link.driver.stream
        before = link.driver.bytes_in
        if not link.driver.try_fill():
            return True
        if link.driver.bytes_in == before:
            return False  # the end
        for _ in range(MANY):
            message = receiver.held = carrier.parse(stream)
            if message is None:
                return False  # there is a part of it
            if message.key != DATA or link.chain is not None:
                return False
            if message.spelling == "binary" and len(message.payload) >= LARGE:
                return False
            receiver.advance(None)
            receiver.held, receiver.stage = None, FRESH
            link.owner.receive(link, message)
            receiver.settle(message)
            if stream.head == stream.tail:
                return receiver.try_acks()
        return False
