"""Persistence of a name service: every change is written to SQLite a moment later.

Rules: commands do not wait for a disk: what changed is noted, and one transaction for each file
writes all of it, from a thread of its own. `save` does it at once. A cautious database has the
answer to a command wait until its changes are on the disk (`settle`); those who wait meanwhile
share the next transaction. The layout of the files is in `sqlite_tables`.
"""

from __future__ import annotations

import os
import threading
from pathlib import Path

from yarpy.errors import AddressError
from yarpy.nameserver.command import NameService
from yarpy.nameserver.sqlite_tables import PortChanges, PortTable, RuleChanges, RuleTables
from yarpy.platform.file_lock import hold

DELAY = 0.05  # seconds during which changes are coalesced before they are written
RETRY = 5.0  # seconds until a write that failed is tried again


class Database:
    """Persists a `NameService`. An empty path or `:memory:` keeps that half in memory only.

    `load` fills the service and watches it from then on; `start` writes in the background;
    `close` writes what is left. `cautious`: every transaction waits for the disk, and `settle` for
    that.
    """

    def __init__(
        self,
        ports: str | Path = "",
        rules: str | Path = "",
        *,
        cautious: bool = False,
    ) -> None:
        """Open or create the files, and read them. Raises AddressError for a file that is no such
        database, is damaged, or that another server keeps."""
        self._ports: PortTable | None = None
        self._rules: RuleTables | None = None
        self._held: list[int] = []
        try:
            if _lasts(ports):
                self._ports = PortTable(ports, cautious)
            if _lasts(rules):
                self._rules = RuleTables(rules, cautious)
            for path in dict.fromkeys(str(path) for path in (ports, rules) if _lasts(path)):
                self._held += _held(path)
        except AddressError:
            self._let_go()
            raise
        self._service: NameService | None = None
        # kind -> keys in the order of their changes; guarded by the service's lock
        self._pending: dict[str, dict[str, None]] = {}
        self._cautious = cautious
        self._changing: set[int] = set()  # threads whose commands have changed something
        self._writing = threading.Lock()  # one transaction at a time, from whichever thread
        self._something = threading.Event()
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def persistent(self) -> bool:
        """Return whether anything is written to disk."""
        return self._ports is not None or self._rules is not None

    def load(self, service: NameService) -> None:
        """Fill an empty service with what the files remember, and note what changes from now on."""
        with service.lock:
            if self._ports is not None:
                self._ports.load(service.store)
            if self._rules is not None:
                self._rules.load(service.topology)
            self._service = service
            if self._ports is not None:
                service.store.watch(self._note)
            if self._rules is not None:
                service.topology.on_change = self._note

    def start(self) -> None:
        """Write in the background, a moment after each change."""
        if self.persistent and self._thread is None:
            self._thread = threading.Thread(target=self._run, name="name database", daemon=True)
            self._thread.start()

    def save(self) -> None:
        """Write all that changed since the last time, in one transaction per file.

        Raises AddressError when the file cannot be written; nothing is forgotten then.
        """
        if self._service is None:
            return
        with self._writing:
            with self._service.lock:
                pending, self._pending = self._pending, {}
                self._something.clear()
                ports = _changed_ports(self._service, pending)
                rules = _changed_rules(self._service, pending)
            try:
                if self._ports is not None and ports:
                    self._ports.save(ports)
                if self._rules is not None and rules:
                    self._rules.save(rules)
            except AddressError:
                with self._service.lock:
                    for kind, keys in pending.items():
                        self._pending.setdefault(kind, {}).update(keys)
                raise

    def settle(self) -> None:
        """If cautious, return when what this thread's commands have changed is on the disk, or has
        failed to get there, which is logged and tried again."""
        if not self._cautious or threading.get_ident() not in self._changing:
            return
        self._changing.discard(threading.get_ident())
        try:
            self.save()
        except AddressError:
            self._something.set()  # the thread that writes tells of it, and tries again

    def close(self) -> None:
        """Write what is left and close the files."""
        self._closing.set()
        self._something.set()
        if self._thread is not None:
            self._thread.join(10.0)
            self._thread = None
        try:
            self.save()
        finally:
            if self._service is not None:
                self._service.store.watch(None)
                self._service.topology.on_change = None
                self._service = None
            self._let_go()

    # --- inside

    def _let_go(self) -> None:
        for tables in (self._ports, self._rules):
            if tables is not None:
                tables.connection.close()
        self._ports = self._rules = None
        # After SQLite: closing a file gives up all locks that the process has on it.
        while self._held:
            os.close(self._held.pop())

    def _note(self, kind: str, key: str) -> None:
        self._pending.setdefault(kind, {})[key] = None
        if self._cautious:
            self._changing.add(threading.get_ident())
        self._something.set()

    def _run(self) -> None:
        while not self._closing.is_set():
            self._something.wait()
            if self._closing.wait(DELAY):
                return
            try:
                self.save()
            except AddressError as error:
                from yarpy.log import logger

                logger("yarpy.names").error("%s", error)
                self._closing.wait(RETRY)


def _held(path: str) -> list[int]:
    """The file, held for us alone: two servers would write over each other's registrations.

    Raises AddressError if another server holds it. Nothing where the file system has no locks.
    """
    try:
        file = os.open(path, os.O_RDONLY)
    except OSError:
        return []  # SQLite has opened it in a way of its own
    try:
        held = hold(file)
    except OSError:  # a file system without locks
        os.close(file)
        return []
    if held:
        return [file]
    os.close(file)
    raise AddressError(
        f"another name server keeps its names in {path}: end it, or give each a file of its own"
    )


def _lasts(path: str | Path) -> bool:
    return str(path) not in ("", ":memory:")


def _changed_ports(service: NameService, pending: dict[str, dict[str, None]]) -> PortChanges:
    """Copy what the noted keys stand for. Runs under the service's lock."""
    changes, store = PortChanges(), service.store
    for name in pending.get("port", ()):
        port = store.registration(name)
        changes.ports[name] = None if port is None else dict(port.fields)
    for kind, pool in store.pools.items():
        if kind in pending:
            changes.pools[kind] = (pool.counter, list(pool.rows(pending[kind])))
    return changes


def _changed_rules(service: NameService, pending: dict[str, dict[str, None]]) -> RuleChanges:
    """The same for what is kept beside registrations."""
    changes, topology = RuleChanges(), service.topology
    for key in pending.get("subscription", ()):
        source, _, destination = key.partition("\0")
        changes.rules[source, destination] = topology.rule(source, destination)
    changes.topics = {key: topology.topics.get(key) for key in pending.get("topic", ())}
    changes.structures = {key: topology.structures.get(key) for key in pending.get("structure", ())}
    changes.live = {key: topology.live.get(key) for key in pending.get("live", ())}
    return changes
