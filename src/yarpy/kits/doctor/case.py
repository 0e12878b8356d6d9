"""Case: everything that the doctor knows of a network before it judges.

Rules: the ports that matter are asked twice, a moment apart; what costs more (a look at messages,
servers in the network, processes) is found out when a family of findings wants it, once. Nothing
changes anything, and everything has a time limit.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from yarpy.config.configuration import (
    Configuration,
    Server,
    configuration,
    default_port,
    namespaces,
    read_server,
)
from yarpy.contact import Contact, parse_contact
from yarpy.data.value import Vocab
from yarpy.errors import AddressError, NoNameServer, YarpError
from yarpy.kits.doctor import process
from yarpy.kits.doctor.peek import Peek, peek
from yarpy.names.address import is_local
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.names.default import DEFAULT, prove, secret
from yarpy.names.discovery import search_all
from yarpy.names.fallback_client import SeveralNames
from yarpy.network.sampling import AT_ONCE, Line, Sampler
from yarpy.network.traffic import End, Flow, PortState, Snapshot
from yarpy.port.connect import probe

WINDOW: Final = 1.0  # seconds between the two looks
TIMEOUT: Final = 1.5  # seconds for a port's answer
SERVER_TIMEOUT: Final = 3.0  # seconds for a name server's
MOST: Final = 64  # connections that are judged


@dataclass(frozen=True, slots=True)
class Pair:
    """Two ports between which messages should flow. `now` and `before` are their connection at the
    two looks, None if there is none."""

    source: str
    target: str
    before: Flow | None = None
    now: Flow | None = None

    @property
    def name(self) -> str:
        """`/a -> /b`."""
        return f"{self.source} -> {self.target}"

    @property
    def carrier(self) -> str:
        """The protocol of the connection, without modifiers."""
        return self.now.carrier.partition("+")[0] if self.now is not None else ""

    def end(self, side: str) -> End | None:
        """The `sender`'s or `receiver`'s end now."""
        return getattr(self.now, side) if self.now is not None else None

    def grown(self, side: str, key: str) -> int | None:
        """Return by how much a counter of one end has grown between the looks; None: it does not
        count."""
        old = getattr(self.before, side, None)
        new = self.end(side)
        first, last = getattr(old, key, None), getattr(new, key, None)
        return None if first is None or last is None else last - first


class Case:
    """The facts of an examination, asked for once. `wanted`: no name (the whole network), a
    port, or source and target."""

    def __init__(
        self,
        *wanted: str,
        names: NameClient | None = None,
        environment: Mapping[str, str] | None = None,
        window: float = WINDOW,
        shared_memory: Path = Path("/dev/shm"),
    ) -> None:
        self.environment = os.environ if environment is None else environment
        self.shared_memory = shared_memory
        self.problem: Exception | None = None  # why there is no name server
        self.names: NameClient | None = None
        self.contacts: dict[str, Contact] = {}  # everything that is registered
        self.before = self.now = Snapshot(0.0)
        self.seconds = 0.0  # between the looks
        self.window = window
        self.configuration: Configuration | None = None
        self._peeks: dict[str, Peek] = {}
        self._lock = threading.RLock()  # families that are late may still look
        try:
            self.configuration = configuration(self.environment)
            self.names = _brisk(names or DEFAULT.current())
            self.contacts = {one.name: one for one in self.names.list()}
        except (NoNameServer, AddressError) as error:
            self.problem = error
            return
        finally:
            self.wanted = tuple(map(self._called, wanted))
        self._look()

    def _look(self) -> None:
        only: Iterable[str] | None = self.wanted or None
        with Sampler(self.names, only, TIMEOUT) as sampler:
            self.before = sampler.look()
            if len(self.wanted) == 1:  # its peers matter, too
                peers = {name for ends in self.before.flows for name in ends if name}
                sampler.extend(sorted(peers & set(self.contacts))[:MOST])
                self.before = sampler.look()
            started = time.monotonic()
            if self.before.flows and self.wanted:
                time.sleep(self.window)
                self.now = sampler.look()
                self.seconds = time.monotonic() - started
            else:
                self.now = self.before

    def _called(self, text: str) -> str:
        """The name of a port that was given by its name, or by its address."""
        contact = parse_contact(text)
        if not contact.reachable:
            return contact.name if contact.name.startswith("/") else f"/{contact.name}"
        try:
            return contact.name or probe.who(contact, TIMEOUT, secret()) or contact.label
        except (YarpError, OSError):
            return contact.label

    # -- what is there ----------------------------------------------------------------------------

    @property
    def ports(self) -> dict[str, PortState]:
        """The ports that were asked, by name."""
        return self.now.ports

    @cached_property
    def pairs(self) -> list[Pair]:
        """The connections to be judged; with two names, the one that should be there."""
        before, now = self.before.flows, self.now.flows
        if len(self.wanted) == 2:
            key = self.wanted[0], self.wanted[1]
            return [Pair(*key, before.get(key), now.get(key))]
        found = [key for key in now if all(key) and (not self.wanted or self.wanted[0] in key)]
        return [Pair(*key, before.get(key), now[key]) for key in found[:MOST]]

    def pair(self, source: str, target: str) -> Pair:
        """The connection of two ports, whether it is there or not."""
        key = source, target
        return Pair(*key, self.before.flows.get(key), self.now.flows.get(key))

    def port(self, name: str) -> PortState | None:
        """A port that was asked, if it answers."""
        state = self.ports.get(name)
        return state if state is not None and state.state == "answers" else None

    def is_here(self, name: str) -> bool:
        """Return whether a port is registered at an address of this computer."""
        state = self.ports.get(name)
        return state is not None and bool(state.contact.host) and is_local(state.contact.host)

    def pid(self, name: str) -> int:
        """The process of this computer that listens where a port is registered, 0 if unknown."""
        state = self.ports.get(name)
        return process.listener(state.contact.port) if state and self.is_here(name) else 0

    # -- what costs more --------------------------------------------------------------------------

    def peek(self, name: str) -> Peek:
        """Return what a port writes now; each port is read once. Nothing unless one port or two
        are wanted."""
        with self._lock:
            if name not in self._peeks:
                sources = {pair.source for pair in self.pairs if pair.now is not None}
                asked = [one for one in {name, *sources} if one not in self._peeks]
                with ThreadPoolExecutor(AT_ONCE) as pool:
                    self._peeks.update(zip(asked, pool.map(self._peek, asked), strict=True))
            return self._peeks[name]

    def _peek(self, name: str) -> Peek:
        state = self.port(name) if self.wanted else None
        if state is None:
            return Peek(error="not asked")
        return peek(state.contact, self.window)

    def ask(self, name: str, *words: object) -> Any:
        """Return a port's answer to an administrative question, None if it does not answer."""
        state = self.port(name)
        if state is None:
            return None
        try:
            line = Line(state.contact, TIMEOUT)
            try:
                return line.ask(*words, timeout=TIMEOUT)
            finally:
                line.close()
        except (YarpError, OSError):
            return None

    def dialect(self, name: str) -> int:
        """The main version of YARP whose spelling of numbers a port uses: 3, 4, or 0, not known."""
        state = self.port(name)
        if state is None:
            return 0
        if state.ours:
            return 3
        reply = self.ask(name, Vocab("bus"))
        if not reply:
            return 0
        return 4 if reply[0] == Vocab("fail") else 3 if reply[0] == 1 else 0

    def who(self, name: str) -> str:
        """The name that the port says it has that listens where `name` is registered."""
        state = self.ports.get(name)
        if state is None:
            return ""
        try:
            return probe.who(state.contact, TIMEOUT, secret())
        except (YarpError, OSError):
            return ""

    @cached_property
    def servers(self) -> list[Server]:
        """The name servers that this shell uses, in order of preference."""
        return list(self.configuration.servers) if self.configuration is not None else []

    @cached_property
    def others(self) -> list[Server]:
        """Other name servers: those that answer in the network, and those of other namespaces that
        files of this user name."""
        found: dict[tuple[str, int], Server] = {}
        asked = [ROOT]
        if self.configuration is not None:
            directory = self.configuration.directory
            asked = [*namespaces(self.environment, directory), ROOT]
            for path in sorted(directory.glob("*.conf"))[:MOST]:
                if not (path.stem == "yarp" or path.stem.startswith("_")):
                    continue
                namespace = ROOT if path.stem == "yarp" else path.stem.replace("_", "/")
                try:
                    server = read_server(directory, namespace)
                except AddressError:
                    continue
                if server is not None and server.mode == "yarp":
                    found[server.host, server.port] = server
                    asked.append(namespace)
        try:
            for one in search_all([*dict.fromkeys(asked)], default_port(self.environment)):
                found.setdefault((one.host, one.port), Server(one.host, one.port, "yarp", one.name))
        except OSError:
            pass  # this computer has no multicast
        used = {(one.host, one.port) for one in self._used}
        return [one for key, one in found.items() if key not in used]

    @property
    def _used(self) -> list[YarpNameClient]:
        clients = getattr(self.names, "clients", [self.names])
        return [one for one in clients if isinstance(one, YarpNameClient)]

    def server_of(self, place: Server) -> YarpNameClient:
        """A client that asks another name server, with a short timeout."""
        return YarpNameClient(place.host, place.port, SERVER_TIMEOUT / 2, prepare=_proof())

    def property_of(self, name: str, key: str) -> list[str]:
        """Return the values of a property of a name at the name server."""
        try:
            return self.names.get(name, key) if self.names is not None else []
        except (YarpError, OSError):
            return []


ROOT: Final = "/root"


def _proof() -> Any:
    return prove if secret() else None


def _brisk(names: NameClient) -> NameClient:
    """The same name service, with a short timeout."""
    if isinstance(names, SeveralNames):
        return SeveralNames([_brisk(one) for one in names.clients])
    if isinstance(names, YarpNameClient):
        return YarpNameClient(names.host, names.port, SERVER_TIMEOUT, prepare=_proof())
    return names


__all__ = ["Case", "Pair"]
