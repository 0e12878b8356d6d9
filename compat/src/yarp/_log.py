"""Log: lines for people, with their level in front, on standard output or, from warnings on, error.

Rules: control characters that a terminal would obey are escaped.
"""

from __future__ import annotations

import os
import sys
import threading
import traceback
from collections.abc import Callable, Iterable
from typing import Any, Final

from yarpy.log import readable
from yarpy.platform.console import is_unread

_NUMBERS: Final = {
    "TRACE": 5, "DEBUG": 10, "INFO": 20, "WARNING": 30, "ERROR": 40, "FATAL": 50
}  # fmt: skip


class _Taste:
    """The settings of this program for its log."""

    least_printed = 1  # the numbers of Log
    least_forwarded = 1
    printer: Any = None
    forwarder: Any = None
    lock = threading.RLock()


_ORDER: Final = [*_NUMBERS]


def say(level: str, text: str) -> None:
    """Print a line of that level."""
    number = _ORDER.index(level) + 1
    if number >= _Taste.least_printed:
        (_Taste.printer or _print)(level, text)
    if number >= _Taste.least_forwarded:
        if _Taste.forwarder is not None:
            _Taste.forwarder(level, text)
        elif os.environ.get("YARP_FORWARD_LOG_ENABLE"):
            _forward(level, text)


def _print(level: str, text: str) -> None:
    stream = sys.stderr if level in ("WARNING", "ERROR", "FATAL") else sys.stdout
    stream.write(f"[{level}] {readable(text)}\n")
    stream.flush()


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
    except OSError as error:
        if not is_unread(error):
            raise
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
    LogTypeReserved = 7

    def __init__(self, file: str = "", line: int = 0, func: str = "") -> None:
        """The place in the program is not printed."""

    @staticmethod
    def setMinimumPrintLevel(level: int) -> None:
        """Print what is of this level, or worse: `Log.WarningType`."""
        _Taste.least_printed = level

    @staticmethod
    def minimumPrintLevel() -> int:
        return _Taste.least_printed

    @staticmethod
    def defaultMinimumPrintLevel() -> int:
        return Log.TraceType

    @staticmethod
    def setMinimumForwardLevel(level: int) -> None:
        """Forward what is of this level, or worse."""
        _Taste.least_forwarded = level

    @staticmethod
    def minimumForwardLevel() -> int:
        return _Taste.least_forwarded

    @staticmethod
    def defaultMinimumForwardLevel() -> int:
        return Log.TraceType

    @staticmethod
    def setPrintCallback(cb: Callable[[str, str], object] | None) -> None:
        """Call `cb(level, text)` instead of printing; None prints again."""
        _Taste.printer = cb

    @staticmethod
    def printCallback() -> Callable[[str, str], object]:
        """Return what prints."""
        found: Callable[[str, str], object] = _Taste.printer or _print
        return found

    @staticmethod
    def defaultPrintCallback() -> Callable[[str, str], object]:
        return _print

    @staticmethod
    def setForwardCallback(cb: Callable[[str, str], object] | None) -> None:
        """Call `cb(level, text)` instead of forwarding; None forwards again."""
        _Taste.forwarder = cb

    @staticmethod
    def forwardCallback() -> Callable[[str, str], object]:
        """Return what forwards."""
        found: Callable[[str, str], object] = _Taste.forwarder or _forward
        return found

    @staticmethod
    def defaultForwardCallback() -> Callable[[str, str], object]:
        return _forward

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
    def getLogMutex() -> Any:
        """Return a lock that threads may share which print several lines; each is whole without."""
        return _Taste.lock

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


def yarp_print_trace(out: Any = None, file: str = "", line: int = 0) -> None:
    """Print where the program is: on standard error, or to a file that is open."""
    stream = sys.stderr if out is None else out
    stream.write(f"backtrace {file}:{line}\n" if file else "backtrace\n")
    traceback.print_stack(file=stream)
