"""What monitors that decide cost per message: scripts in Python and in Lua, and priority.

    python bench/monitor_cost.py

Prints microseconds per message, the best of several runs; one thread, nothing is sent.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from yarpy.data.bottle import Bottle
from yarpy.monitors.base import Group, Place
from yarpy.monitors.script.portmonitor import portmonitor
from yarpy.monitors.stock.priority import Priority
from yarpy.route import parse_carrier
from yarpy.wire.message import DATA, Message

RUNS, COUNT = 7, 5000
PAYLOAD = Bottle([1, "ping", 3.14]).to_bytes()

SCRIPTS = {
    "python: accept that says yes": ("python", "def accept(message): return True"),
    "python: accept that looks inside": (
        "python",
        "def accept(message): return message.value[1] == 'ping'",
    ),
    "python: update that appends": (
        "python",
        "def update(message): return [*message.value, 'seen']",
    ),
    "lua: accept that says yes": ("lua", "PortMonitor.accept = function(thing) return true end"),
    "lua: accept that looks inside": (
        "lua",
        "PortMonitor.accept = function(thing)\n"
        "  return thing:asBottle():get(1):asString() == 'ping'\nend",
    ),
    "lua: update that appends": (
        "lua",
        "PortMonitor.update = function(thing)\n  thing:asBottle():addString('seen')\n"
        "  return thing\nend",
    ),
}


def best(function: Callable[[Message], object]) -> float:
    """Seconds for one call with a message of its own."""
    found = []
    for _ in range(RUNS):
        messages = [Message(DATA, PAYLOAD) for _ in range(COUNT)]
        start = time.perf_counter()
        for message in messages:
            function(message)
        found.append((time.perf_counter() - start) / COUNT)
    return min(found)


def scripted(folder: Path, kind: str, text: str) -> Callable[[Message], object]:
    """What a connection does with each message: accept, then update."""
    path = folder / f"script_{kind}"
    path.write_text(text)
    tokens = (f"type.{kind}", f"file.{path}")
    monitor: object = portmonitor(Place("/a", "/b", "", False, tokens, tokens))

    def take(message: Message) -> None:
        monitor.accept(message)  # type: ignore[attr-defined]
        monitor.update(message)  # type: ignore[attr-defined]

    return take


def contest(size: int, links: bool) -> Callable[[Message], object]:
    """`size` connections that compete for a port, each in its turn."""
    group, monitors = Group(), []
    for number in range(size):
        others = f"+(ex (/{(number + 1) % size} -5) (/{(number + 3) % size} 2))" if links else ""
        tokens = parse_carrier(f"tcp+recv.priority+bs.{number + 1}{others}").tokens
        monitors.append(Priority(Place(f"/{number}", "/in", "", False, tokens, tokens, group)))
        group.add(monitors[-1])
    turns = [monitor.accept for monitor in monitors]
    count = 0

    def take(message: Message) -> None:
        nonlocal count
        count += 1
        turns[count % size](message)

    return take


def main() -> None:
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, (kind, text) in SCRIPTS.items():
            rows[name] = best(scripted(Path(folder), kind, text))
    rows["priority, 8 connections"] = best(contest(8, links=False))
    rows["priority, 8 connections that act on each other"] = best(contest(8, links=True))
    for name, seconds in rows.items():
        print(f"{name:48} {seconds * 1e6:6.1f} us")


if __name__ == "__main__":
    main()
