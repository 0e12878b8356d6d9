"""Zenoh: the one place where sessions are opened, and where it is decided to what.

    with share() as lease:                          # or share("tcp/192.168.1.2:7447")
        lease.session.put("robot/arm", b"1 2 3")

`share` says which session: all that name the same place use one, which is closed when the last of
them gives its lease back, at the latest when the program ends. A place is

    (nothing)                 what YARPY_ZENOH says, else the router of this computer
    tcp/192.168.1.2:7447      a router; or `tls/...`, `quic/...`, or `host` or `host:port` alone
    tcp/a:7447,tcp/b:7447     one of several routers, whichever answers
    lan                       no router: the peers in the local network, found by multicast
    /etc/robot.json5          a configuration file of Zenoh, as it is

Rules: a session opens the computer to nobody, unless its place is `lan` or a file that says so: it
is a client, does not listen, and looks for nobody by multicast. Routers listen where they are told
to, else on the loopback. Whatever ZENOH_CONFIG_OVERRIDE says (`key/path=json5;...`) comes last, as
with ROS 2. Certificates are those of `tls_setting`: `ca.pem` is the authority that routers are
checked against, `cert.pem` and `key.pem` are shown to a router that asks. Where YARPY_TLS requires
TLS, a place without it is refused.

Use `Callback(f, indirect=False)` of `zenoh.handlers` for subscribers: it needs no thread of Python.
A thread that waits in the library when Python ends aborts the program: put `with CALLS:` around
what waits in threads that may outlive the main one (`Subscriber.recv`, replies of `get`).
A process that was forked from one with a session can have none: the library's threads are not
there.
"""

from __future__ import annotations

import json
import os
import re
import socket
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self
from weakref import WeakSet

from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    MissingFile,
    RemoteProtocolError,
    UnknownPlugin,
)
from yarpy.transports.tls_setting import folder, mutual, required

if TYPE_CHECKING:
    import zenoh

SETTING: Final = "YARPY_ZENOH"
OVERRIDE: Final = "ZENOH_CONFIG_OVERRIDE"
PORT: Final = 7447
LAN: Final = "lan"
HERE: Final = f"127.0.0.1:{PORT}"

ENDING: Final = "the program ends"
LOOK: Final = 2.0  # seconds to find out why a router could not be reached
LAST: Final = 0.05  # seconds in which callbacks that had begun come to their end
FAREWELL: Final = 2.0  # seconds for threads to come back from Zenoh when the program ends
REFUSAL: Final = 0.5  # seconds within which a router says that it refuses a certificate
JOINING: Final = 3.0  # seconds until a router says that it is alone
# How often a router that went away is looked for: milliseconds at first, at most, and the factor.
RETRY: Final = {"period_init_ms": 500, "period_max_ms": 1000, "period_increase_factor": 1.5}

_ENDPOINT = re.compile(r"(tcp|tls|quic|udp|ws|unixsock-stream)/(.+)")
_SECURE: Final = ("tls", "quic")


@dataclass(frozen=True, slots=True)
class Place:
    """Where a session goes: to one of `routers`, or by `file`; to neither: to the local network."""

    routers: tuple[str, ...] = ()
    file: str = ""

    def __str__(self) -> str:
        return ",".join(self.routers) or self.file or "the local network"


def place(text: str = "") -> Place:
    """What a text says; "" for what YARPY_ZENOH says. Raises AddressError, LocalProtocolError."""
    text = text.strip() or os.environ.get(SETTING, "").strip() or HERE
    if text == LAN:
        if required():
            raise LocalProtocolError(
                "YARPY_TLS requires TLS, which peers that find each other by multicast do not "
                f"have: let them meet at a router, {SETTING}=tls/HOST:{PORT}"
            )
        return Place()
    if text.startswith(("/", ".", "~", "file:")):
        return Place(file=str(Path(text.removeprefix("file://")).expanduser()))
    return Place(tuple(endpoint(item) for item in re.split(r"[, ]+", text) if item))


def endpoint(text: str) -> str:
    """A router's or listener's address as Zenoh writes it.

    >>> endpoint("192.168.1.2"), endpoint("tls/robot.lab:7448")
    ('tcp/192.168.1.2:7447', 'tls/robot.lab:7448')

    Raises AddressError, LocalProtocolError.
    """
    found = _ENDPOINT.fullmatch(text)
    kind, rest = found.groups() if found else ("tls" if required() else "tcp", text)
    if kind == "unixsock-stream":
        return text
    if required() and kind not in _SECURE:
        raise LocalProtocolError(f'YARPY_TLS requires TLS: "{text}" has none, take tls/{rest}')
    where, mark, options = rest.partition("#")
    where, query, metadata = where.partition("?")
    host, colon, port = where.rpartition(":")
    if not colon or where.endswith("]"):
        host, port = where, str(PORT)
    if not (port.isascii() and port.isdigit() and len(port) < 6 and int(port) < 65536):
        port = ""
    if not host or not port or "/" in host or (":" in host and not host.startswith("[")):
        raise AddressError(
            f'"{text[:80]}" is no address for Zenoh: write tcp/HOST:{PORT} or tls/HOST:{PORT}, '
            f"{LAN}, or the path of a configuration file, in {SETTING}"
        )
    return f"{kind}/{host}:{port}{query}{metadata}{mark}{options}"


# -- sharing --------------------------------------------------------------------------------------


class Lease:
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
        """What Zenoh calls this session."""
        return self._held.zid

    def again(self) -> Lease:
        """Another lease of the same session."""
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


class Calls:
    """Threads that wait in Zenoh: the interpreter may not end meanwhile. To be used as `with
    CALLS:` around what waits there. `waking` are called when the program ends.

    Where one thread at a time waits, and often, a `seat` of its own costs less: a lock to be held
    meanwhile, by whoever has seen that it is not `over`.
    """

    def __init__(self) -> None:
        self.waking: list[Callable[[], object]] = []
        self._waiting = 0
        self.over = False
        self._lock = threading.Lock()
        self._seats = WeakSet[threading.Lock]()

    def __enter__(self) -> None:
        with self._lock:
            if self.over:
                raise ConnectionAbortedError(ENDING)
            self._waiting += 1

    def __exit__(self, *details: object) -> None:
        with self._lock:
            self._waiting -= 1

    def seat(self) -> threading.Lock:
        """A lock for one thread at a time."""
        seat = threading.Lock()
        with self._lock:
            self._seats.add(seat)
        return seat

    def refuse(self) -> None:
        """Nobody may wait any more."""
        with self._lock:
            self.over = True
        for wake in self.waking:
            wake()

    def wait(self) -> None:
        """Wait until everybody has come back, but not for ever."""
        deadline = time.monotonic() + FAREWELL
        with self._lock:
            seats = [*self._seats]
        while self._waiting or any(seat.locked() for seat in seats):
            if time.monotonic() > deadline:
                return
            time.sleep(0.001)

    def start_over(self) -> None:
        """In a forked process: those threads are not here."""
        self._waiting, self._lock, self._seats = 0, threading.Lock(), WeakSet()


CALLS: Final = Calls()


class _Pool:
    """The sessions of this process."""

    def __init__(self) -> None:
        self._held: dict[Place, _Held] = {}
        self._lock = threading.Lock()  # held while a session opens: a second one must not
        self._watching = False
        self._lost = False  # the process was forked from one that used the library

    def take(self, where: Place) -> Lease:
        if self._lost:
            raise LocalProtocolError(
                "Zenoh was in use when this process was forked, and cannot be used here: start "
                'processes by multiprocessing\'s "spawn", or fork before the first port opens'
            )
        with self._lock:
            held = self._held.get(where)
            if held is None or held.session.is_closed():
                if not self._watching:
                    # Before threads are waited for: Zenoh's own may wait for the session's end.
                    threading._register_atexit(self.close)  # type: ignore[attr-defined]
                    self._watching = True
                held = self._held[where] = _Held(_open(_client(where), where), where)
            held.users += 1
            return Lease(held)

    def once_more(self, held: _Held) -> Lease:
        with self._lock:
            held.users += 1
            return Lease(held)

    def leave(self, held: _Held) -> None:
        with self._lock:
            held.users -= 1
            if held.users or self._held.get(held.place) is not held:
                return
            del self._held[held.place]
        close(held.session)

    def close(self) -> None:
        """The program ends."""
        CALLS.refuse()
        with self._lock:
            all_, self._held = list(self._held.values()), {}
        for held in all_:
            close(held.session)
        CALLS.wait()
        if all_:
            time.sleep(LAST)

    def forget(self) -> None:
        """In a forked process: the sessions' threads are not here, so nobody may even close
        them."""
        for held in self._held.values():
            _immortal(held.session)
        self._lost = self._lost or self._watching
        CALLS.start_over()
        self._held, self._lock = {}, threading.Lock()


def _immortal(thing: object) -> None:
    """Never destroy it."""
    import ctypes

    ctypes.pythonapi.Py_IncRef(ctypes.py_object(thing))


_POOL: Final = _Pool()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_POOL.forget)


def share(where: str = "") -> Lease:
    """The session for a place, opened if nobody here has one.

    Raises UnknownPlugin (the extra is not installed), AddressError, LinkClosed (no router there),
    RemoteProtocolError (wrong certificate), LocalProtocolError, MissingFile.
    """
    load()
    return _POOL.take(place(where))


def close(session: zenoh.Session) -> None:
    """Close a session or router that is not shared."""
    session.close()  # type: ignore[no-untyped-call]


def load() -> Any:
    """The library. Raises UnknownPlugin if it is not installed."""
    try:
        import zenoh
    except ImportError as error:
        raise UnknownPlugin(
            f'Zenoh is not installed here ({error}): `pip install "yarpy[zenoh]"`'
        ) from error
    return zenoh


# -- routers --------------------------------------------------------------------------------------


def open_router(
    listen: Sequence[str] = (), connect: Sequence[str] = (), file: str = ""
) -> zenoh.Session:
    """A router: it passes on what sessions say to each other. Close it when done.

    listen: where, the loopback by default. connect: other routers, which may come later. file: a
    configuration file of Zenoh; what it says counts, and the rest is as without one. Raises as
    `share`, and LinkClosed if it cannot listen there.
    """
    config = load().Config()
    _set(config, "mode", "router")
    _set(config, "scouting/delay", 0)  # it does not wait for others before it begins
    _set(config, "scouting/multicast/enabled", False)
    _set(config, "scouting/gossip/enabled", False)
    _set(config, "connect/retry", RETRY)
    said = _said(_from_file(file)) if file else {}
    where = [endpoint(item) for item in listen or said.get("listen/endpoints") or (HERE,)]
    others = [endpoint(item) for item in connect or said.get("connect/endpoints") or ()]
    _secure(config, where, others)
    for key, value in said.items():
        _set(config, key, value)
    _set(config, "mode", "router")
    _set(config, "listen/endpoints", where)
    _set(config, "connect/endpoints", others)
    _override(config)
    for item in where:
        _check_free(item)
    try:
        router: zenoh.Session = load().open(config)
        return router
    except Exception as error:
        raise LinkClosed(
            f"no router at {', '.join(where) or file}: {_plain(error)}; choose another address, or "
            "end what listens there"
        ) from error


def unjoined(router: zenoh.Session, others: Sequence[str]) -> list[str]:
    """Why a router is joined with none of `others`, which it goes on to dial: a line for each.
    Nothing, if it is soon joined with any."""
    until = time.monotonic() + JOINING
    while others and not router.info.routers_zid():
        if time.monotonic() > until:
            where = [endpoint(one) for one in others]
            return [f"not joined with {one} yet: {_reason(one)}" for one in where]
        time.sleep(0.02)
    return []


def _check_free(where: str) -> None:
    """Raise LinkClosed if another program listens there: Zenoh would share the number with it."""
    kind, _, rest = where.partition("/")
    if kind not in ("tcp", "tls", "ws"):
        return
    host, _, port = rest.partition("#")[0].partition("?")[0].rpartition(":")
    host = host.strip("[]")
    if not int(port):
        return
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as sock:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            sock.bind((host, int(port)))
        except OSError as error:
            raise LinkClosed(
                f"no router can listen at {where} ({error.strerror or error}): choose another "
                "address, or end what listens there"
            ) from error


# -- configuration --------------------------------------------------------------------------------


def _client(where: Place) -> Any:
    if where.file:
        config = _from_file(where.file)
    else:
        config = load().Config()
        _set(config, "timestamping/enabled", True)  # what keeps old messages needs it
        _set(config, "scouting/multicast/enabled", not where.routers)
        if where.routers:
            _set(config, "mode", "client")
            _set(config, "connect/endpoints", [*where.routers])
            _set(config, "connect/retry", RETRY)
            _secure(config, (), where.routers)
    _override(config)
    return config


def _from_file(path: str) -> Any:
    if not Path(path).is_file():
        raise MissingFile(f'there is no configuration file of Zenoh "{path}"')
    try:
        return load().Config.from_file(path)
    except Exception as error:
        raise AddressError(f"{path} is no configuration of Zenoh: {_plain(error)}") from error


def _said(config: Any) -> dict[str, Any]:
    """What a configuration says beside the defaults, by keys; lists whole."""
    found: dict[str, Any] = {}

    def walk(key: str, value: Any, usual: Any) -> None:
        if isinstance(value, dict) and isinstance(usual, dict):
            for name, each in value.items():
                walk(f"{key}/{name}" if key else name, each, usual.get(name))
        elif value != usual:
            found[key] = _without_nothing(value)

    walk("", json.loads(str(config)), json.loads(str(load().Config())))
    return found


def _without_nothing(value: Any) -> Any:
    """The same without keys that have no value: written back, some of them would not be read."""
    if isinstance(value, dict):
        return {key: _without_nothing(one) for key, one in value.items() if one is not None}
    return [*map(_without_nothing, value)] if isinstance(value, list) else value


def _set(config: Any, key: str, value: object) -> None:
    config.insert_json5(key, json.dumps(value))


def _secure(config: Any, listen: Sequence[str], connect: Sequence[str]) -> None:
    """Say where the certificates are, if an endpoint needs any. Raises MissingFile."""
    if not any(item.startswith(_SECURE) for item in (*listen, *connect)):
        return
    base = folder()
    authority, certificate, key = base / "ca.pem", base / "cert.pem", base / "key.pem"
    own = certificate.is_file() and key.is_file()
    tls: dict[str, Any] = {}
    if authority.is_file():
        tls["root_ca_certificate"] = str(authority)
    if any(item.startswith(_SECURE) for item in listen):
        if not own:
            raise MissingFile(
                f"a router that speaks TLS needs cert.pem and key.pem in {base}: `yarpy cert` "
                "makes them"
            )
        tls |= {"listen_certificate": str(certificate), "listen_private_key": str(key)}
        if mutual():
            if not authority.is_file():
                raise MissingFile(
                    f"YARPY_TLS=mutual needs an authority, {authority}: `yarpy cert` makes one"
                )
            tls["enable_mtls"] = True
    if own and connect:
        tls |= {"connect_certificate": str(certificate), "connect_private_key": str(key)}
        tls["enable_mtls"] = True
    _set(config, "transport/link/tls", tls)


def _override(config: Any) -> None:
    """Apply ZENOH_CONFIG_OVERRIDE. Raises AddressError."""
    for item in os.environ.get(OVERRIDE, "").split(";"):
        if not item.strip():
            continue
        key, _, value = item.partition("=")
        try:
            config.insert_json5(key.strip(), value.strip())
        except Exception as error:
            raise AddressError(f'{OVERRIDE}: "{item.strip()[:80]}": {_plain(error)}') from error


# -- opening, and why not -------------------------------------------------------------------------


def _open(config: Any, where: Place) -> zenoh.Session:
    try:
        session: zenoh.Session = load().open(config)
        return session
    except Exception as error:
        if not where.routers:
            raise LinkClosed(f"no session with {where}: {_plain(error)}") from error
        reasons = [_reason(item) for item in where.routers]
        refusals = [reason for reason in reasons if isinstance(reason, RemoteProtocolError)]
        if refusals:
            raise refusals[0] from error
        raise LinkClosed(
            f"no Zenoh router answers at {where} ({'; '.join(map(str, reasons))}): start one with "
            f"`yarpy router`, or say where it is with {SETTING}=tcp/HOST:{PORT}"
        ) from error


def _reason(where: str) -> Exception:
    """Why a router could not be reached, found out by dialling it ourselves."""
    kind, _, rest = where.partition("/")
    host, _, port = rest.partition("#")[0].partition("?")[0].rpartition(":")
    if kind in ("quic", "udp") or not port.isdigit():
        return LinkClosed("no answer")
    try:
        sock = socket.create_connection((host.strip("[]"), int(port)), LOOK)
    except (OSError, UnicodeError) as error:
        return LinkClosed(str(getattr(error, "strerror", "") or error))
    with sock:
        if kind != "tls":
            return LinkClosed("what listens there does not speak Zenoh, or wants TLS: tls/...")
        return _reason_of_tls(sock, host.strip("[]"), where)


def _reason_of_tls(sock: socket.socket, host: str, where: str) -> Exception:
    import ssl

    from yarpy.transports.tls import client_context, explained

    told = f"the Zenoh router at {where}: "
    try:
        with client_context().wrap_socket(sock, server_hostname=host) as secure:
            until = time.monotonic() + REFUSAL
            secure.settimeout(REFUSAL)  # with TLS 1.3 it comes after the handshake
            while time.monotonic() < until and secure.recv(1000):
                pass
    except ssl.SSLCertVerificationError as error:
        return RemoteProtocolError(told + explained(error))
    except ssl.SSLError as error:
        return RemoteProtocolError(
            f"{told}it refuses our certificate ({error.reason or error}): it wants cert.pem and "
            f"key.pem in {folder()}, of its own authority"
        )
    except (OSError, UnicodeError) as error:
        return LinkClosed(str(error))
    return LinkClosed("what listens there does not speak Zenoh")


def _plain(error: Exception) -> str:
    """What Zenoh says, without the places in its sources."""
    return re.sub(r"\s+at \S+\.rs:\d+\.?", "", str(error)).strip(" .!")[:300]
