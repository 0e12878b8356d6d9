"""The tables of a name server's two SQLite files, and how registrations and rules stand in them.

Rules: the same tables as C++ yarpserver's, so each can open the other's files. Changes
arrive together, as copies, and are one transaction. Text is stored as the bytes that came. When to
write is `database`'s business.

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

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from yarpy.errors import AddressError
from yarpy.limit import number_in
from yarpy.nameserver.pool import Row
from yarpy.nameserver.store import NameStore
from yarpy.nameserver.topology import Subscription, Topology

if TYPE_CHECKING:
    import sqlite3

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
# Many fields by one statement: others in this process may run Python meanwhile.
_FIELDS = "INSERT INTO tags (rid, name, value) VALUES "
_FIELD = "(?, CAST(? AS TEXT), CAST(? AS TEXT))"
_AT_ONCE = 200  # any SQLite takes 999 values
_IS = "= CAST(? AS TEXT)"


@dataclass(slots=True)
class PortChanges:
    """Ports with their fields (None: gone), pools with their counters and the rows that changed."""

    ports: dict[str, dict[str, list[str]] | None] = field(default_factory=dict)
    pools: dict[str, tuple[int, list[Row]]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.ports or self.pools)


@dataclass(slots=True)
class RuleChanges:
    """Rules, topics, ports that live and structures by their keys; None: gone."""

    rules: dict[tuple[str, str], Subscription | None] = field(default_factory=dict)
    topics: dict[str, str | None] = field(default_factory=dict)
    live: dict[str, float | None] = field(default_factory=dict)
    structures: dict[str, str | None] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.rules or self.topics or self.live or self.structures)


class PortTable:
    """The file of registrations."""

    def __init__(self, path: str | Path, cautious: bool = False) -> None:
        """Open or create it, and read it. Raises AddressError for a file that is no such database,
        or a damaged one."""
        self.connection, self._ports, self._pools = _read(path, _PORTS, cautious, _registrations)
        self._port_ids = {name: row for row, (name, _) in self._ports.items()}
        self._pool_ids: dict[str, int] = {}

    def load(self, store: NameStore) -> None:
        """Fill an empty store with what was there when the file was opened."""
        known = store.pools
        store.restore(dict(self._ports.values()))
        for row, (name, counter, states) in self._pools.items():
            if name in known:
                rows = [(key, used, who) for key, (used, who) in states.items()]
                known[name].restore(counter, rows)
                self._pool_ids[name] = row
        self._ports, self._pools = {}, {}

    def save(self, changes: PortChanges) -> None:
        """Write it all or, with AddressError, nothing."""
        ids = dict(self._port_ids), dict(self._pool_ids)
        try:
            with _transaction(self.connection):
                self._save_ports(changes)
                self._save_pools(changes)
        except AddressError:
            self._port_ids, self._pool_ids = ids
            raise

    def _save_ports(self, changes: PortChanges) -> None:
        connection = self.connection
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
            rows = [(_bytes(key), _bytes(one)) for key, values in fields.items() for one in values]
            for start in range(0, len(rows), _AT_ONCE):
                some = rows[start : start + _AT_ONCE]
                words = [word for pair in some for word in (row, *pair)]
                connection.execute(_FIELDS + ", ".join([_FIELD] * len(some)), words)

    def _save_pools(self, changes: PortChanges) -> None:
        connection = self.connection
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


class RuleTables:
    """The file of subscriptions, topics, ports that live, and structures of types."""

    def __init__(self, path: str | Path, cautious: bool = False) -> None:
        """Open or create it, and read it. Raises AddressError for a file that is no such database,
        or a damaged one."""
        self.connection, *self._found = _read(path, _RULES, cautious, _kept_rules)

    def load(self, topology: Topology) -> None:
        """Fill an empty topology with what was there when the file was opened."""
        topology.restore(*self._found)
        self._found = []

    def save(self, changes: RuleChanges) -> None:
        """Write it all or, with AddressError, nothing."""
        with _transaction(self.connection):
            _save_rules(self.connection, changes)
            _save_texts(self.connection, "topics", "topic", "structure", changes.topics)
            _save_texts(self.connection, "structures", "name", "yarp", changes.structures)
            _save_live(self.connection, changes)


def _save_rules(connection: sqlite3.Connection, changes: RuleChanges) -> None:
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


def _save_texts(
    connection: sqlite3.Connection,
    table: str,
    key: str,
    column: str,
    items: dict[str, str | None],
) -> None:
    for name, text in items.items():
        if text is None:
            connection.execute(f"DELETE FROM {table} WHERE {key} {_IS}", (_bytes(name),))
            continue
        pair = (_bytes(text), _bytes(name))
        value = "nullif(CAST(? AS TEXT), '')"
        updated = connection.execute(
            f"UPDATE {table} SET {column} = {value} WHERE {key} {_IS}", pair
        )
        if not updated.rowcount:
            connection.execute(
                f"INSERT INTO {table} ({column}, {key}) VALUES ({value}, CAST(? AS TEXT))", pair
            )


def _save_live(connection: sqlite3.Connection, changes: RuleChanges) -> None:
    for name, stamp in changes.live.items():
        connection.execute(f"DELETE FROM live WHERE name {_IS}", (_bytes(name),))
        if stamp is not None:
            connection.execute(
                "INSERT INTO live (name, stamp) VALUES (CAST(? AS TEXT), datetime(?, 'unixepoch'))",
                (_bytes(name), stamp),
            )


# --- reading

_Ports: TypeAlias = dict[int, tuple[str, dict[str, list[str]]]]
_Pools: TypeAlias = dict[int, tuple[str, int, dict[str, list[Any]]]]


def _registrations(connection: sqlite3.Connection) -> tuple[_Ports, _Pools]:
    """Ports with their fields, and pools with their counters and rows, by their ids."""
    ports: _Ports = {}
    pools: _Pools = {}
    for row, ns, name, value in _rows(
        connection, "SELECT id, ns, name, value FROM tags WHERE rid IS NULL ORDER BY id"
    ):
        if ns is None and name == "port" and value is not None:
            ports[row] = (value, {})
        elif ns == "alloc":
            pools[row] = (name or "", _integer(value), {})
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
    return ports, pools


def _kept_rules(connection: sqlite3.Connection) -> tuple[Any, ...]:
    """Return the arguments for `Topology.restore`."""
    _add_columns(connection)
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
    return (
        rules,
        {topic or "": structure or "" for topic, structure in topics},
        {name or "": float(stamp or 0) for name, stamp in live},
        {name or "": structure or "" for name, structure in structures},
    )


# --- SQLite


def _mend(path: str | Path, error: Exception) -> str:
    """Return what to do about a database that cannot be opened."""
    folder = Path(path).parent
    if not folder.is_dir():
        return f"there is no folder {folder}; make it first"
    if Path(path).is_dir():
        return "that is a folder; name a file in it"
    if "full" in str(error):
        return "make room, or name a file on another disk"
    if not Path(path).exists():
        return f"no file can be made in {folder}; name one in another folder"
    return "move the file out of the way, or name another one"


def _read(
    path: str | Path,
    schema: str,
    cautious: bool,
    read: Callable[[sqlite3.Connection], tuple[Any, ...]],
) -> tuple[Any, ...]:
    """The open file and what `read` finds in it. Raises AddressError."""
    import sqlite3  # late: most programs are clients

    connection = None
    try:
        # isolation_level None: transactions begin and end where `_transaction` says.
        connection = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        connection.text_factory = _text
        connection.execute(f"PRAGMA synchronous = {'FULL' if cautious else 'OFF'}")
        connection.executescript(schema)
        return connection, *read(connection)
    except (sqlite3.Error, _Damaged) as error:
        if connection is not None:
            connection.close()
        raise AddressError(
            f'failed to open database "{path}" ({error}): {_mend(path, error)}'
        ) from (error)


class _Damaged(ValueError):
    """Rows that no name server has written."""


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
            connection.execute("COMMIT")
        except BaseException:
            connection.rollback()  # also when a reader blocked the commit: the next starts afresh
            raise
    except sqlite3.Error as error:
        raise AddressError(f"the name server's database cannot be written: {error}") from error


def _rows(connection: sqlite3.Connection, query: str) -> list[Any]:
    found = connection.execute(query).fetchall()
    if any(type(value) is bytes for row in found for value in row):
        raise _Damaged("it holds bytes where a name server writes text")
    return found


def _inserted(cursor: sqlite3.Cursor) -> int:
    return cursor.lastrowid or 0


def _text(data: bytes) -> str:
    return data.decode("utf-8", "surrogateescape")


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")


def _integer(text: str | None) -> int:
    return number_in(text or "", 10**11) or 0
