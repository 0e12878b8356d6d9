"""Registrations and rules in SQLite: what is written, what comes back, files of C++ yarpserver."""

import sqlite3
import threading
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.name_line import new_service

from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.names import database as database_module
from yarpy.names.command import NameService
from yarpy.names.database import Database


class Files:
    """The two database files of a test."""

    def __init__(self, directory: Path) -> None:
        self.ports = directory / "ports.db"
        self.rules = directory / "subs.db"

    def open(self) -> tuple[NameService, Database]:
        database = Database(self.ports, self.rules)
        service = new_service(21130)
        database.load(service)
        return service, database

    def tags(self) -> list[tuple[object, ...]]:
        with sqlite3.connect(self.ports) as connection:
            return connection.execute(
                "SELECT id, rid, ns, name, value FROM tags ORDER BY id"
            ).fetchall()

    def table(self, query: str) -> list[tuple[object, ...]]:
        with sqlite3.connect(self.rules) as connection:
            return connection.execute(query).fetchall()


@pytest.fixture
def files(tmp_path: Path) -> Files:
    return Files(tmp_path)


def say(service: NameService, *commands: str) -> None:
    for command in commands:
        service.answer_text(command, "127.0.0.1")


def listing(service: NameService) -> list[str]:
    return [
        line
        for command in ("list", "subscribe", "topic", "type yarp t", "get /p1 k", "get /p1 type")
        for line in service.answer_text(command).text_lines()
    ]


EVERYTHING = [
    "register /p1 ... ... -1 yarp/image",
    "set /p1 k two 1 one one",
    "register ...",
    "register /m mcast",
    "register /gone",
    "unregister /gone",
    "announce /p1",
    'topic /t "(x 1)"',
    "topic /t2",
    "untopic /t2",
    "subscribe /p1 topic://t",
    "subscribe topic://t udp://q",
    "subscribe /p1 /m from",
    "subscribe /x /y",
    "unsubscribe /x /y",
    'type yarp t "(w 1)"',
]


def test_all_survives(files: Files) -> None:
    service, database = files.open()
    say(service, *EVERYTHING)
    before = listing(service)
    database.close()

    service, database = files.open()
    assert listing(service) == before
    assert service.topology.live == {"/p1": 1000.0}
    assert service.topology.topics == {"/t": "(x 1)"}
    # allocations and habits too
    say(service, "register /new", "register /gone", "register ...", "register /n mcast")
    assert service.store.query("/new") == Contact("tcp", "/new", "127.0.0.1", 21136)
    assert service.store.query("/gone") == Contact("tcp", "/gone", "127.0.0.1", 21135)
    assert service.store.query("/tmp/port/2") is not None
    assert service.store.query("/n") == Contact("mcast", "/n", "224.1.1.4", 21138)
    say(service, "unregister /m", "register /o mcast")
    assert service.store.query("/o") == Contact("mcast", "/o", "224.1.1.3", 21139)
    database.close()


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
    names = [raw, "/ü", "/'; DROP TABLE tags; --", "/nul\0inside", ""]
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
    with sqlite3.connect(files.rules) as connection:
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
    with sqlite3.connect(files.ports) as connection:
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
    with pytest.raises(AddressError, match="out of the way"):
        Database(path)
    with pytest.raises(AddressError, match="failed to open"):
        Database("", tmp_path / "missing" / "subs.db")
    other = tmp_path / "other.db"
    with sqlite3.connect(other) as connection:
        connection.execute("CREATE TABLE tags (something TEXT)")
    with pytest.raises(AddressError, match=r"cannot be read|failed to open"):
        Database(other).load(new_service())


def test_in_memory(tmp_path: Path) -> None:
    database = Database(":memory:")
    assert not database.persistent
    service = new_service()
    database.load(service)
    database.start()
    say(service, *EVERYTHING)
    database.save()
    database.close()
    assert list(tmp_path.iterdir()) == []


def test_one_half_may_be_in_memory(tmp_path: Path) -> None:
    files = Files(tmp_path)
    database = Database(files.ports)
    service = new_service()
    database.load(service)
    say(service, *EVERYTHING)
    database.close()
    assert not files.rules.exists()
    assert len(files.tags()) > 10


def test_written_in_the_background(files: Files) -> None:
    service, database = files.open()
    database.start()
    database.start()
    say(service, "register /a")
    deadline = time.monotonic() + 5
    while not files.tags() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert files.tags(), "nothing was written within 5 s"
    database.close()
    assert all(thread.name != "name database" for thread in threading.enumerate())


def test_registering_does_not_wait_for_the_disk(files: Files) -> None:
    service, database = files.open()
    database.start()
    start = time.perf_counter()
    for n in range(1000):
        say(service, f"register /p{n}")
    assert time.perf_counter() - start < 10
    database.close()
    assert len([row for row in files.tags() if row[3] == "port"]) == 1000


def test_a_failed_write_is_told_and_made_up_for(files: Files) -> None:
    service, database = files.open()
    say(service, "register /a")
    blocker = sqlite3.connect(files.ports, timeout=0.1)
    blocker.execute("BEGIN EXCLUSIVE")
    assert database._ports is not None
    database._ports.execute("PRAGMA busy_timeout = 10")
    with pytest.raises(AddressError, match="cannot be written"):
        database.save()
    blocker.rollback()
    blocker.close()
    say(service, "register /b")
    database.close()
    assert {row[4] for row in files.tags() if row[3] == "port"} == {"/a", "/b"}


def test_trouble_in_the_background_is_logged(
    files: Files, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database_module, "DELAY", 0.0)
    service, database = files.open()
    assert database._ports is not None
    database._ports.execute("DROP TABLE tags")
    database.start()
    say(service, "register /a")
    deadline = time.monotonic() + 5
    while not caplog.records and time.monotonic() < deadline:
        time.sleep(0.01)
    assert "cannot be written" in caplog.records[0].getMessage()
    start = time.monotonic()
    with pytest.raises(AddressError):
        database.close()
    assert time.monotonic() - start < 2, "closing does not wait for the next attempt"


COMMANDS = st.lists(
    st.sampled_from(
        [
            *("register /a", "register /b tcp h 5", "register ...", "register /m mcast"),
            *("unregister /a", "unregister /tmp/port/1", "unregister /m", "set /a k 2 1"),
            *("set /a owns /b", "set /a socket 21133", "announce /a", "announce /b"),
            *("subscribe /a /b from", "subscribe /a topic://t", "unsubscribe /a /b"),
            *("untopic /t", "topic /u x", "SAVE", "REOPEN"),
        ]
    ),
    max_size=25,
)


@settings(max_examples=60, deadline=None)
@given(COMMANDS)
def test_a_restart_changes_nothing(
    tmp_path_factory: pytest.TempPathFactory, commands: list[str]
) -> None:
    """With and without restarts in between, the same commands get the same replies."""
    files = Files(tmp_path_factory.mktemp("names"))
    steady = new_service(21130)
    service, database = files.open()
    for command in commands:
        if command == "SAVE":
            database.save()
        elif command == "REOPEN":
            database.close()
            service, database = files.open()
        else:
            assert service.answer_text(command, "h") == steady.answer_text(command, "h")
    database.close()
    service, database = files.open()
    assert listing(service) == listing(steady)
    for command in ("register /new", "register ...", "register /a", "register /n mcast"):
        assert service.answer_text(command, "h").lines == steady.answer_text(command, "h").lines
    database.close()
