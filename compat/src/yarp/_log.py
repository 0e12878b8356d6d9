"""Log: lines for people, with their level in front, on standard output or, from warnings on, error.

Rules: control characters that a terminal would obey are escaped.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from typing import Final

from yarpy.log import readable

_NUMBERS: Final = {
    "TRACE": 5, "DEBUG": 10, "INFO": 20, "WARNING": 30, "ERROR": 40, "FATAL": 50
}  # fmt: skip


def say(level: str, text: str) -> None:
    """Print a line of that level."""
    stream = sys.stderr if level in ("WARNING", "ERROR", "FATAL") else sys.stdout
    stream.write(f"[{level}] {readable(text)}\n")
    stream.flush()
    if os.environ.get("YARP_FORWARD_LOG_ENABLE"):
        _forward(level, text)


def _forward(level: str, text: str) -> None:
    """Make a record of it, which yarpy forwards; nobody else needs to see it again."""
    import logging

    log = logging.getLogger("yarp")
    if log.propagate:
        log.propagate = False
        log.setLevel(1)
        log.addHandler(logging.NullHandler())
    log.log(_NUMBERS[level], "%s", text)


def print_lines(lines: Iterable[str]) -> None:
    """Print what a command was asked for. Who reads only the beginning, as `head` does, may go."""
    try:
        print(*lines, sep="\n", flush=True)
    except BrokenPipeError:
        sys.stdout = None  # nothing more to flush at exit


class Log:
    """`Log().info("text")`, or `Log.info("text")`."""

    LogTypeUnknown = 0
    TraceType = 1
    DebugType = 2
    InfoType = 3
    WarningType = 4
    ErrorType = 5
    FatalType = 6

    def __init__(self, file: str = "", line: int = 0, func: str = "") -> None:
        """The place in the program is not printed."""

    @staticmethod
    def trace(msg: str = "") -> None:
        say("TRACE", msg)

    @staticmethod
    def debug(msg: str = "") -> None:
        say("DEBUG", msg)

    @staticmethod
    def info(msg: str = "") -> None:
        say("INFO", msg)

    @staticmethod
    def warning(msg: str = "") -> None:
        say("WARNING", msg)

    @staticmethod
    def error(msg: str = "") -> None:
        say("ERROR", msg)

    @staticmethod
    def fatal(msg: str = "") -> None:
        """Print, and end the program, as C++ does."""
        say("FATAL", msg)
        raise SystemExit(255)

    @staticmethod
    def nolog(msg: str = "") -> None:
        """Print nothing."""


def yTrace(msg: str) -> None:
    Log.trace(msg)


def yDebug(msg: str) -> None:
    Log.debug(msg)


def yInfo(msg: str) -> None:
    Log.info(msg)


def yWarning(msg: str) -> None:
    Log.warning(msg)


def yError(msg: str) -> None:
    Log.error(msg)
