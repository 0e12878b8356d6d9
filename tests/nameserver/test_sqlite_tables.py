"""The rows of a name server's database: those of C++ yarpserver, and whatever else is found.

Restarts and the moment of writing are tested with `database`; here is what stands in the files.
"""

from __future__ import annotations

import sqlite3
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from support.name_database import EVERYTHING, Files, say

from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.nameserver.sqlite_tables import PortChanges, PortTable, RuleChanges, RuleTables
from yarpy.nameserver.topology import Subscription


@pytest.fixture
def files(tmp_path: Path) -> Files:
    return Files(tmp_path)


def test_the_rows_are_those_of_the_original(files: Files) -> None:
    service, database = files.open()
    say(service, "register /p1", "set /p1 offers tcp udp", "register ...")
    database.close()
    rows = files.tags()
    ports = {value: row for row, rid, ns, name, value in rows if rid is None and name == "port"}
    assert set(ports) == {"/p1", "/tmp/port/1"}
    fields = sorted((name, value) for _, rid, ns, name, value in rows if rid == ports["/p1"])
    assert fields == [
        *(("carrier", "tcp"), ("host", "127.0.0.1"), ("offers", "tcp"), ("offers", "udp")),
        ("socket", "21132"),
    ]
    pools = {name: (row, value) for row, rid, ns, name, value in rows if ns == "alloc" and not rid}
    assert pools["regid"][1] == "21133"
    assert pools["tmpid"][1] == "1"
    lent = sorted((ns, name, value) for _, rid, ns, name, value in rows if rid == pools["regid"][0])
    assert lent == [
        *(("alloc", "21132", "in_use"), ("alloc", "21133", "in_use")),
        *(("prefer", "21132", "/p1"), ("prefer", "21133", "/tmp/port/1")),
    ]
    temporary = [row[2:] for row in rows if row[1] == pools["tmpid"][0]]
    assert temporary == [("alloc", "/tmp/port/1", "in_use")]


def test_the_tables_of_rules_are_those_of_the_original(files: Files) -> None:
    service, database = files.open()
    say(service, *EVERYTHING)
    database.close()
    assert sorted(files.table("SELECT src, dest, srcFull, destFull, mode FROM subscriptions")) == [
        ("/p1", "/m", "/p1", "/m", "from"),
        ("/p1", "/t", "/p1", "topic://t", None),
        ("/t", "/q", "topic://t", "udp://q", None),
    ]
    assert files.table("SELECT topic, structure FROM topics") == [("/t", "(x 1)")]
    assert files.table("SELECT name, stamp FROM live") == [("/p1", "1970-01-01 00:16:40")]
    assert files.table("SELECT name, yarp FROM structures") == [("t", "(w 1)")]


def test_nothing_is_left_of_what_went(files: Files) -> None:
    service, database = files.open()
    say(service, "register /a", "set /a k 1 2 3", "subscribe /a /b", "announce /a", "topic /t")
    database.save()
    assert len(files.tags()) > 5
    say(service, "unregister /a", "unsubscribe /a /b", "untopic /t")
    database.save()
    assert [row for row in files.tags() if row[3] == "port"] == []
    assert [row[2:] for row in files.tags()] == [
        ("alloc", "regid", "21132"),
        ("alloc", "21132", "free"),
        ("prefer", "21132", "/a"),
    ]
    for table in ("subscriptions", "live", "topics"):
        assert files.table(f"SELECT count(*) FROM {table}") == [(0,)]
    say(service, "register /a")
    database.close()
    service, database = files.open()
    assert service.store.query("/a") == Contact("tcp", "/a", "127.0.0.1", 21132)
    database.close()


def test_raw_bytes_and_odd_text_survive(files: Files) -> None:
    service, database = files.open()
    raw = b"/caf\xe9".decode("utf-8", "surrogateescape")
    names = [raw, "/ü", "/'; DROP TABLE tags; --", "/\N{WHITE SMILING FACE}", ""]
    for number, name in enumerate(names, 1):
        service.store.register(name, "tcp", "h", number)
        service.store.assign(name, "k", [name, "x\0y"])
    database.close()
    service, database = files.open()
    for number, name in enumerate(names, 1):
        assert service.store.query(name) == Contact("tcp", name, "h", number)
        assert service.store.values(name, "k") == sorted([name, "x\0y"])
    database.close()


def test_old_files_get_their_columns(files: Files) -> None:
    with closing(sqlite3.connect(files.rules)) as connection, connection:
        connection.executescript(
            """
            CREATE TABLE subscriptions (id INTEGER PRIMARY KEY, src TEXT, dest TEXT,
                                        srcFull TEXT, destFull TEXT);
            CREATE TABLE topics (id INTEGER PRIMARY KEY, topic TEXT);
            INSERT INTO subscriptions VALUES (1, '/a', '/b', '/a', 'udp://b');
            INSERT INTO subscriptions VALUES (2, '/c', '/d', NULL, NULL);
            INSERT INTO topics VALUES (1, '/t');
            """
        )
    service, database = files.open()
    assert [(r.source, r.destination, r.carrier) for r in service.topology.subscriptions()] == [
        ("/a", "/b", "udp"),
        ("/c", "/d", ""),
    ]
    assert service.topology.topics == {"/t": ""}
    say(service, "register /b", "subscribe /a /b to", "topic /u x")
    database.close()
    assert files.table("SELECT src, mode FROM subscriptions") == [("/c", None), ("/a", "to")]
    assert files.table("SELECT structure FROM topics WHERE topic = '/u'") == [("x",)]


def test_strange_rows_are_passed_over(files: Files) -> None:
    _, database = files.open()
    database.close()
    with closing(sqlite3.connect(files.ports)) as connection, connection:
        connection.executescript(
            """
            INSERT INTO tags VALUES (1, NULL, NULL, 'port', '/a');
            INSERT INTO tags VALUES (2, 1, NULL, 'socket', 'many');
            INSERT INTO tags VALUES (3, 1, NULL, NULL, NULL);
            INSERT INTO tags VALUES (4, 99, NULL, 'host', 'orphan');
            INSERT INTO tags VALUES (5, NULL, 'alloc', 'regid', 'no number');
            INSERT INTO tags VALUES (6, 5, 'other', '21132', 'in_use');
            INSERT INTO tags VALUES (7, NULL, 'alloc', 'unknown', '5');
            INSERT INTO tags VALUES (8, NULL, NULL, 'port', NULL);
            """
        )
    service, database = files.open()
    assert service.store.query("/a") == Contact("tcp", "/a", "localhost", 0)
    say(service, "register /b")
    assert service.store.query("/b") == Contact("tcp", "/b", "127.0.0.1", 21132)
    database.close()


def test_what_is_no_database(tmp_path: Path) -> None:
    path = tmp_path / "text.db"
    path.write_text("this is not a database, " * 100)
    for kind in (PortTable, RuleTables):
        with pytest.raises(AddressError, match="out of the way"):
            kind(path)
        with pytest.raises(AddressError, match=r"there is no folder .*missing; make it first"):
            kind(tmp_path / "missing" / "subs.db")
        with pytest.raises(AddressError, match="that is a folder; name a file in it"):
            kind(tmp_path)
    other = tmp_path / "other.db"
    with closing(sqlite3.connect(other)) as connection, connection:
        connection.execute("CREATE TABLE tags (something TEXT)")
    with pytest.raises(AddressError, match="failed to open"):
        PortTable(other)


def test_where_no_file_can_be_made() -> None:
    if sys.platform != "linux":
        pytest.skip("only Linux has a folder, /proc, in which nobody can make a file")
    with pytest.raises(AddressError, match="no file can be made in /proc; name one in another"):
        PortTable(Path("/proc/yarpy.db"))


@pytest.fixture
def table(files: Files) -> Iterator[PortTable]:
    found = PortTable(files.ports)
    with closing(found.connection):
        yield found


def test_a_write_that_fails_leaves_nothing_and_can_be_repeated(
    files: Files, table: PortTable
) -> None:
    table.connection.execute("CREATE UNIQUE INDEX one ON tags(name) WHERE name = 'once'")
    changes = PortChanges({"/a": {"once": ["1", "2"]}}, {"regid": (7, [("7", True, "/a")])})
    with pytest.raises(AddressError, match="cannot be written"):
        table.save(changes)
    assert files.tags() == []
    changes.ports["/a"] = {"once": ["1"]}
    for _ in range(2):
        table.save(changes)
        assert {row[2:] for row in files.tags()} == {
            *((None, "port", "/a"), (None, "once", "1"), ("alloc", "regid", "7")),
            *(("alloc", "7", "in_use"), ("prefer", "7", "/a")),
        }
        assert len(files.tags()) == 5


def test_somebody_who_reads_the_file_holds_only_one_write_up(
    files: Files, table: PortTable
) -> None:
    table.connection.execute("PRAGMA busy_timeout = 10")
    table.save(PortChanges({"/a": {}, "/b": {}}))
    reader = sqlite3.connect(files.ports, isolation_level=None)
    reader.execute("BEGIN")
    reading = reader.execute("SELECT * FROM tags")
    reading.fetchone()
    with pytest.raises(AddressError, match="cannot be written"):
        table.save(PortChanges({"/c": {}}))
    reading.close()
    reader.close()
    table.save(PortChanges({"/c": {}}))
    assert [row[4] for row in files.tags()] == ["/a", "/b", "/c"]


def test_nothing_changed() -> None:
    assert not PortChanges()
    assert not RuleChanges()
    assert PortChanges({"/a": None})
    assert RuleChanges(live={"/a": None})


def test_rules_are_replaced_by_their_ends(files: Files) -> None:
    tables = RuleTables(files.rules)
    for mode in ("from", "to"):
        tables.save(RuleChanges({("/a", "/b"): Subscription("/a", "udp://b", mode)}))
    assert files.table("SELECT src, destFull, mode FROM subscriptions") == [("/a", "udp://b", "to")]
    tables.save(RuleChanges({("/a", "/b"): None}))
    assert files.table("SELECT * FROM subscriptions") == []
    tables.connection.close()
