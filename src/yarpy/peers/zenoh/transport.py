"""Zenoh: the one place where sessions are opened, which all that name the same place share.

    with share() as shared:                          # or share("tcp/192.168.1.2:7447")
        shared.session.put("robot/arm", b"1 2 3")

`share` says which session: all that name the same place (`zenoh_place`) use one, which is closed
when the last of them gives it back, at the latest when the program ends: behind its threads and
ports, which have something to say until then. Before it is closed its router has taken all that was
put: a router that sees the end of a connection forgets what it has not read yet.

Rules: a session opens the computer to nobody, unless its place is `lan` or a file that says so: it
is a client, does not listen, and looks for nobody by multicast. What is declared has callbacks of
`Callback(f, indirect=False)`: for others Zenoh has threads that keep a program from ending. A
process that was forked from one with a session can have none: the library's threads are not there.
"""

from __future__ import annotations

import threading
import time
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self

from yarpy import fork, linger
from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError
from yarpy.log import logger
from yarpy.peers.zenoh.config import client
from yarpy.peers.zenoh.library import CALLS, ENDING, load, plain
from yarpy.peers.zenoh.place import PORT, SETTING, Place, place
from yarpy.peers.zenoh.reason import reason

if TYPE_CHECKING:
    import zenoh

log = logger("yarpy.zenoh")

DRAIN: Final = 0.05  # seconds in which callbacks that had begun come to their end
NOBODY: Final = "@yarp/settled"  # a key at which nobody answers


class SharedSession:
    """The right to use a session, until `close`. `place`: where it goes."""

    def __init__(self, held: _Held) -> None:
        self._held = held
        self._closed = False

    @property
    def session(self) -> zenoh.Session:
        """The session, which others use too: do not close it."""
        return self._held.session

    @property
    def place(self) -> Place:
        return self._held.place

    @property
    def zid(self) -> str:
        """Zenoh's identifier of this session."""
        return self._held.zid

    def again(self) -> SharedSession:
        """Another use of the same session."""
        return _POOL.once_more(self._held)

    def close(self) -> None:
        """Give it back; idempotent. What was declared must be undeclared before."""
        if not self._closed:
            self._closed = True
            _POOL.leave(self._held)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


class _Held:
    """A session, and how many use it."""

    def __init__(self, session: zenoh.Session, where: Place) -> None:
        self.session = session
        self.place = where
        self.zid = str(session.zid())
        self.users = 0


class _Pool:
    """The sessions of this process."""

    def __init__(self) -> None:
        self._held: dict[Place, _Held] = {}
        self._lock = threading.RLock()  # held while a session opens: a second one must not
        self._watching = False
        self._lost = False  # the process was forked from one that used the library

    def take(self, where: Place) -> SharedSession:
        if self._lost:
            raise LocalProtocolError(
                "Zenoh was in use when this process was forked, and cannot be used here: start "
                'processes by multiprocessing\'s "spawn", or fork before the first port opens'
            )
        with self._lock:
            held = self._held.get(where)
            if held is None or held.session.is_closed():
                if not self._watching:
                    linger.at_last(self.close)
                    self._watching = True
                held = self._held[where] = _Held(_open(client(where), where), where)
                linger.add(self, lambda seconds: None)  # SIGTERM is heard, and closes us at last
            held.users += 1
            return SharedSession(held)

    def once_more(self, held: _Held) -> SharedSession:
        with self._lock:
            held.users += 1
            return SharedSession(held)

    def leave(self, held: _Held) -> None:
        with self._lock:
            held.users -= 1
            if held.users or self._held.get(held.place) is not held:
                return
        try:
            with CALLS:  # the program may not end meanwhile
                _settle(held.session)
                with self._lock:
                    if held.users or self._held.get(held.place) is not held:
                        return
                    del self._held[held.place]
                    if not self._held:
                        linger.remove(self)
                close(held.session)
        except ConnectionAbortedError:
            pass  # it ends, and closes all of them

    def close(self) -> None:
        """The program ends."""
        CALLS.refuse()
        with self._lock:
            all_, self._held = list(self._held.values()), {}
        for held in all_:
            _settle(held.session)
            close(held.session)
        CALLS.wait()
        if all_:
            time.sleep(DRAIN)

    def forget(self) -> None:
        """In a forked process: the sessions' threads are not here, so nobody may even close
        them."""
        for held in self._held.values():
            _immortal(held.session)
        self._lost = self._lost or self._watching
        CALLS.start_over()
        self._held, self._lock = {}, threading.RLock()


def _immortal(thing: object) -> None:
    """Never destroy it."""
    import ctypes

    ctypes.pythonapi.Py_IncRef(ctypes.py_object(thing))


_POOL: Final = _Pool()
fork.after_in_child(_POOL.forget)


def share(where: str = "") -> SharedSession:
    """The session for a place, opened if nobody here has one.

    Raises UnknownPlugin (the extra is not installed), AddressError, LinkClosed (no router there),
    RemoteProtocolError (wrong certificate), LocalProtocolError, MissingFile.
    """
    load()
    return _POOL.take(place(where))


def _settle(session: zenoh.Session) -> None:
    """Wait until the router has taken all that was put: it answers a question behind it."""
    zenoh, seconds = load(), linger.left()
    settled = threading.Event()
    try:
        session.get(
            NOBODY,
            zenoh.handlers.Callback(lambda reply: None, settled.set, indirect=False),
            priority=zenoh.Priority.BACKGROUND,  # behind all others
            timeout=seconds + 1.0,  # its own end would look like an answer
        )
    except zenoh.ZError:
        return  # it was closed
    if not settled.wait(seconds):
        log.warning("Zenoh's router may not have taken all: no answer in %.1f s", seconds)


def close(session: zenoh.Session) -> None:
    """Close a session or router that is not shared."""
    session.close()  # type: ignore[no-untyped-call]


def _open(config: Any, where: Place) -> zenoh.Session:
    try:
        with CALLS:
            session: zenoh.Session = load().open(config)
        return session
    except Exception as error:
        if CALLS.over:
            raise LinkClosed(f"no session with {where}: {ENDING}") from error
        if not where.routers:
            raise LinkClosed(f"no session with {where}: {plain(error)}") from error
        reasons = [reason(item) for item in where.routers]
        refusals = [reason for reason in reasons if isinstance(reason, RemoteProtocolError)]
        if refusals:
            raise refusals[0] from error
        raise LinkClosed(
            f"no Zenoh router answers at {where} ({'; '.join(map(str, reasons))}): start one with "
            f"`yarpy router`, or say where it is with {SETTING}=tcp/HOST:{PORT}"
        ) from error
