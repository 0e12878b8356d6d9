"""The database files of a name server in a test, and commands that leave something in each."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

from support.name_line import new_service

from yarpy.nameserver.command import NameService
from yarpy.nameserver.database import Database


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
        with closing(sqlite3.connect(self.ports)) as connection, connection:
            return connection.execute(
                "SELECT id, rid, ns, name, value FROM tags ORDER BY id"
            ).fetchall()

    def table(self, query: str) -> list[tuple[object, ...]]:
        with closing(sqlite3.connect(self.rules)) as connection, connection:
            return connection.execute(query).fetchall()


def say(service: NameService, *commands: str) -> None:
    for command in commands:
        service.answer_text(command, "127.0.0.1")


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
