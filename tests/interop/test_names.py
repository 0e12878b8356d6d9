"""Our name room against the C++ name server and tools: client, databases, discovery, replies."""

import contextlib
import random
import socket
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing

from support.cpp import CppYarp
from support.name_line import new_service, serve_names
from support.wait import HANG

from yarpy.contact import Contact
from yarpy.names.client import YarpNameClient
from yarpy.names.discovery import Responder, search
from yarpy.nameserver.command import NameService
from yarpy.nameserver.database import Database


def client_of(server: CppYarp) -> YarpNameClient:
    return YarpNameClient(server.host, server.port, 5.0)


def test_client_of_a_cpp_server(cpp_server: CppYarp) -> None:
    first = cpp_server.port + 2
    with client_of(cpp_server) as names:
        assert names.register("/x") == Contact("tcp", "/x", "127.0.0.1", first)
        assert names.register("/y", "udp", "10.0.0.1", 5) == Contact("udp", "/y", "10.0.0.1", 5)
        assert names.register("/t", port_type="yarp/image").port == first + 1
        assert names.get("/t", "type") == ["yarp/image"]
        assert names.register("...").name == "/tmp/port/1"
        group = names.register("...", "mcast")
        assert (group.name, group.host) == ("/tmp/port/2", "224.1.1.3")
        assert names.register("/with space").port == first + 4
        assert names.query("/with space") == Contact("tcp", "/with space", "127.0.0.1", first + 4)
        names.announce("/x")
        names.announce("/x", ok=False)
        assert names.set("/x", "ips", "127.0.0.1", "10.0.0.1") == ["10.0.0.1", "127.0.0.1"]
        assert names.get("/x", "ips") == ["10.0.0.1", "127.0.0.1"]
        assert names.get("/nope", "ips") == []
        names.introduce("/x", {"ips": ["::1"], "offers": ["tcp", "udp"], "process": [17]})
        told = [names.get("/x", key) for key in ("ips", "offers", "process")]
        assert told == [["::1"], ["tcp", "udp"], ["17"]]
        assert [c.name for c in names.list("/tmp")] == ["/tmp/port/1", "/tmp/port/2"]
        assert names.list()[-1] == Contact("mcast", "fallback", "224.2.1.1", cpp_server.port)
        assert names.request(["subscribe", "/x", "topic://top"]) == ["ok"]
        assert names.request(["topic"]) == ["/top"]
        assert names.request(["subscribe", "/x"]).group("subscription") is not None
        assert names.command("bogus") == []
        names.unregister("/x")
        assert names.query("/x") is None
        listing = cpp_server.run("name", "list").stdout
        assert "registration name /y ip 10.0.0.1 port 5 type udp\n" in listing


def test_names_that_cpp_opens_and_nobody_connects(cpp_server: CppYarp) -> None:
    """Which is why they are refused here (`check_name`)."""
    with cpp_server.popen("read", "/slash/") as slash, cpp_server.popen("read", "/cut here") as cut:
        slash.wait_line("Port /slash/ active")
        cut.wait_line("Port /cut active")
        with cpp_server.popen("write", "/w") as writer:
            writer.wait_line("Port /w active")
            for name in ("/slash/", "/cut here"):
                for ends in (("/w", name), (name, "/w")):
                    done = cpp_server.run("connect", *ends)
                    assert done.returncode and "no way to make connection" in done.stderr


def test_client_survives_a_restart_of_the_cpp_server(cpp: CppYarp) -> None:
    with cpp.server() as server:
        names = client_of(server)
        names.register("/x")
        names.set("/x", "k", 1)
        port = server.port
    with cpp.server(port=port):
        assert names.query("/x") is None
        assert names.get("/x", "k") == []
        names.close()


# --- databases

COMMANDS = [
    ["register", "/p1", "...", "...", -1, "yarp/image"],
    ["set", "/p1", "k", "two", 1, "one", "one"],
    ["register", "..."],
    ["register", "/m", "mcast"],
    ["register", "/gone"],
    ["unregister", "/gone"],
    ["announce", "/p1"],
    ["topic", "/t"],
    ["subscribe", "/a", "topic://t"],
    ["subscribe", "topic://t", "udp://b"],
    ["subscribe", "/p1", "/r", "from"],
    ["type", "yarp", "t", "w"],
]
QUESTIONS = [
    *(["list", "/p1"], ["list", "/m"], ["list", "/tmp"], ["get", "/p1", "k"], ["topic"]),
    *(["get", "/p1", "type"], ["subscribe"], ["type", "yarp", "t"], ["query", "/gone"]),
]
# What is allocated next tells whether counters, free numbers and habits survived.
NEXT = [["register", name] for name in ("/new", "/gone", "...", "/p1")]


def answers(names: YarpNameClient, commands: list[list[str | int]]) -> list[object]:
    return [names.request(command) for command in commands]


def our_answers(service: NameService, commands: list[list[str | int]]) -> list[object]:
    replies = [service.answer(command, "127.0.0.1") for command in commands]
    return [list(r.lines[:-1]) if r.bottle is None else r.bottle for r in replies]


def test_our_server_goes_on_with_a_cpp_database(cpp: CppYarp) -> None:
    with cpp.server() as server, client_of(server) as names:
        answers(names, COMMANDS)
        expected = answers(names, QUESTIONS)
        with (
            closing(sqlite3.connect(server.home / "port.db")) as source,
            closing(sqlite3.connect(server.home / "ours.db")) as copy,
        ):
            source.backup(copy)
        with (
            closing(sqlite3.connect(server.home / "subscription.db")) as source,
            closing(sqlite3.connect(server.home / "our_subs.db")) as copy,
        ):
            source.backup(copy)
        database = Database(server.home / "ours.db", server.home / "our_subs.db")
        service = new_service(server.port)
        database.load(service)
        assert our_answers(service, QUESTIONS) == expected
        assert "/p1" in service.topology.live
        assert abs(service.topology.live["/p1"] - time.time()) < 60, "stamps are UTC"
        assert our_answers(service, NEXT) == answers(names, NEXT)
        database.close()


@contextlib.contextmanager
def cpp_server_on(client: CppYarp, ports: str, rules: str) -> Iterator[None]:
    """A C++ name server on files that exist: it refuses to be told an address then."""
    arguments = ("--read", "--portdb", ports, "--subdb", rules)
    with client.popen(*arguments, program="yarpserver") as process:
        deadline = time.monotonic() + HANG
        while True:
            try:
                socket.create_connection((client.host, client.port), 1).close()
                break
            except OSError:
                assert time.monotonic() < deadline and process.returncode is None, process.stderr
                time.sleep(0.02)
        yield


def test_a_cpp_server_goes_on_with_our_database(cpp: CppYarp) -> None:
    with cpp.server() as first:
        port = first.port  # a number that is free again when that server has ended
    with cpp.at("127.0.0.1", port) as client:
        database = Database(client.home / "ports.db", client.home / "subs.db")
        service = new_service(port)
        database.load(service)
        our_answers(service, COMMANDS)
        expected = our_answers(service, QUESTIONS)
        database.close()
        with cpp_server_on(client, "ports.db", "subs.db"), client_of(client) as names:
            assert answers(names, QUESTIONS) == expected
            assert answers(names, NEXT) == our_answers(service, NEXT)


# --- discovery


def test_a_cpp_server_is_found(cpp_server: CppYarp) -> None:
    # C++ listens for questions on YARP_PORT_RANGE, which is the server's own port here.
    found = search("/root", cpp_server.port, tries=60)
    assert found == Contact("tcp", "/root", "127.0.0.1", cpp_server.port)


def test_cpp_finds_our_server(cpp: CppYarp) -> None:
    with serve_names() as server:
        server.service.answer_text(f"register /root tcp 127.0.0.1 {server.port}")
        with (
            Responder(server.service.answer_multicast, server.port),
            cpp.at("127.0.0.1", server.port) as client,
        ):
            (client.home / "config/yarp.conf").unlink()
            found = client.run("detect", "--write")
            assert found.returncode == 0, found.stdout + found.stderr
            address = (client.home / "config/yarp.conf").read_text()
            assert address == f"127.0.0.1 {server.port} yarp\n"
            listing = client.run("name", "list").stdout
            assert "registration name /root ip 127.0.0.1" in listing


# --- replies

NAMES = ["/a", "/b", "/c", "/d/e", "/d", "noslash", "/with-dash", "...", "/x:i", '"/sp ace"', "/ü"]
DECORATED = ["/net=127/a", "/net=10/b", "udp://a", "tcp:/a"]
KEYS = ["offers", "ips", "k", "type", "yarprun", "port", '""', "(a b)", "5"]
VALUES = [
    *("tcp", "/a", "10.0.0.1", "127.0.0.1", "1", "2.5", "0x1F", '"q s"', "(1 2)", "[voc]"),
    *("true", '"(1 2)"', '""', "(a (b c))", "{1 2}", "1e3", "077", "...", '"12"', "x.y", "-"),
]


NAMED = {"register", "unregister", "set", "get", "check"}
READABLE = {"query", "list", "set", "get", "help", "runners", "check", "route", "register"}


def random_command(rnd: random.Random) -> str:
    """A command whose reply does not depend on a bug of C++."""
    verb = rnd.choice(
        [
            *(["register"] * 5 + ["unregister"] * 2 + ["query"] * 4 + ["set"] * 4 + ["get"] * 3),
            *("check", "list", "list", "route", "gc", "help", "runners", "bogus", "topic"),
        ]
    )
    words = [verb]
    if verb in ("query", "route"):
        words += [rnd.choice(NAMES + DECORATED) for _ in range(1 if verb == "query" else 2)]
    elif verb in NAMED or (verb == "list" and rnd.random() < 0.5):
        words.append(rnd.choice(NAMES))
    if verb == "register" and rnd.random() < 0.6:
        words.append(rnd.choice(["tcp", "udp", "mcast", "...", "topic"]))
        if rnd.random() < 0.7:
            words.append(rnd.choice(["...", "10.0.0.1", "host"]))
            if rnd.random() < 0.7:
                words.append(rnd.choice(["...", "-1", "0", "5", "abc", "2.5"]))
                if rnd.random() < 0.3:
                    words.append(rnd.choice(["*", "yarp/image"]))
    if verb in ("set", "get", "check"):
        words.append(rnd.choice(KEYS))
    if verb in ("set", "check"):
        words += [rnd.choice(VALUES) for _ in range(rnd.randint(0, 4) if verb == "set" else 1)]
    text = " ".join(words)
    if verb in READABLE and rnd.random() < 0.35:
        text = f"bot {text}"
    return f"NAME_SERVER {text}" if rnd.random() < 0.05 and verb != "topic" else text


def test_replies_are_those_of_a_cpp_server(cpp_server: CppYarp) -> None:
    """The same random commands to both, byte for byte."""
    rnd = random.Random(20)
    service = new_service(cpp_server.port)
    with socket.create_connection((cpp_server.host, cpp_server.port), HANG) as connection:
        lines = connection.makefile("rb")

        def ask(text: str) -> bytes:
            connection.sendall(f"d\r\n{text}\r\n".encode())
            reply = b""
            while (line := lines.readline()) != b"<ACK>\r\n":
                assert line, f"the C++ server hung up after: {text}"
                reply += line
            return reply

        connection.sendall(b"CONNACK admin\r\n")
        assert lines.readline() == b"Welcome admin\r\n"
        for name in ("/root", "fallback"):
            ask(f"unregister {name}")
        for _ in range(800):
            command = random_command(rnd)
            assert ask(command) == service.answer_text(command, "127.0.0.1").to_bytes(), command
