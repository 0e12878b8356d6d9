"""The log of a node: what it says comes to /rosout, where `rqt_console` and others read it.

Rules: a logger of Python, whose numbers of levels are those of ROS 2. Its records go to the
program's own handlers, too. They are the program's words, so nothing is taken out of them.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any, Final

from yarpy.errors import AddressError
from yarpy.log import logger
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import TRANSIENT_LOCAL, Qos

log = logger("yarpy.ros2")

TOPIC: Final = "/rosout"
TYPE: Final = "rcl_interfaces/msg/Log"
QOS: Final = Qos(durability=TRANSIENT_LOCAL, depth=1000, lifespan=(10, 0))

#: as `--log-level` has them
LEVELS: Final = {
    "debug": logging.DEBUG,
    "info": logging.INFO,
    "warn": logging.WARNING,
    "warning": logging.WARNING,
    "error": logging.ERROR,
    "fatal": logging.CRITICAL,
}


def node_logger(node: Node, level: str = "") -> logging.Logger:
    """The logger of a node, by its name with dots. It shows INFO and more, as in ROS 2, or what
    `level` says. Raises AddressError."""
    found = LEVELS.get(level.lower() or "info")
    if found is None:
        raise AddressError(f'"{level[:80]}" is no level of a log: it is one of {", ".join(LEVELS)}')
    made = logging.Logger(str(node).strip("/").replace("/", "."), found)
    made.parent = log  # not one by this name for all of the program: two nodes may have one
    return made


class Rosout(logging.Handler):
    """Hands records to `write`, as fields of a Log."""

    def __init__(self, write: Callable[[object], object]) -> None:
        super().__init__()
        self._write = write

    def emit(self, record: logging.LogRecord) -> None:
        try:
            self._write(_fields(record))
        except Exception:
            self.handleError(record)  # to stderr, as all handlers of Python do


def _fields(record: logging.LogRecord) -> dict[str, Any]:
    seconds, rest = divmod(record.created, 1)
    text = record.getMessage()
    if record.exc_info and record.exc_info[1] is not None:
        text += f": {record.exc_info[1]!r}"
    return {
        "stamp": {"sec": int(seconds), "nanosec": int(rest * 1e9)},
        "level": min(50, max(10, record.levelno)),
        "name": record.name,
        "msg": text,
        "file": record.pathname,
        "function": record.funcName or "",
        "line": record.lineno,
    }
