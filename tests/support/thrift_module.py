"""The interface of tests/golden/thrift/apache.thrift, a service of it, and what Apache's own
library was recorded to write (`thrift_apache.py`)."""

from __future__ import annotations

import json
import sys
from functools import cache
from types import ModuleType
from typing import Any

from support.thrift import GOLDEN

import yarpy
from yarpy.kits.thrift.apache.message import Call, Returned
from yarpy.kits.thrift.apache.protocol import Head
from yarpy.kits.thrift.library import load

ROWS: dict[str, dict[str, Any]] = {
    row["name"]: row for row in json.loads((GOLDEN / "apache.json").read_text())
}
SPELLINGS = ("binary", "compact")


@cache
def apache() -> ModuleType:
    """The module of the file."""
    return load(GOLDEN / "apache.thrift")


def data(name: str, spelling: str) -> bytes:
    """The bytes of a recorded message."""
    return bytes.fromhex(ROWS[name][spelling])


def head(name: str) -> Head:
    """The beginning of a recorded message."""
    row = ROWS[name]
    return Head(row["kind"], row["method"], row["number"])


def call(name: str, spelling: str) -> Call:
    """A recorded call, as it comes to a service."""
    found = data(name, spelling)
    return Call(spelling, head(name), found, body(name, spelling))


def returned(name: str, spelling: str) -> Returned:
    """A recorded answer, as it comes to a client."""
    return Returned(spelling, head(name), data(name, spelling), body(name, spelling))


def body(name: str, spelling: str) -> int:
    """Where the struct of a recorded message begins."""
    size = len(ROWS[name]["method"])
    if spelling == "binary":
        return 12 + size
    return 4 + size + (ROWS[name]["number"] > 127)


def everything() -> Any:
    """The struct All that was recorded."""
    m = apache()
    return m.All(
        *(True, -5, -300, 70000, -(1 << 50), 1.5, "grüß", b"\0\1", [1, -2, 300000], {"x", "y"}),
        *({"k": 1 << 40}, m.Mode.MANUAL, m.Inner(1, "n"), [m.Inner(), m.Inner(2)]),
        *({1: [0.5, 2.0]}, m.Shape(radius=2.0), [True, False]),
        s=m.Inner(9),
        t=6,
        u=[7, 0],
        v=[["a"], []],
        w=[1, -1],
        y=[*range(20)],
    )


def service() -> Any:
    """A server of the file's service `Test`."""
    m = apache()

    class Server(m.Test):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            self.fired: list[str] = []

        def ping(self) -> str:
            return "pong"

        def echo(self, all: Any) -> Any:
            return all

        def add(self, a: int, b: int) -> int:
            return a + b

        def is_on(self, value: bool) -> bool:
            return not value

        def nothing(self) -> None:
            pass

        def fire(self, what: str) -> None:
            self.fired.append(what)

        def fail(self, how: int) -> str:
            if how == 1:
                raise m.Bad(5, "bad")
            if how == 2:
                raise m.Worse("worse")
            if how == 3:
                raise yarpy.YarpError("no")
            if how == 4:
                raise ValueError("oops")
            if how == 6:
                sys.exit("leaving")
            if how == 5:
                raise NotImplementedError
            return ",".join(self.fired)

        def missing(self) -> Any:
            return None

        def numbers(self, count: int) -> list[float]:
            return [each / 2 for each in range(count)]

    return Server()
