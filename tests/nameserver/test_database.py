"""Registrations and rules that outlive a name server: what comes back, and when it is written."""

import contextlib
import socket
import sqlite3
import threading
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.lasted import lasted
from support.name_database import EVERYTHING, Files, say
from support.name_line import new_service
from support.wait import HANG, wait_until

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import AddressError
from yarpy.nameserver import database as database_module
from yarpy.nameserver.command import NameService
from yarpy.nameserver.database import Database
from yarpy.nameserver.server import NameServer
from yarpy.nameserver.sqlite_tables import PortChanges


@pytest.fixture
def files(tmp_path: Path) -> Files:
    return Files(tmp_path)


def listing(service: NameService) -> list[str]:
    return [
        line
        for command in ("list", "subscribe", "topic", "type yarp t", "get /p1 k", "get /p1 type")
        for line in service.answer_text(command).text_lines()
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


def test_what_is_no_database(tmp_path: Path) -> None:
    path = tmp_path / "text.db"
    path.write_text("this is not a database, " * 100)
    with pytest.raises(AddressError, match="out of the way"):
        Database(path)
    with pytest.raises(AddressError, match="failed to open"):
        Database(tmp_path / "good.db", tmp_path / "missing" / "subs.db")


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
    wait_until(files.tags)
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
    database._ports.connection.execute("PRAGMA busy_timeout = 10")
    with pytest.raises(AddressError, match="cannot be written"):
        database.save()
    blocker.rollback()
    blocker.close()
    say(service, "register /b")
    database.close()
    assert {row[4] for row in files.tags() if row[3] == "port"} == {"/a", "/b"}


def test_one_file_that_cannot_be_written_does_not_double_the_other(files: Files) -> None:
    service, database = files.open()
    say(service, "register /a", "subscribe /a /b")
    assert database._rules is not None
    database._rules.connection.execute("DROP TABLE subscriptions")
    with pytest.raises(AddressError, match="cannot be written"):
        database.save()
    with pytest.raises(AddressError):
        database.close()
    assert [row[4] for row in files.tags() if row[3] == "port"] == ["/a"]


def test_trouble_in_the_background_is_logged(
    files: Files, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database_module, "DELAY", 0.0)
    service, database = files.open()
    assert database._ports is not None
    database._ports.connection.execute("DROP TABLE tags")
    database.start()
    say(service, "register /a")
    wait_until(lambda: caplog.records)
    assert "cannot be written" in caplog.records[0].getMessage()
    start = time.monotonic()
    with pytest.raises(AddressError):
        database.close()
    assert lasted(start) < 2, "closing does not wait for the next attempt"


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


@settings(max_examples=60)
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


def test_two_servers_on_one_file(tmp_path: Path) -> None:
    """The second is refused; when the first has ended, or was killed, it may."""
    ports, rules = tmp_path / "ports.db", tmp_path / "subs.db"
    first = Database(ports, rules)
    for second in ((ports, ""), ("", rules), (ports, rules)):
        with pytest.raises(AddressError, match="another name server keeps its names in"):
            Database(*second)
    Database(tmp_path / "other.db").close()
    first.close()
    Database(ports, rules).close()


def test_a_cautious_database_settles_what_changed(files: Files) -> None:
    """Who has an answer finds the change in the file, whatever happens to the server then."""
    ports, rules = files.ports, files.rules
    database = Database(ports, rules, cautious=True)
    service = new_service()
    database.load(service)
    service.answer(Bottle(["register", "/a", "tcp", "127.0.0.1", 10]))
    database.settle()
    copied = ports.with_name("copy")
    copied.write_bytes(ports.read_bytes())
    again = new_service()
    other = Database(copied, "")
    other.load(again)
    assert "/a" in again.store
    other.close()
    database.close()


def test_those_who_wait_share_a_transaction(files: Files, monkeypatch: pytest.MonkeyPatch) -> None:
    database = Database(files.ports, files.rules, cautious=True)
    service = new_service()
    database.load(service)
    assert database._ports is not None
    writes: list[int] = []
    begun, go_on = threading.Event(), threading.Event()
    save = database._ports.save

    def slow(changes: PortChanges) -> None:
        writes.append(len(changes.ports))
        begun.set()
        assert go_on.wait(HANG)
        save(changes)

    monkeypatch.setattr(database._ports, "save", slow)

    def register(name: str) -> None:
        service.answer(Bottle(["register", name, "tcp", "127.0.0.1", 10]))
        noted.release()
        database.settle()

    noted = threading.Semaphore(0)
    threads = [threading.Thread(target=register, args=(f"/p{n}",)) for n in range(20)]
    threads[0].start()
    assert begun.wait(HANG)
    for thread in threads[1:]:
        thread.start()
    for _ in threads:
        assert noted.acquire(timeout=HANG)
    assert all(thread.is_alive() for thread in threads)  # nobody is told before the disk has it
    go_on.set()
    for thread in threads:
        thread.join(HANG)
    assert writes == [1, 19]
    service.answer(Bottle(["query", "/p1"]))
    database.settle()  # a question waits for nobody
    assert writes == [1, 19]
    database.close()


@pytest.mark.parametrize("damage", ["blob", "page"])
def test_damaged_files_are_noticed_before_anybody_can_call(files: Files, damage: str) -> None:
    ports = files.ports
    with NameServer(portdb=ports) as server:
        for n in range(300):
            server.service.answer(Bottle(["register", f"/p{n}", "tcp", "127.0.0.1", 10 + n]))
    if damage == "blob":
        with contextlib.closing(sqlite3.connect(ports)) as connection:
            connection.execute("UPDATE tags SET value = x'ff00fe'")
            connection.commit()
    else:
        data = bytearray(ports.read_bytes())
        data[4096:] = b"\x55" * (len(data) - 4096)
        ports.write_bytes(data)
    with pytest.raises(AddressError, match=r"failed to open .*: move the file out of the way"):
        Database(ports)
    with socket.socket() as listening:  # and the port is not even asked for
        listening.bind(("127.0.0.1", 0))
        listening.listen()
        with pytest.raises(AddressError, match="move the file out of the way"):
            NameServer(listening.getsockname()[1], portdb=ports)
