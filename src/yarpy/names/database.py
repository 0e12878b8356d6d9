"""The registrations and rules of a name server in two SQLite files, as C++ yarpserver keeps them.

Rules: each side opens the files of the other (schema: nameserver spec 8.1). Commands never wait
for a disk: what changed is noted, and one transaction writes all of it a moment later, from a
thread of its own. `save` does it at once. Text is stored as the bytes it came as.

    ports   tags(id, rid, ns, name, value)
              a port     rid NULL, ns NULL, name 'port', value its name; its id is R
              a field    rid R, ns NULL, name and value: one row for each value
              a pool     rid NULL, ns 'alloc', name 'regid' | 'tmpid' | 'mcastCursor', value its
                         counter; its id is A
              lent out   rid A, ns 'alloc', name what, value 'in_use' | 'free'
              habit      rid A, ns 'prefer', name what, value the port that had it last
    rules   subscriptions, topics, live, structures
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yarpy.errors import AddressError
from yarpy.names.command import NameService
from yarpy.names.pool import Row
from yarpy.names.topology import Subscription

if TYPE_CHECKING:
    import sqlite3

DELAY = 0.05  # seconds that changes may gather before they are written
RETRY = 5.0  # seconds until a write that failed is tried again

_PORTS = """
CREATE TABLE IF NOT EXISTS tags
    (id INTEGER PRIMARY KEY, rid INTEGER, ns TEXT, name TEXT, value TEXT);
CREATE INDEX IF NOT EXISTS tagsRidNameValue ON tags(rid, name, value);
"""
_RULES = """
CREATE TABLE IF NOT EXISTS subscriptions
    (id INTEGER PRIMARY KEY, src TEXT, dest TEXT, srcFull TEXT, destFull TEXT, mode TEXT);
CREATE TABLE IF NOT EXISTS topics (id INTEGER PRIMARY KEY, topic TEXT, structure TEXT);
CREATE TABLE IF NOT EXISTS live (id INTEGER PRIMARY KEY, name TEXT UNIQUE, stamp DATETIME);
CREATE TABLE IF NOT EXISTS structures (name TEXT PRIMARY KEY, yarp TEXT);
"""
_TAG = "INSERT INTO tags (rid, ns, name, value) VALUES (?, ?, CAST(? AS TEXT), CAST(? AS TEXT))"
_IS = "= CAST(? AS TEXT)"


@dataclass(slots=True)
class _Changes:
    """Copies of what has to be written, so that nobody waits while it is."""

    ports: dict[str, dict[str, list[str]] | None] = field(default_factory=dict)
    pools: dict[str, tuple[int, list[Row]]] = field(default_factory=dict)
    rules: dict[tuple[str, str], Subscription | None] = field(default_factory=dict)
    topics: dict[str, str | None] = field(default_factory=dict)
    live: dict[str, float | None] = field(default_factory=dict)
    structures: dict[str, str | None] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(
            self.ports or self.pools or self.rules or self.topics or self.live or self.structures
        )


class Database:
    """Makes a `NameService` last. An empty path or `:memory:` keeps that half in memory only.

    `load` fills the service and watches it from then on; `start` writes in the background;
    `close` writes what is left. `cautious`: every transaction waits for the disk.
    """

    def __init__(
        self,
        ports: str | Path = "",
        rules: str | Path = "",
        *,
        cautious: bool = False,
    ) -> None:
        """Open or create the files. Raises AddressError for a file that is no such database."""
        self._ports = _open(ports, _PORTS, cautious)
        self._rules = _open(rules, _RULES, cautious)
        if self._rules is not None:
            _add_columns(self._rules)
        self._service: NameService | None = None
        self._port_ids: dict[str, int] = {}
        self._pool_ids: dict[str, int] = {}
        # kind -> keys in the order of their changes; guarded by the service's lock
        self._pending: dict[str, dict[str, None]] = {}
        self._writing = threading.Lock()  # one transaction at a time, whoever asks for it
        self._something = threading.Event()
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def persistent(self) -> bool:
        """Whether anything is written at all."""
        return self._ports is not None or self._rules is not None

    def load(self, service: NameService) -> None:
        """Fill an empty service with what the files remember, and note what changes from now on."""
        with service.lock:
            if self._ports is not None:
                self._load_ports(self._ports, service)
            if self._rules is not None:
                self._load_rules(self._rules, service)
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
                changes = _gather(self._service, pending)
            if not changes:
                return
            ids = dict(self._port_ids), dict(self._pool_ids)
            try:
                if self._ports is not None:
                    with _transaction(self._ports):
                        self._save_ports(self._ports, changes)
                if self._rules is not None:
                    with _transaction(self._rules):
                        _save_rules(self._rules, changes)
            except AddressError:
                self._port_ids, self._pool_ids = ids
                with self._service.lock:
                    for kind, keys in pending.items():
                        self._pending.setdefault(kind, {}).update(keys)
                raise

    def close(self) -> None:
        """Write what is left and let go of the files."""
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
            for connection in (self._ports, self._rules):
                if connection is not None:
                    connection.close()
            self._ports = self._rules = None

    # --- inside

    def _note(self, kind: str, key: str) -> None:
        self._pending.setdefault(kind, {})[key] = None
        self._something.set()

    def _run(self) -> None:
        while not self._closing.is_set():
            self._something.wait()
            if self._closing.wait(DELAY):
                return
            try:
                self.save()
            except AddressError as error:
                import logging

                logging.getLogger("yarpy.names").error("%s", error)
                self._closing.wait(RETRY)

    def _load_ports(self, connection: sqlite3.Connection, service: NameService) -> None:
        ports: dict[int, tuple[str, dict[str, list[str]]]] = {}
        pools: dict[int, tuple[str, int, dict[str, list[Any]]]] = {}
        known = service.store.pools
        for row, ns, name, value in _rows(
            connection, "SELECT id, ns, name, value FROM tags WHERE rid IS NULL ORDER BY id"
        ):
            if ns is None and name == "port" and value is not None:
                ports[row] = (value, {})
            elif ns == "alloc" and name in known:
                pools[row] = (name, _integer(value), {})
        for owner, ns, name, value in _rows(
            connection, "SELECT rid, ns, name, value FROM tags WHERE rid IS NOT NULL ORDER BY id"
        ):
            if owner in ports and ns is None:
                ports[owner][1].setdefault(name or "", []).append(value or "")
            elif owner in pools and ns in ("alloc", "prefer"):
                state = pools[owner][2].setdefault(name or "", [None, None])
                if ns == "alloc":
                    state[0] = value == "in_use"
                else:
                    state[1] = value or ""
        service.store.restore(dict(ports.values()))
        self._port_ids = {name: row for row, (name, _) in ports.items()}
        for row, (name, counter, states) in pools.items():
            known[name].restore(counter, [(key, used, who) for key, (used, who) in states.items()])
            self._pool_ids[name] = row

    def _load_rules(self, connection: sqlite3.Connection, service: NameService) -> None:
        rules = [
            Subscription(source or "", destination or "", mode if mode in ("from", "to") else "")
            for source, destination, mode in _rows(
                connection,
                "SELECT ifnull(srcFull, src), ifnull(destFull, dest), mode "
                "FROM subscriptions ORDER BY id",
            )
        ]
        topics = _rows(connection, "SELECT topic, structure FROM topics ORDER BY id")
        live = _rows(
            connection, "SELECT name, CAST(strftime('%s', stamp) AS INTEGER) FROM live ORDER BY id"
        )
        structures = _rows(connection, "SELECT name, yarp FROM structures")
        service.topology.restore(
            rules,
            {topic or "": structure or "" for topic, structure in topics},
            {name or "": float(stamp or 0) for name, stamp in live},
            {name or "": structure or "" for name, structure in structures},
        )

    def _save_ports(self, connection: sqlite3.Connection, changes: _Changes) -> None:
        for name, fields in changes.ports.items():
            row = self._port_ids.get(name)
            if row is not None:
                connection.execute("DELETE FROM tags WHERE rid = ?", (row,))
            if fields is None:
                if row is not None:
                    connection.execute("DELETE FROM tags WHERE id = ?", (row,))
                    del self._port_ids[name]
                continue
            if row is None:
                row = _inserted(connection.execute(_TAG, (None, None, b"port", _bytes(name))))
                self._port_ids[name] = row
            connection.executemany(
                _TAG,
                [
                    (row, None, _bytes(key), _bytes(value))
                    for key, values in fields.items()
                    for value in values
                ],
            )
        for pool, (counter, states) in changes.pools.items():
            row = self._pool_ids.get(pool)
            spelled = str(counter).encode()
            if row is None:
                cursor = connection.execute(_TAG, (None, "alloc", pool.encode(), spelled))
                row = self._pool_ids[pool] = _inserted(cursor)
            else:
                connection.execute(
                    "UPDATE tags SET value = CAST(? AS TEXT) WHERE id = ?", (spelled, row)
                )
            for value, used, who in states:
                connection.execute(
                    f"DELETE FROM tags WHERE rid = ? AND name {_IS}", (row, _bytes(value))
                )
                if used is not None:
                    state = b"in_use" if used else b"free"
                    connection.execute(_TAG, (row, "alloc", _bytes(value), state))
                if who is not None:
                    connection.execute(_TAG, (row, "prefer", _bytes(value), _bytes(who)))


def _save_rules(connection: sqlite3.Connection, changes: _Changes) -> None:
    for (source, destination), rule in changes.rules.items():
        connection.execute(
            f"DELETE FROM subscriptions WHERE src {_IS} AND dest {_IS}",
            (_bytes(source), _bytes(destination)),
        )
        if rule is not None:
            texts = (source, destination, rule.source_text, rule.destination_text, rule.mode)
            connection.execute(
                "INSERT INTO subscriptions (src, dest, srcFull, destFull, mode) "
                f"VALUES ({', '.join(['CAST(? AS TEXT)'] * 4)}, nullif(CAST(? AS TEXT), ''))",
                tuple(map(_bytes, texts)),
            )
    for table, key, column, items in (
        ("topics", "topic", "structure", changes.topics),
        ("structures", "name", "yarp", changes.structures),
    ):
        for name, structure in items.items():
            if structure is None:
                connection.execute(f"DELETE FROM {table} WHERE {key} {_IS}", (_bytes(name),))
                continue
            pair = (_bytes(structure), _bytes(name))
            value = "nullif(CAST(? AS TEXT), '')"
            updated = connection.execute(
                f"UPDATE {table} SET {column} = {value} WHERE {key} {_IS}", pair
            )
            if not updated.rowcount:
                connection.execute(
                    f"INSERT INTO {table} ({column}, {key}) VALUES ({value}, CAST(? AS TEXT))", pair
                )
    for name, stamp in changes.live.items():
        connection.execute(f"DELETE FROM live WHERE name {_IS}", (_bytes(name),))
        if stamp is not None:
            connection.execute(
                "INSERT INTO live (name, stamp) VALUES (CAST(? AS TEXT), datetime(?, 'unixepoch'))",
                (_bytes(name), stamp),
            )


def _gather(service: NameService, pending: dict[str, dict[str, None]]) -> _Changes:
    """Copy what the noted keys stand for. Runs under the service's lock."""
    changes = _Changes()
    store, topology = service.store, service.topology
    for name in pending.get("port", ()):
        port = store.registration(name)
        changes.ports[name] = None if port is None else dict(port.fields)
    for kind, pool in store.pools.items():
        if kind in pending:
            changes.pools[kind] = (pool.counter, list(pool.rows(pending[kind])))
    for key in pending.get("subscription", ()):
        source, _, destination = key.partition("\0")
        changes.rules[source, destination] = topology.rule(source, destination)
    for kind, target, origin in (
        ("topic", changes.topics, topology.topics),
        ("structure", changes.structures, topology.structures),
    ):
        for key in pending.get(kind, ()):
            target[key] = origin.get(key)
    for key in pending.get("live", ()):
        changes.live[key] = topology.live.get(key)
    return changes


# --- SQLite


def _open(path: str | Path, schema: str, cautious: bool) -> sqlite3.Connection | None:
    if not str(path) or str(path) == ":memory:":
        return None
    import sqlite3  # late: most programs are clients

    connection = None
    try:
        # isolation_level None: transactions begin and end where `_transaction` says.
        connection = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        connection.text_factory = _text
        connection.execute(f"PRAGMA synchronous = {'FULL' if cautious else 'OFF'}")
        connection.executescript(schema)
    except sqlite3.Error as error:
        if connection is not None:
            connection.close()
        raise AddressError(
            f'failed to open database "{path}" ({error}): '
            "move the file out of the way, or name another one"
        ) from error
    return connection


def _add_columns(connection: sqlite3.Connection) -> None:
    """Files of older servers lack two columns."""
    for table, column in (("subscriptions", "mode"), ("topics", "structure")):
        present = {row[1] for row in connection.execute(f"PRAGMA table_info({table})")}
        if column not in present:
            connection.execute(f"ALTER TABLE {table} ADD COLUMN {column} TEXT")


@contextmanager
def _transaction(connection: sqlite3.Connection) -> Iterator[None]:
    import sqlite3

    try:
        connection.execute("BEGIN IMMEDIATE")
        try:
            yield
        except BaseException:
            connection.execute("ROLLBACK")
            raise
        connection.execute("COMMIT")
    except sqlite3.Error as error:
        raise AddressError(f"the name server's database cannot be written: {error}") from error


def _rows(connection: sqlite3.Connection, query: str) -> Iterable[Any]:
    import sqlite3

    try:
        return connection.execute(query).fetchall()
    except sqlite3.Error as error:
        raise AddressError(f"the name server's database cannot be read: {error}") from error


def _inserted(cursor: sqlite3.Cursor) -> int:
    return cursor.lastrowid or 0


def _text(data: bytes) -> str:
    return data.decode("utf-8", "surrogateescape")


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")


def _integer(text: str | None) -> int:
    return int(text) if text and text.isdigit() and len(text) < 12 else 0
