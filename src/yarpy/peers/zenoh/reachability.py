"""Reachability of a port of another computer: dialled directly, or only over the routers of Zenoh.

Rules: what is tried is what will be used: a TCP connection to one of the addresses that the port
tells, and who answers there is asked for its name, since two networks may use the same addresses.
What was found holds for some seconds, for all ports of that program.
"""

from __future__ import annotations

import hashlib
import os
import selectors
import socket
import threading
import time
from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Final

from yarpy.contact import Contact
from yarpy.names.address import is_loopback, local_addresses
from yarpy.peers.zenoh.key import Entry
from yarpy.transports.tls_setting import required

TIMEOUT: Final = (
    0.4  # seconds to reach a port directly: networks where it takes longer have routers
)
CACHE_TTL: Final = 10.0  # seconds for which what was found is believed
ANYWHERE: Final = "0"  # instead of what tells a computer, where that is not known
_MOST: Final = 10_000  # programs that are remembered
_LINE: Final = 4096  # bytes of an answer that are looked at


@lru_cache(maxsize=1)
def machine() -> str:
    """Return an identifier of this computer's network: a container has one of its own."""
    parts = []
    for file in ("/etc/machine-id", "/proc/sys/kernel/random/boot_id"):
        try:
            parts.append(Path(file).read_text(encoding="utf-8").strip())
        except OSError:
            continue
    try:
        parts.append(str(os.stat("/proc/self/ns/net").st_ino))
    except OSError:
        import uuid

        parts.append(str(uuid.getnode()))
    return hashlib.sha256(" ".join(parts).encode()).hexdigest()[:16]


class Reachability:
    """The hosts at which programs are reached, as far as they are known."""

    def __init__(self) -> None:
        self._hosts: dict[str, tuple[str, float]] = {}  # session -> address or "", and until when
        self._lock = threading.RLock()

    def to(self, entry: Entry) -> Contact:
        """The port's address, as this computer should dial it."""
        if entry.machine == machine() or entry.contact.carrier != "tcp":
            return entry.contact
        key = entry.zid if entry.machine != ANYWHERE else f"{entry.zid} {entry.contact.host}"
        now = time.monotonic()
        with self._lock:
            host, until = self._hosts.get(key, ("", 0.0))
        if now >= until:
            host = reachable(candidates(entry), entry.port, entry.contact.name)
            with self._lock:
                if len(self._hosts) >= _MOST:
                    self._hosts.clear()
                self._hosts[key] = host, time.monotonic() + CACHE_TTL
        return replace(entry.contact, host=host) if host else entry.through


def candidates(entry: Entry) -> list[str]:
    """Return the hosts at which the port may be dialled from another computer: none that is our own
    address too."""
    own = set() if entry.machine == ANYWHERE else set(local_addresses())
    every = dict.fromkeys([entry.contact.host, *entry.addresses])
    return [
        host
        for host in every
        if not is_loopback(host) and host not in own and not host.lower().startswith("fe80:")
    ]


def reachable(hosts: Iterable[str], port: int, name: str) -> str:
    """The first of `hosts` where the port of that name answers, "" if none does."""
    deadline = time.monotonic() + TIMEOUT
    with selectors.DefaultSelector() as selector:
        try:
            for host in hosts:
                sock = _begin(host, port)
                if sock is not None:
                    selector.register(sock, selectors.EVENT_WRITE, host)
            while selector.get_map() and (left := deadline - time.monotonic()) > 0:
                for key, _ in selector.select(left):
                    ready = key.fileobj
                    assert isinstance(ready, socket.socket)
                    selector.unregister(ready)
                    with ready:
                        fine = not ready.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
                        if fine and _is_it(ready, name, deadline + TIMEOUT):
                            return str(key.data)
            return ""
        finally:
            for key in [*selector.get_map().values()]:
                key.fileobj.close()  # type: ignore[union-attr]


def _begin(host: str, port: int) -> socket.socket | None:
    """A connection that is being made, None where it cannot be."""
    try:
        sock = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_STREAM)
    except OSError:
        return None
    sock.setblocking(False)
    try:
        sock.connect_ex((host, port))
    except (OSError, UnicodeError, OverflowError):
        sock.close()
        return None
    return sock


def _is_it(sock: socket.socket, name: str, deadline: float) -> bool:
    """Return whether the program that answers is not known to be another port."""
    if required():
        return True  # it is asked in TLS, when it is dialled
    said = b""
    try:
        sock.settimeout(max(deadline - time.monotonic(), 0.01))
        sock.sendall(b"CONNACK admin\r\n*\r\n")
        while said.count(b"\n") < 2 and len(said) < _LINE:
            piece = sock.recv(_LINE)
            if not piece:
                break
            said += piece
    except OSError:
        return False
    lines = said.decode("utf-8", "replace").splitlines()
    if len(lines) < 2 or not lines[1].startswith("This is /"):
        return True  # a port with a key, or with rules of its own
    return lines[1].removeprefix("This is ").rpartition(" at ")[0] == name
