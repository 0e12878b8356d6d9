"""The log of a node: what it says comes to /rosout, where `rqt_console` and others read it.

    NODE/get_loggers, NODE/set_logger_level      what rqt_logger_level asks

Rules: a logger of Python, of levels DEBUG to CRITICAL (FATAL in ROS), which shows INFO and more.
Its records go to the program's own handlers, too. Topic and services are there from the first use
of the logger on: a node that logs nothing needs none of them. The logger is called `rosout`, as
that of programs with rospy.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final, Protocol

from yarpy.errors import PortClosed
from yarpy.log import logger

log = logger("yarpy.ros")

TOPIC: Final = "/rosout"
TYPE: Final = "rosgraph_msgs/Log"
KEPT: Final = 100  # messages that wait for a subscriber, as with rospy
NAME: Final = "rosout"

#: as ROS spells them: the number of Python, and that of a Log
LEVELS: Final = {
    "debug": (logging.DEBUG, 1),
    "info": (logging.INFO, 2),
    "warn": (logging.WARNING, 4),
    "error": (logging.ERROR, 8),
    "fatal": (logging.CRITICAL, 16),
}


class Speaker(Protocol):
    """The part of a node that its log needs."""

    name: str

    def publisher(self, topic: str, type_: Any, *, latch: bool, queue_size: int) -> Any: ...

    def service(self, service: str, type_: Any, handler: Callable[[Any], object]) -> Any: ...


class Rosout(logging.Handler):
    """Publishes the records of `of(node)`."""

    def __init__(self) -> None:
        super().__init__()
        self.said = logging.Logger(NAME, logging.INFO)
        self.said.parent = log  # not one by this name for all of the program: each node has its own
        self._node = ""
        self._publisher: Any = None

    def of(self, node: Speaker) -> logging.Logger:
        """The logger; from now on it is heard."""
        self.acquire()
        try:
            if self._publisher is None:
                self._node = node.name
                self._publisher = node.publisher(TOPIC, TYPE, latch=True, queue_size=KEPT)
                node.service("~get_loggers", "roscpp/GetLoggers", self._loggers)
                node.service("~set_logger_level", "roscpp/SetLoggerLevel", self._set_level)
                self.said.addHandler(self)
        finally:
            self.release()
        return self.said

    def emit(self, record: logging.LogRecord) -> None:
        try:
            with suppress(PortClosed):  # the node was closed; the program's own handlers remain
                self._publisher.write(self._fields(record))
        except Exception:
            self.handleError(record)  # to stderr, as all handlers of Python do

    def _fields(self, record: logging.LogRecord) -> dict[str, Any]:
        text = record.getMessage()
        if record.exc_info and record.exc_info[1] is not None:
            text += f": {record.exc_info[1]!r}"
        return {
            "level": _level_of(record.levelno)[1][1],
            "name": self._node,
            "msg": text,
            "file": record.pathname,
            "function": record.funcName or "",
            "line": record.lineno,
        }

    def _loggers(self, _: object) -> object:
        return [[{"name": NAME, "level": _level_of(self.said.level)[0]}]]

    def _set_level(self, asked: Any) -> None:
        found = LEVELS.get(asked.level.lower())
        if asked.logger != NAME:
            raise LookupError(f'no logger "{asked.logger[:80]}" here: there is {NAME}')
        if found is None:
            raise LookupError(f'"{asked.level[:80]}" is no level: take {", ".join(LEVELS)}')
        self.said.setLevel(found[0])


def _level_of(number: int) -> tuple[str, tuple[int, int]]:
    """The level of ROS for one of Python: the highest that is not above it."""
    found = [each for each in LEVELS.items() if each[1][0] <= number]
    return found[-1] if found else next(iter(LEVELS.items()))
