"""Connections through Zenoh: being called, and calling.

    @yarp/here/ZID          token: the program of that session is there
    @yarp/open/ZID/PORT     question "MY-ZID MY-PIPE YOUR-PIPE": opens a pipe with these two ends
    @yarp/pipe/ZID/PIPE     messages to the reader of that end (`zenoh_pipe`)
    @yarp/ctl/ZID/PIPE      and to this exchange, of how they are taken

`ZID.zenoh` is such a program as the host of an address, and PORT the number of one of its ports:
`a1b2.zenoh:10002`. There is one exchange for a session.

Rules: the names of pipes cannot be guessed. When the token of a program vanishes, because it or a
router on the way ended, its pipes are broken on both sides; so neither side uses a pipe before it
has seen the token of the other. Threads of Zenoh bring what comes and wait for nothing; a port that
is called answers in a thread of its own.
"""

from __future__ import annotations

import errno
import re
import secrets
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from yarpy import fork
from yarpy.limit import number_in
from yarpy.log import logger
from yarpy.peers.zenoh.address import ZENOH, host_zid, zid_host
from yarpy.peers.zenoh.library import CALLS, load
from yarpy.peers.zenoh.transport import SharedSession, share
from yarpy.peers.zenoh.tunnel.line import ZenohLine, undeclare
from yarpy.peers.zenoh.tunnel.pipe import ZenohPipe

if TYPE_CHECKING:
    pass

log = logger("yarpy.zenoh")

MOST: Final = 1024  # pipes of a program that others opened
POLL_INTERVAL: Final = 0.05  # seconds between looks whether it is still wanted
LIVELINESS_TIMEOUT: Final = 5.0  # seconds for the token of a caller to come

_HELLO = re.compile(rb"([0-9a-f]{1,32}) ([0-9a-f]{16}) ([0-9a-f]{16})")

Welcome = Callable[[ZenohPipe], object]


class _Peer:
    """A program at the other end of pipes."""

    def __init__(self) -> None:
        self.pipes: set[str] = set()
        self.watcher: Any = None
        self.seen = threading.Event()  # its token


class Exchange:
    """The connections of a session. `join` opens it, `leave` gives it back."""

    def __init__(self, shared: SharedSession) -> None:
        self.shared = shared.again()
        self.session = shared.session
        self.zid = shared.zid
        self.users = 0
        self._doors: dict[int, Welcome] = {}
        self._pipes: dict[str, ZenohPipe] = {}
        self._peers: dict[str, _Peer] = {}  # session -> that program
        self._lock = threading.RLock()
        self._declared: list[Any] = []

    def open(self) -> None:
        """Be there for others."""
        callback = load().handlers.Callback
        self._declared = [
            self.session.declare_subscriber(
                f"@yarp/ctl/{self.zid}/*", callback(self._told, indirect=False)
            ),
            self.session.declare_queryable(
                f"@yarp/open/{self.zid}/*", callback(self._called, indirect=False)
            ),
            self.session.liveliness().declare_token(f"@yarp/here/{self.zid}"),
        ]

    def close(self) -> None:
        """Nobody uses it any more."""
        for thing in self._declared:
            undeclare(thing)
        self.shared.close()

    # -- being called -----------------------------------------------------------------------------

    def listen(self, port: int, welcome: Welcome) -> Callable[[], None]:
        """Let others call the port of that number; `welcome` is called in a thread of its own for
        each. Returns what ends that."""
        with self._lock:
            self._doors[port] = welcome

        def stop() -> None:
            with self._lock:
                if self._doors.get(port) is welcome:
                    del self._doors[port]

        return stop

    def _called(self, query: Any) -> None:
        """Somebody calls. Runs in a thread of Zenoh."""
        try:
            said = _HELLO.fullmatch(query.payload.to_bytes() if query.payload else b"")
            number = str(query.key_expr).rpartition("/")[2]
            port = number_in(number, 65535) or 0
            with self._lock:
                welcome = self._doors.get(port)
                full = len(self._pipes) >= MOST
            if said is None or welcome is None or full:
                query.reply_err(b"full" if full else b"nobody listens on that number")
                return
            zid, other, own = (item.decode() for item in said.groups())
            answer = str(query.key_expr)
        except Exception as error:
            log.debug("a call could not be answered: %s", error)
            return
        threading.Thread(
            target=self._admit,
            args=([query], answer, welcome, port, zid, own, other),
            name=f"yarpy welcome {zid[:8]}{ZENOH}",
            daemon=True,
        ).start()

    def _admit(
        self,
        queries: list[Any],
        answer: str,
        welcome: Welcome,
        port: int,
        zid: str,
        own: str,
        other: str,
    ) -> None:
        """Answer the only one of `queries`: the caller waits until nobody has it any more."""
        try:
            with CALLS:
                pipe = self._make(zid, own, other, port, 0)
                queries.pop().reply(answer, b"")
        except Exception as error:  # the session was closed, or the caller knows no good names
            log.debug("a call could not be answered: %s", error)
            return
        if self._is_seen(zid, pipe, LIVELINESS_TIMEOUT):
            welcome(pipe)
        else:
            pipe.break_off("the caller was not seen")
            pipe.close()

    # -- calling ----------------------------------------------------------------------------------

    def call(self, zid: str, port: int, timeout: float) -> ZenohPipe:
        """A pipe to a port of the program of that session. Raises OSError."""
        own, other = secrets.token_hex(8), secrets.token_hex(8)
        with CALLS:
            pipe = self._make(zid, own, other, 0, port)
        try:
            self._ask(f"@yarp/open/{zid}/{port}", f"{self.zid} {own} {other}", timeout)
            if not self._is_seen(zid, pipe, timeout):
                raise TimeoutError("it answers over Zenoh, but its token is not seen")
        except BaseException:
            pipe.break_off("it was never open")
            pipe.close()
            raise
        return pipe

    def _ask(self, key: str, hello: str, timeout: float) -> None:
        zenoh = load()
        place = self.shared.place
        if place.routers and not self.session.info.routers_zid():
            raise OSError(errno.ENETUNREACH, f"the Zenoh router at {place} does not answer")
        with CALLS:
            replies = [
                *self.session.get(
                    key,
                    zenoh.handlers.FifoChannel(16),
                    payload=hello,
                    target=zenoh.QueryTarget.ALL,
                    consolidation=zenoh.ConsolidationMode.NONE,
                    timeout=timeout,
                )
            ]
        if any(reply.ok is not None for reply in replies):
            return
        if not replies:
            raise OSError(errno.EHOSTUNREACH, "no such program is known to the Zenoh routers")
        told = replies[0].err.payload.to_string() if replies[0].err else ""
        if told == "Timeout":
            raise TimeoutError("it does not answer over Zenoh")
        raise ConnectionRefusedError(errno.ECONNREFUSED, told[:100] or "it refuses")

    # -- pipes ------------------------------------------------------------------------------------

    def _make(self, zid: str, own: str, other: str, port: int, far: int) -> ZenohPipe:
        """A pipe that is known by its name `own` here, and `other` there. Raises OSError."""
        with self._lock:
            if own in self._pipes:
                raise OSError(errno.EADDRINUSE, "there is such a pipe")
            line = ZenohLine(self.session, f"{self.zid}/{own}", f"{zid}/{other}")
            line.left = lambda: self._forget(zid, own)
            pipe = ZenohPipe((zid_host(self.zid), port), (zid_host(zid), far), line)
            self._pipes[own] = pipe
            peer = self._peers.setdefault(zid, _Peer())
            peer.pipes.add(own)
            watched, peer.watcher = peer.watcher, peer.watcher or True
        with _lock:
            self.users += 1
        if watched is None:
            peer.watcher = self.session.liveliness().declare_subscriber(
                f"@yarp/here/{zid}",
                load().handlers.Callback(lambda sample: self._seen(peer, sample), indirect=False),
                history=True,
            )
            if not peer.pipes:  # it was closed meanwhile
                undeclare(peer.watcher)
        return pipe

    def _forget(self, zid: str, own: str) -> None:
        with self._lock:
            self._pipes.pop(own, None)
            peer = self._peers.get(zid, _Peer())
            peer.pipes.discard(own)
            last = not peer.pipes
            if last:
                self._peers.pop(zid, None)
        if last and peer.watcher is not None:
            undeclare(peer.watcher)
        _leave(self)

    def _told(self, sample: Any) -> None:
        """Something about a pipe. Runs in a thread of Zenoh."""
        pipe = self._pipes.get(str(sample.key_expr).rpartition("/")[2])
        if pipe is not None:
            pipe.told(sample.payload.to_bytes())

    def _is_seen(self, zid: str, pipe: ZenohPipe, timeout: float) -> bool:
        """Wait for the token of a program while the pipe stands; return whether it has come."""
        peer = self._peers.get(zid)
        deadline = time.monotonic() + timeout
        while peer is not None and not peer.seen.wait(POLL_INTERVAL):
            if pipe.ended() or time.monotonic() > deadline:
                return False
        return peer is not None

    def _seen(self, peer: _Peer, sample: Any) -> None:
        """A program came or went. Runs in a thread of Zenoh."""
        if sample.kind == load().SampleKind.PUT:
            peer.seen.set()
            return
        peer.seen.clear()
        with self._lock:
            pipes = [self._pipes[own] for own in peer.pipes if own in self._pipes]
        for pipe in pipes:
            pipe.break_off("the program at the other end, or a router on the way, is gone")


# -- the exchanges of this process ----------------------------------------------------------------

_open: dict[str, Exchange] = {}  # session -> its exchange
_routes: OrderedDict[str, str] = OrderedDict()  # session of others -> the one of ours that knows it
_lock = threading.RLock()
_lost: list[Exchange] = []


def join(shared: SharedSession) -> Exchange:
    """The exchange of a session; to be left by `leave`."""
    with _lock:
        found = _open.get(shared.zid)
        if found is not None:
            found.users += 1
            return found
        found = _open[shared.zid] = Exchange(shared)
        found.users = 1
    found.open()
    return found


def leave(exchange: Exchange) -> None:
    """Give back what `join` gave."""
    with _lock:
        exchange.users -= 1
        if exchange.users or _open.get(exchange.zid) is not exchange:
            return
        del _open[exchange.zid]
    exchange.close()


_leave = leave


def know(zid: str, own: str) -> None:
    """A session that was found by our session `own`."""
    with _lock:
        _routes[zid] = own
        _routes.move_to_end(zid)
        if len(_routes) > MOST:
            _routes.popitem(last=False)


def dial_inside(host: str, port: int, timeout: float) -> ZenohPipe:
    """Connect to `ZID.zenoh`. Raises OSError, and as `share` if no session is open here."""
    zid = host_zid(host)
    with _lock:
        found = _open.get(_routes.get(zid, "")) or next(iter(_open.values()), None)
    if found is not None:
        return found.call(zid, port, timeout)
    with share() as shared:
        exchange = join(shared)
        try:
            return exchange.call(zid, port, timeout)
        finally:
            leave(exchange)


def _wake_all() -> None:
    """The program ends: nobody waits for what comes any more."""
    for exchange in list(_open.values()):
        for pipe in list(exchange._pipes.values()):
            pipe.interrupt()


CALLS.waking.append(_wake_all)


def _lose_all() -> None:
    """In a forked process there are no sessions."""
    global _lock
    _lock = threading.RLock()
    _lost.extend(_open.values())  # whose end would wait for threads that are not here
    _open.clear()
    _routes.clear()


fork.after_in_child(_lose_all)
