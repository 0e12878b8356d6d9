"""TLS: a TCP connection that nobody on the way can read or change. TLS 1.3 of the standard library.

Rules: an SSL object is for one thread at a time, and no thread waits for the network while it holds
the object: so that stands between two buffers in memory, a reader may wait while others send, and
records leave in the order in which they were made. The peer's certificate is checked, with the name
or address that was dialled. Errors are OSError, as everywhere in this room.
"""

from __future__ import annotations

import socket
import ssl
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from yarpy.transports.opener import CONNECT_TIMEOUT, MeetingPlace, Opener
from yarpy.transports.socket_transport import MSG_DONTWAIT
from yarpy.transports.tcp import TcpTransport, dial
from yarpy.transports.tls_setting import folder, mutual
from yarpy.wire.stream import Buffer

_RAW: Final = 1 << 17  # bytes that are taken from the socket at once
_PIECE: Final = 1 << 15  # bytes that are encrypted at once, while the peer decrypts the last ones


class NoCertificate(OSError):
    """There is no certificate, or it cannot be used; the text says what to do."""


class TlsTransport(TcpTransport):
    """A connected TCP socket with TLS on it, after `shake_hands`.

    `host`: the name or address that we dialled; empty: we were dialled. `asks_names`: a peer that
    dialled us is asked for a certificate, and may go without.
    """

    scheme = "tls"
    secure = True

    def __init__(self, sock: socket.socket, host: str = "", asks_names: bool = False) -> None:
        super().__init__(sock)
        self.host = host
        self._incoming, self._outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
        context = client_context() if host else server_context(asks_names)
        self._tls = context.wrap_bio(
            self._incoming, self._outgoing, server_side=not host, server_hostname=host or None
        )
        self._lock = threading.RLock()  # of the SSL object
        self._sending = threading.Lock()
        self._reading = threading.Lock()
        self._raw = memoryview(bytearray(_RAW))
        self._over = False  # the peer has said goodbye
        self._unsent: list[Buffer] = []  # records for which there was no room
        self._ahead = memoryview(b"")  # read ahead to see whether the peer has gone
        self._timeout: float | None = None  # seconds for a record, as for each wait

    def shake_hands(self, deadline: float) -> None:
        """The TLS handshake. Raises ssl.SSLError, and BlockingIOError when it takes too long."""
        try:
            while True:
                try:
                    self._tls.do_handshake()
                    break
                except ssl.SSLWantReadError:
                    self._leave()
                left = deadline - time.monotonic()
                if left <= 0:
                    raise BlockingIOError("the peer is silent")
                self.limit_waiting(left)
                if not self.wait_readable(left):
                    raise BlockingIOError("the peer is silent")
                if not self._take(super().recv_into(self._raw)):
                    raise ConnectionResetError("the peer hung up instead of speaking TLS")
        finally:
            self._leave()  # also the alert, which tells the peer what is wrong
            self.limit_waiting(None)

    @property
    def peer_names(self) -> tuple[str, ...]:
        """The names in the peer's certificate, of its subject and the alternative ones; none if it
        showed none that our authority has signed."""
        found: Any = self._tls.getpeercert() or {}
        subject = [
            value
            for part in found.get("subject", ())
            for kind, value in part
            if kind == "commonName"
        ]
        others = [value for _, value in found.get("subjectAltName", ()) if isinstance(value, str)]
        return tuple(dict.fromkeys([*subject, *others]))

    # -- bytes ------------------------------------------------------------------------------------

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._timeout = seconds
        super().limit_waiting(seconds, sends)

    def use(self, sock: socket.socket) -> None:
        super().use(sock)
        self.recv_call = self.send_call = None  # there is TLS between the system and us
        # One call into C where the system has one, for the sake of signals.
        polling = self._polling
        self._receive: Callable[..., int] = sock.recv_into if polling is None else polling.recv_into

    def recv_into(self, view: memoryview) -> int:
        with self._reading:
            due = 0.0
            came = [0]
            try:
                while (count := self._decrypted(view, came[0])) < 0:
                    came = []
                    limit = self._timeout
                    if limit is not None:  # signals must not make it longer, as they do inside
                        left = due - time.monotonic() if due else limit
                        if not self.wait_readable(left):
                            raise BlockingIOError("the peer is slow")
                    came.extend(map(self._receive, (self._raw,)))
                    if not came[0]:
                        return 0
                    if limit is not None and not due:  # a record may come byte by byte
                        due = time.monotonic() + limit
            except OSError:
                raise
            except BaseException:
                if came:  # a signal came while a record was read, not while one was waited for
                    self.interrupt()
                raise
            return count

    def try_recv_into(self, view: memoryview) -> int:
        if not self._reading.acquire(blocking=False):
            return -1  # another thread reads, or the frame beneath this signal handler
        try:
            fresh = 0
            while (count := self._decrypted(view, fresh)) < 0:
                fresh = super().try_recv_into(self._raw)
                if fresh <= 0:
                    return fresh
            return count
        finally:
            self._reading.release()

    def send(self, buffers: Sequence[Buffer]) -> None:
        with self._sending:
            if self._unsent:
                super().send(self._unsent)
                self._unsent = []
            for piece in _pieces(buffers):
                self.send_all([self._encrypted(piece)])

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        with self._sending:
            self._unsent = super().try_send(self._unsent)
            pieces = iter(_pieces(buffers))
            while not self._unsent and (piece := next(pieces, None)) is not None:
                self._unsent = super().try_send([self._encrypted(piece)])
            return [b"", *pieces] if self._unsent else []

    def _encrypted(self, piece: Buffer) -> bytes:
        with self._lock:
            self._tls.write(piece)
            return self._outgoing.read()

    def ended(self) -> bool:
        if not self._reading.acquire(blocking=False):
            return False  # another thread reads, and will notice
        try:
            if self._ahead:
                return False
            store = memoryview(bytearray(1 << 14))
            fresh = 0
            while (count := self._decrypted(store, fresh)) < 0:
                try:
                    fresh = super().try_recv_into(self._raw)
                except OSError:
                    return True
                if fresh <= 0:
                    return not fresh
            self._ahead = store[:count]
            return not count
        finally:
            self._reading.release()

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        """Nobody can say: the system counts records, not what is in them."""
        return None

    def close(self) -> None:
        """Say goodbye, if that takes no waiting, and hang up."""
        if self.sock.fileno() >= 0 and self._sending.acquire(blocking=False):
            try:
                with self._lock:
                    try:
                        self._tls.unwrap()
                    except ssl.SSLError:
                        pass  # the peer's goodbye is not waited for
                    self.sock.send(self._outgoing.read(), MSG_DONTWAIT)
            except (OSError, ValueError):
                pass
            finally:
                self._sending.release()
        super().close()

    # -- inside -----------------------------------------------------------------------------------

    def _take(self, count: int) -> int:
        """`count` bytes came from the socket."""
        with self._lock:
            self._incoming.write(self._raw[:count])
        return count

    def _leave(self) -> None:
        """Send what the SSL object has written on its own account."""
        records = self._outgoing.read()
        if records:
            self.send_all([records])

    def _decrypted(self, view: memoryview, fresh: int = 0) -> int:
        """Bytes that have come, of which `fresh` ones of the socket have not been looked at; 0 at
        the end, -1: more must come first."""
        if self._ahead:
            count = min(len(view), len(self._ahead))
            view[:count] = self._ahead[:count]
            self._ahead = self._ahead[count:]
            return count
        total, size = 0, len(view)
        with self._lock:
            if fresh:
                self._incoming.write(self._raw[:fresh])
            # Looking is cheaper than the exception of a read that finds nothing.
            while total < size and (self._incoming.pending or self._tls.pending()):
                try:
                    got: Any = self._tls.read(size - total, view[total:] if total else view)
                except ssl.SSLWantReadError:
                    break
                except ssl.SSLZeroReturnError:
                    self._over = True
                    break
                total += got
            return total or self._over - 1


def _pieces(buffers: Sequence[Buffer]) -> Iterable[Buffer]:
    """The same bytes in pieces of a good size: none empty, the small ones in one."""
    if sum(map(len, buffers)) > _PIECE:
        return _cut(buffers)
    joined = b"".join(buffers)
    return (joined,) if joined else ()


def _cut(buffers: Sequence[Buffer]) -> Iterator[Buffer]:
    for buffer in buffers:
        view = memoryview(buffer).cast("B")
        for start in range(0, len(view), _PIECE):
            yield view[start : start + _PIECE]


def dial_tls(host: str, port: int, timeout: float = CONNECT_TIMEOUT) -> TlsTransport:
    """Connect to a port with TLS. Raises OSError: as `dial`, ssl.SSLError, NoCertificate."""
    deadline = time.monotonic() + timeout
    return secured(dial(host, port, timeout).sock, host, deadline)


def secured(
    sock: socket.socket, host: str, deadline: float, asks_names: bool = False
) -> TlsTransport:
    """Begin TLS on an existing connection. `host` empty: we were dialled. Raises as `dial_tls`; the
    connection is closed then."""
    try:
        made = TlsTransport(sock, host, asks_names)
        made.shake_hands(deadline)
    except BaseException:
        sock.close()
        raise
    return made


def explained(error: OSError) -> str:
    """Return what went wrong with TLS, and what to do."""
    if isinstance(error, ssl.SSLCertVerificationError):
        return (
            f"its certificate is not valid: {error.verify_message}. The authority is ca.pem in "
            f"{folder()}, the names are those of `yarpy cert` there"
        )
    if isinstance(error, ssl.SSLError):
        return f"no TLS: {error.reason or error.strerror or error}"
    if isinstance(error, ConnectionError):
        return (
            f"the peer hung up when TLS was to begin ({error.strerror or error}): most likely its "
            "computer has no certificate, which `yarpy cert` makes there, as its log says"
        )
    return str(error)


# -- certificates ---------------------------------------------------------------------------------


def server_context(asks_names: bool = False) -> ssl.SSLContext:
    """The context for connections that we accept. Raises NoCertificate.

    `asks_names`: a peer with a certificate is known by it; without an authority to check it against
    there is nothing to ask.
    """
    where = folder()
    age = _age(where)
    wish = ssl.CERT_OPTIONAL if asks_names and age[2] else ssl.CERT_NONE
    return _server(where, ssl.CERT_REQUIRED if mutual() else wish, age)


def client_context() -> ssl.SSLContext:
    """The context for connections that we dial. Raises NoCertificate."""
    where = folder()
    return _client(where, _age(where))


def _age(where: Path) -> tuple[float, ...]:
    """Return the time when each file changed, 0 for a missing one."""
    names = ("cert.pem", "key.pem", "ca.pem")
    files = [where / name for name in names]
    return tuple(file.stat().st_mtime if file.is_file() else 0.0 for file in files)


@lru_cache(maxsize=8)
def _server(where: Path, wish: ssl.VerifyMode, age: tuple[float, ...]) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_3
    context.num_tickets = 0  # connections last long; no session is resumed
    if not _own(context, where, age):
        raise NoCertificate(
            f"there is no cert.pem with key.pem in {where}: `yarpy cert` makes both"
        )
    if wish != ssl.CERT_NONE:
        if not age[2]:
            raise NoCertificate(f"there is no ca.pem in {where} to check others against")
        context.load_verify_locations(where / "ca.pem")
        context.verify_mode = wish
    return context


class _LineSocket(ssl.SSLSocket):
    """As that of `names.line`, in TLS."""

    __del__ = ssl.SSLSocket.close


@lru_cache(maxsize=8)
def _client(where: Path, age: tuple[float, ...]) -> ssl.SSLContext:
    authority = str(where / "ca.pem") if age[2] else None
    try:
        context = ssl.create_default_context(cafile=authority)
    except OSError as error:
        raise NoCertificate(f"{authority} cannot be used: {error}") from error
    context.minimum_version = ssl.TLSVersion.TLSv1_3
    context.sslsocket_class = _LineSocket
    _own(context, where, age)
    return context


def _own(context: ssl.SSLContext, where: Path, age: tuple[float, ...]) -> bool:
    """Give the context our certificate, if we have one."""
    if not (age[0] and age[1]):
        return False
    try:
        context.load_cert_chain(where / "cert.pem", where / "key.pem")
    except OSError as error:
        raise NoCertificate(f"cert.pem and key.pem in {where} cannot be used: {error}") from error
    return True


class Tls(Opener):
    """Another connection to the same peer, in TLS as the first one."""

    name = "tls"

    @classmethod
    def meet(cls, place: MeetingPlace) -> TlsTransport:
        through = place.through
        assert isinstance(through, TlsTransport)
        return dial_tls(through.host or through.remote[0], through.remote[1], place.timeout)
