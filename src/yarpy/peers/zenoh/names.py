"""Names without a name server: every port tells its own over Zenoh, and is asked there.

Rules: one session for each place (`transport.py`), opened when it is first needed. What a
port tells vanishes with its program, and comes back by itself with a router that was restarted. A
question is answered by the port itself, so it is never out of date. Where a port can be dialled
directly, its address is returned, else one inside Zenoh (`ZID.zenoh`), which leads there over the
routers. Of two ports of one name the older one lets go, as with a name server. Questions of others
are answered in threads of Zenoh: nothing waits there.
"""

from __future__ import annotations

import hashlib
import itertools
import os
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final
from weakref import WeakSet

from yarpy.config.configuration import ROOT
from yarpy.contact import Contact
from yarpy.errors import AddressError, DecodeError, LinkClosed, NoNameServer, Timeout
from yarpy.limit import ZENOH_ALL_PORTS, ZENOH_PROPERTY
from yarpy.log import logger
from yarpy.names.address import is_loopback, local_addresses, outward_address
from yarpy.names.base import Contacts, NameClient, Strings
from yarpy.names.fallback_client import SeveralNames
from yarpy.names.registration_line import registration_line
from yarpy.peers.zenoh import key as zenoh_key
from yarpy.peers.zenoh.key import Entry, name_key, newest, port_token
from yarpy.peers.zenoh.library import CALLS, load
from yarpy.peers.zenoh.place import SETTING, place
from yarpy.peers.zenoh.reachability import ANYWHERE, Reachability, machine
from yarpy.peers.zenoh.transport import SharedSession, share
from yarpy.peers.zenoh.tunnel.exchange import Exchange, Welcome, join, know, leave
from yarpy.peers.zenoh.tunnel.line import undeclare
from yarpy.transports.bind import listening_host

if TYPE_CHECKING:
    import zenoh

log = logger("yarpy.names")

TIMEOUT: Final = 3.0  # seconds for an answer; those that are there answer in milliseconds
CLOCK_SKEW: Final = 60 * 10**9  # ns by which the clocks of two computers may differ
CACHE_TTL: Final = 1.0  # seconds for which the addresses of this computer are believed
ANSWERS: Final = 100_000  # programs that may answer one question
LISTED: Final = 200_000  # names in a list

_numbers = itertools.count(1)
_EVERYBODY: Final = WeakSet["ZenohNames"]()


@dataclass(slots=True)
class _Own:
    """A port of this program: what it tells, and what was declared for that."""

    entry: Entry
    type: str = ""
    properties: dict[str, list[str]] = field(default_factory=dict)
    declared: list[Any] = field(default_factory=list)
    stop: Callable[[], None] = lambda: None

    def end(self) -> None:
        """Tell of it no more."""
        self.stop()
        _undeclare(self.declared)


class ZenohNames:
    """A `NameClient` on Zenoh. `where`: a router, `lan`, or a file, as for YARPY_ZENOH, which is
    the default. Only names of the same `namespace` see each other.
    """

    allocates = False
    title = "names on Zenoh"
    hint = f"start a router with `yarpy router`, or correct {SETTING}"
    instead = (
        "`yarpy server --zenoh` is one where names are on Zenoh; say where it is, with "
        "YARPY_SERVER=HOST:PORT"
    )

    def __init__(self, where: str = "", namespace: str = ROOT) -> None:
        self.where = where
        self.base = zenoh_key.space(namespace)
        self._shared: SharedSession | None = None
        self._process = 0
        self._own: dict[str, _Own] = {}
        self._node: list[Any] = []  # what was declared for the whole program
        self._exchange: Exchange | None = None  # of connections through Zenoh
        self.on_lost: Callable[[str], object] = lambda name: None  # in a thread of its own
        self._reachability = Reachability()
        self._addresses: tuple[tuple[str, ...], float] = (), 0.0  # ours, and until when
        _EVERYBODY.add(self)
        self._lock = threading.RLock()  # guards the above; never held while an answer is awaited

    # -- the NameClient ---------------------------------------------------------------------------

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        port_type: str | None = None,
    ) -> Contact:
        if not port:
            raise AddressError(f'over Zenoh nobody gives out port numbers: give one for "{name}"')
        shared = self._open()
        if name.startswith("..."):
            name = f"/tmp/port/{shared.zid[:8]}/{next(_numbers)}"
        if carrier == "mcast" and not host:
            host = _group(shared.zid, port)
        elif not host or (is_loopback(host) and not listening_host()):
            host = outward_address()
        entry = Entry(
            Contact(carrier or "tcp", name, host, port),
            shared.zid,
            time.time_ns(),
            machine(),
            port,
            self._reached(),
        )
        self._announce(shared, _Own(entry, port_type or ""))
        return entry.contact

    def _reached(self) -> tuple[str, ...]:
        """The addresses by which ports of ours may be dialled from other computers."""
        bound = listening_host()
        if bound:
            return () if is_loopback(bound) else (bound,)
        found, until = self._addresses
        if time.monotonic() >= until:  # many ports open at once
            every = (one for one in local_addresses() if not is_loopback(one))
            found = tuple(every)[: zenoh_key.ADDRESSES]
            self._addresses = found, time.monotonic() + CACHE_TTL
        return found

    def unregister(self, name: str) -> None:
        """Only names of this program can be taken back; others end with theirs."""
        with self._lock:
            own = self._own.pop(name, None)
        if own is not None:
            own.end()

    def query(self, name: str) -> Contact | None:
        """Return the address of `name`. Raises NoNameServer (no router), Timeout (its program is
        stopped)."""
        with self._lock:
            own = self._own.get(name)
        if own is not None:
            return own.entry.contact
        entry = self.entry(name)
        if entry is None:
            return None
        know(entry.zid, self._open().zid)
        return self._reachability.to(entry)

    def announce(self, name: str, ok: bool = True) -> None:
        """Nothing: there are no persistent connections without a server."""

    def set(self, name: str, key: str, *values: str | int | float) -> Strings:
        """Only ports of this program have properties that can be set."""
        texts = sorted(map(str, values))
        if not zenoh_key.is_property(key) or sum(map(len, texts)) > ZENOH_PROPERTY:
            raise AddressError(f'"{key[:80]}" cannot be a property, or its values are too long')
        with self._lock:
            own = self._own.get(name)
            if own is None:
                return []
            own.properties[key] = texts
        return texts

    def get(self, name: str, key: str) -> Strings:
        if not zenoh_key.is_property(key):
            return []
        with self._lock:
            own = self._own.get(name)
            if own is not None:
                return own.properties.get(key, [])
        for answer in self._ask(f"{self._key(name)}?key={key}"):
            if len(answer) <= ZENOH_PROPERTY and answer:
                return answer.decode("utf-8", "replace").split("\n")
        return []

    def list(self, prefix: str | None = None) -> Contacts:
        """All ports, with the addresses that they tell: whether they can be dialled is not
        tried."""
        found: dict[str, Entry] = {}
        for answer in self._ask(f"{self.base}/node/**"):
            try:
                entries = zenoh_key.decode(answer)
            except DecodeError as error:
                log.warning("somebody tells names as no port does: %s", error)
                continue
            for entry in entries[: LISTED - len(found)]:
                known = found.get(entry.contact.name)
                if known is None or known.age < entry.age:
                    found[entry.contact.name] = entry
        below = (prefix or "").rstrip("/") + "/"
        return [
            found[name].contact
            for name in sorted(found)
            if not prefix or name == prefix or name.startswith(below)
        ]

    def close(self) -> None:
        with self._lock:
            own, self._own = self._own, {}
            node, self._node = self._node, []
            shared, self._shared = self._shared, None
            exchange, self._exchange = self._exchange, None
        if shared is None or self._process != os.getpid():
            return
        for one in own.values():
            one.end()
        _undeclare(node)
        if exchange is not None:
            leave(exchange)
        shared.close()

    def adopt(self, contact: Contact, welcome: Welcome, here: bool) -> None:
        """Tell of a port of a program that does not speak Zenoh. `welcome` gets those who come to
        it through Zenoh; `here`: it is of this computer. `on_lost` hears when it is told of by
        another program."""
        shared = self._open()
        number = 1 + next(_numbers) % 65535
        place = machine() if here else ANYWHERE
        entry = Entry(contact, shared.zid, time.time_ns(), place, number)
        own = _Own(entry)
        own.stop = self._calls(shared).listen(number, welcome)
        self._announce(shared, own)

    def listen(self, port: int, welcome: Welcome) -> Callable[[], None]:
        """Let a port that listens on that number be called through Zenoh, too; see `Medium`."""
        return self._calls(self._open()).listen(port, welcome)

    def _calls(self, shared: SharedSession) -> Exchange:
        with self._lock:
            if self._exchange is None:
                self._exchange = join(shared)
            return self._exchange

    def open(self) -> None:
        """Open the session now. Raises NoNameServer."""
        self._open()

    # -- what others may need ---------------------------------------------------------------------

    def place(self) -> str:
        """Return where it goes, for people. Raises NoNameServer."""
        return str(self._open().place)

    def alive(self) -> bool:
        """Return whether a router answers, where there should be one."""
        try:
            self._open()
            self._check_router()
        except NoNameServer:
            return False
        return True

    def address(self) -> tuple[str, int]:
        """Return the place, which stands for a host, and no number."""
        return self.where or str(place()), 0

    def line(self, contact: Contact) -> str:
        """Return the line of a name server for it."""
        return registration_line(contact)

    def entry(self, name: str) -> Entry | None:
        """Return what the port of that name tells of itself; None if there is none. Raises as
        `query`."""
        found: list[Entry] = []
        for answer in self._ask(self._key(name), name):
            try:
                found += zenoh_key.decode(answer, zenoh_key.LONGEST)
            except DecodeError as error:
                log.warning("%s: somebody answers as no port does: %s", name, error)
        entry = newest(found, name)
        if entry is not None and any(one.age < entry.age for one in found):
            self._claim(self._open().session, entry)  # for the others, which did not see each other
        return entry

    # -- what this program tells ------------------------------------------------------------------

    def _announce(self, shared: SharedSession, own: _Own) -> None:
        session = shared.session
        name = own.entry.contact.name
        self._calls(shared)  # nobody who finds the name may find nobody there
        self.unregister(name)
        key = name_key(self.base, name)
        callback = load().handlers.Callback(
            lambda query: self._answer(own, key, query), indirect=False
        )
        own.declared.append(session.declare_queryable(key, callback))
        own.declared.append(session.liveliness().declare_token(port_token(self.base, own.entry)))
        with self._lock:
            self._own[name] = own
        # Those of this session are told without Zenoh, which would ask the new one, too.
        self._claim(session, own.entry, load().Locality.REMOTE)
        for other in [*_EVERYBODY]:
            if other is not self and other.base == self.base:
                other.lose(own.entry)

    def _answer(self, own: _Own, key: str, query: Any) -> None:
        """Somebody asks for a port of ours. Runs in a thread of Zenoh."""
        try:
            if query.payload is not None:
                said = zenoh_key.decode(query.payload.to_bytes(), zenoh_key.LONGEST)
                self._yield(own, newest(said, own.entry.contact.name))
                return
            wanted = query.parameters.get("key")
            if wanted:
                values = own.properties.get(wanted, [])
                query.reply(key, "\n".join(values).encode("utf-8", "surrogateescape"))
            else:
                query.reply(key, zenoh_key.encode([own.entry]))
        except Exception as error:  # a stranger's question must not end the thread
            log.debug("%s: a question could not be answered: %s", own.entry.contact.name, error)

    def _answer_all(self, key: str, query: Any) -> None:
        with self._lock:
            entries = [own.entry for own in self._own.values()]
        try:
            query.reply(key, zenoh_key.encode(entries))
        except Exception as error:
            log.debug("a list of names could not be sent: %s", error)

    def _claim(
        self, session: zenoh.Session, entry: Entry, where: zenoh.Locality | None = None
    ) -> None:
        """Let older ports of that name know that it has a new owner. Nobody waits for an
        answer."""
        zenoh = load()
        session.get(
            name_key(self.base, entry.contact.name),
            zenoh.handlers.Callback(lambda reply: None, indirect=False),
            payload=zenoh_key.encode([entry]),
            target=zenoh.QueryTarget.ALL,
            allowed_destination=where,
            timeout=TIMEOUT,
        )

    def lose(self, entry: Entry) -> None:
        """A port of ours lets go of its name if it is older than that one of this session."""
        with self._lock:
            own = self._own.get(entry.contact.name)
            shared = self._shared
        if own is not None and shared is not None and shared.zid == entry.zid:
            self._yield(own, entry)

    def _yield(self, own: _Own, entry: Entry | None) -> None:
        name = own.entry.contact.name
        if entry is None or entry.age <= own.entry.age or entry.start > time.time_ns() + CLOCK_SKEW:
            return
        with self._lock:
            if self._own.get(name) is not own:
                return
            del self._own[name]
        log.warning("%s: another port has taken this name, at %s", name, entry.contact.address)
        threading.Thread(target=self._let_go, args=(own,), daemon=True).start()

    def _let_go(self, own: _Own) -> None:
        own.end()
        self.on_lost(own.entry.contact.name)

    # -- asking -----------------------------------------------------------------------------------

    def _open(self) -> SharedSession:
        with self._lock:
            if self._shared is not None and self._process == os.getpid():
                return self._shared
            try:
                shared = share(self.where)
            except LinkClosed as error:
                raise NoNameServer(str(error)) from error
            self._process, self._own, self._exchange = os.getpid(), {}, None
            self._shared = shared
            session = shared.session
            key = f"{self.base}/node/{shared.zid}/{next(_numbers)}"
            callback = load().handlers.Callback(
                lambda query: self._answer_all(key, query), indirect=False
            )
            self._node = [session.declare_queryable(key, callback)]
            return shared

    def _key(self, name: str) -> str:
        try:
            return name_key(self.base, name)
        except AddressError:
            return name_key(self.base, "/no/such/name")  # no port can be called that

    def _ask(self, selector: str, name: str = "") -> Iterable[bytes]:
        """The answers to a question. Raises NoNameServer; Timeout if a name's program is silent."""
        zenoh = load()
        shared = self._open()
        self._check_router()  # a session without one would wait in vain
        found: list[bytes] = []
        silent = False
        size = 0
        with CALLS:
            replies = shared.session.get(
                selector,
                zenoh.handlers.FifoChannel(ANSWERS),
                target=zenoh.QueryTarget.ALL,
                consolidation=zenoh.ConsolidationMode.NONE,
                timeout=TIMEOUT,
            )
            for reply in replies:
                if reply.ok is None:
                    silent = True
                    continue
                data = reply.ok.payload.to_bytes()
                size += len(data)
                if size > 8 * ZENOH_ALL_PORTS:
                    log.warning("too many answers to %s: the rest is left out", selector)
                    break
                found.append(data)
        if silent and name and not found:
            raise Timeout(
                f'the program of "{name}" does not answer just now, perhaps stopped or busy: '
                "end it, or try again"
            )
        return found

    def _check_router(self) -> None:
        """Raises NoNameServer if the router went away."""
        shared = self._open()
        if shared.place.routers and not shared.session.info.routers_zid():
            raise NoNameServer(
                f"the Zenoh router at {shared.place} does not answer any more; once it is back, "
                "names are too: start it with `yarpy router`"
            )


def open_names(host: str, port: int, namespace: str) -> ZenohNames:
    """Return names at a place that a configuration says: a host with a port, or a place as in
    YARPY_ZENOH."""
    return ZenohNames(f"{host}:{port}" if port else host, namespace)


def on_zenoh(names: NameClient) -> ZenohNames | None:
    """Return `names`, or the first of several, if it is names on Zenoh."""
    found = names.clients[0] if isinstance(names, SeveralNames) else names
    return found if isinstance(found, ZenohNames) else None


def _undeclare(things: Iterable[Any]) -> None:
    for thing in things:
        undeclare(thing)


def _group(zid: str, number: int) -> str:
    """A multicast group that nobody else has, with luck: of those for one organisation's use."""
    digest = hashlib.sha256(f"{zid} {number} {next(_numbers)}".encode()).digest()
    return f"239.{192 + digest[0] % 4}.{digest[1]}.{digest[2]}"
