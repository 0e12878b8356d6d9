"""Loggers whose records are safe to read in a terminal, and too few to fill a disk.

    log = logger("yarpy.port")

Rules: names, addresses and reasons come from strangers, and a terminal obeys the control characters
in what it shows. So what a terminal would obey, what ends a line, and what turns the direction of a
text around is escaped in every record, whatever handler takes it. Strangers can also have a line
logged as often as they like: of warnings that are alike, with the same words about the same port,
BURST a minute are shown, and the others are counted.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import logging

# Control characters (of ASCII and C1), marks of direction, ends of lines.
_HIDDEN: Final = re.compile(r"[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
_LONE: Final = re.compile(r"[\ud800-\udfff]")  # surrogates
BURST: Final = 20  # warnings that are alike in a minute
MINUTE: Final = 60.0  # seconds
_KINDS: Final = 1000  # of which this is known at a time
_WARNING: Final = 30  # of logging, which is imported late

_SHORT: Final = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}


def log_failure(log: logging.Logger, error: BaseException, text: str, *args: object) -> None:
    """Log that a function of the program has raised `error`, in the words of `text`: with its
    traceback, or, if it called sys.exit(), with what becomes of that. In the main thread that goes
    on."""
    if not isinstance(error, SystemExit):
        log.error(text, *args, exc_info=error)
        return
    import threading

    if threading.current_thread() is threading.main_thread():
        raise error
    log.error(
        f"{text}: sys.exit() in a thread of a port ends no program; let the main thread end it, "
        "which may wait for an Event that is set here",
        *args,
    )


def logger(name: str) -> logging.Logger:
    """The logger of that name. What it logs is `readable`, and limited."""
    import logging  # late: `readable` alone does not need it

    found = logging.getLogger(name)
    found.addFilter(_screen)  # once, however often
    if "callHandlers" not in vars(found):
        # On the logger itself: what `getLogger` makes for this name may be a program's own class.
        setattr(found, "callHandlers", partial(_call_handlers, found.callHandlers, found))  # noqa: B010
    return found


def _call_handlers(call: Callable[..., None], found: logging.Logger, record: object) -> None:
    """As `call`, the `callHandlers` of a logger; but where a signal handler raises, no handler of
    the log stays locked, as it may up to Python 3.12: every other thread that logs would wait for
    ever."""
    before = [handler for handler in _handlers(found) if _is_ours(handler)]
    try:
        call(record)
    except BaseException:
        for handler in _handlers(found):
            if handler not in before and _is_ours(handler):
                handler.release()
        raise


def _handlers(logger: logging.Logger | None) -> Iterator[logging.Handler]:
    """Yield the handlers that get the records of a logger."""
    while logger is not None:
        yield from logger.handlers
        logger = logger.parent if logger.propagate else None


def _is_ours(handler: logging.Handler) -> bool:
    """Return whether this thread has the lock of a handler."""
    owned = getattr(handler.lock, "_is_owned", None)
    return owned is not None and owned()


def readable(text: str, keep: str = "") -> str:
    """`text` with escapes in place of unseen characters that terminals and line readers obey.

    >>> readable("/cam" + chr(27) + "[2J" + chr(10))
    '/cam\\\\x1b[2J\\\\n'
    >>> readable("two" + chr(10) + "lines", keep=chr(10)) == "two" + chr(10) + "lines"
    True
    """
    return _HIDDEN.sub(lambda match: match[0] if match[0] in keep else _escaped(match[0]), text)


def _escaped(letter: str) -> str:
    code = ord(letter)
    return _SHORT.get(letter) or (f"\\x{code:02x}" if code < 256 else f"\\u{code:04x}")


def _screen(record: logging.LogRecord) -> bool:
    """Make a record readable and return whether it is shown."""
    try:
        more = _more(record) if record.levelno >= _WARNING else ""
        return more is not None and _make_readable(record, more)
    except MemoryError:
        record.msg, record.args = "something happened that there is no memory to tell", ()
        record.exc_info = record.exc_text = None
        return True


class _Kind:
    """Warnings that are alike: when the minute of the first began, and how many there were."""

    __slots__ = ("begin", "count")

    def __init__(self) -> None:
        self.begin = time.monotonic()
        self.count = 0


_kinds: dict[tuple[str, str, str], _Kind] = {}  # threads that meet here may count wrong by one


def _more(record: logging.LogRecord) -> str | None:
    """Return what to append to a warning about others like it; None: it is one too many."""
    args = record.args
    about = str(args[0]) if isinstance(args, tuple) and args else ""
    key = record.name, str(record.msg), about
    kind = _kinds.get(key)
    before = 0
    if kind is None or time.monotonic() - kind.begin >= MINUTE:
        before = max(kind.count - BURST, 0) if kind is not None else 0
        _kinds.pop(key, None)
        kind = _kinds[key] = _Kind()
        if len(_kinds) > _KINDS:
            _kinds.pop(next(iter(_kinds)), None)
    kind.count += 1
    if kind.count > BURST:
        return None
    if before:
        return f" (and {before} like it since)"
    return " (others like it are only counted for a minute)" if kind.count == BURST else ""


def _make_readable(record: logging.LogRecord, more: str) -> bool:
    if record.exc_info and isinstance(record.exc_info[1], MemoryError):
        # A traceback reads its sources, for which there is no room either.
        record.exc_info, record.exc_text = None, None
        more = f" (no memory is left){more}"
    try:
        text = record.getMessage()
    except MemoryError:
        raise
    except Exception:
        return True  # the handler reports what is wrong with it
    if more or _HIDDEN.search(text) is not None or _LONE.search(text) is not None:
        # A file of UTF-8 has no place for bytes of a stranger that are none.
        text = readable(text).encode("utf-8", "backslashreplace").decode()
        record.msg, record.args = text + more, ()
    return True
