"""Linger: what is still open when the program ends is closed.

Rules: a program ends normally, by an exception, by sys.exit, or by SIGTERM or SIGHUP; then all that
is open has `seconds()` together to send what was written and to give names back; and NAMES beyond
that for names alone, where a busy computer has used up the rest. After os._exit, and after SIGKILL,
nobody can do anything. The two signals are heard only where nobody else hears them and the system
would end the process: a handler of ours is set when the first thing opens in the main thread, or
for an event loop that runs there, and taken back when the last one closes there. It closes what is
open, in a thread of its own, since the frame beneath may hold any lock; then the signal ends the
process as it would have without us. The main thread hears of a signal; code outside Python that
does not return keeps it waiting. On Windows the end of the console, and Ctrl-Break, are told by it
instead: see `platform/console.py`.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import Final

from yarpy import fork
from yarpy.errors import PortClosed
from yarpy.log import logger
from yarpy.platform import console

SETTING: Final = "YARPY_LINGER"
LINGER: Final = 1.0  # seconds
NAMES: Final = 0.5  # seconds beyond that, for what `left_for_names`
MORE: Final = 0.5  # seconds beyond both for the thread that closes after a signal
OWN: Final = 2.5  # seconds for a handler of the program's own where a console ends: of the five
LOOK: Final = 0.02  # seconds until it is looked whether it has closed all

Close = Callable[[float], object]  # gets the seconds that it may take

log = logger("yarpy.linger")

_open: dict[object, Close] = {}
_last: list[Callable[[], object]] = []
_until = 0.0  # when all of it is over, by time.monotonic; 0.0 before the program ends
_suspended = 0  # the thread that waits in a signal handler until all of it is done
_begun: set[int] = set()  # the process in which the interpreter calls us at its end
_signals: Final = tuple(
    getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)
)


def seconds() -> float:
    """Return the seconds that closing may take where the program does not say: 1, or YARPY_LINGER
    of its environment."""
    text = os.environ.get(SETTING, "")
    if not text:
        return LINGER
    with contextlib.suppress(ValueError):
        found = float(text)
        if 0.0 <= found < 1e6:
            return found
    log.warning("%s=%.40r is no number of seconds and is ignored", SETTING, text)
    return LINGER


def add(thing: object, close: Close) -> None:
    """Call `close` when the program ends, unless `thing` is taken away before."""
    process = os.getpid()
    if process not in _begun:
        _begin(process)
    _open[thing] = close
    hear()


def remove(thing: object) -> None:
    """Forget a thing that was closed."""
    _open.pop(thing, None)
    hear_no_more()


def at_last(action: Callable[[], object]) -> None:
    """Call `action` when the program ends and everything else is closed, also what other rooms
    close by `atexit`; where several say so, the last one first."""
    process = os.getpid()
    if process not in _begun:
        _begin(process)
    _last.append(action)


def end() -> None:
    """Close all that is open, the last first, in `seconds()` seconds."""
    global _until
    threading.excepthook = _daemons_end_quietly(threading.excepthook)
    left = seconds()
    limit = time.monotonic() + left
    _until = limit + NAMES
    while _open:
        thing, close = _open.popitem()
        left = max(0.0, limit - time.monotonic())
        try:
            close(left if not _open else left / 2)
        except Exception:
            log.exception("%s could not be closed at the end of the program", thing)


def _daemons_end_quietly(
    told: Callable[[threading.ExceptHookArgs], object],
) -> Callable[[threading.ExceptHookArgs], object]:
    """Return a hook for exceptions of threads that passes over a closed port in a daemon thread:
    the end of the program has closed it, and Python, too, cuts such threads without a word. One
    that prints at that moment may bring the interpreter down."""

    def hook(raised: threading.ExceptHookArgs) -> None:
        daemon = raised.thread is not None and raised.thread.daemon
        if not (daemon and issubclass(raised.exc_type, PortClosed)):
            told(raised)

    return hook


def left_for_names() -> float:
    """Return the seconds that whoever is closed by `end` has to give a name back, also when those
    that it was told are over."""
    return max(0.0, _until - time.monotonic())


def left() -> float:
    """Return the seconds that something may take which is closed now: `seconds()`, and where the
    program ends what is left of them, with those for names."""
    return left_for_names() if _until else seconds()


def suspends(thread: int) -> bool:
    """Return whether what `thread` was doing, such as closing something, goes on no more, since it
    is in our signal handler until `end` has done that."""
    return thread == _suspended != 0


@atexit.register  # before anything that imports this can register, so it is called behind that
def _end_rest() -> None:
    while _last:
        action = _last.pop()
        try:
            action()
        except Exception:
            log.exception("%s failed at the end of the program", action)


def _end_all() -> None:
    end()
    _end_rest()


def _begin(process: int) -> None:
    if not _begun:
        atexit.register(end)
        fork.after_in_child(_open.clear)
        console.at_end(_end_by_console)
    _begun.add(process)
    multiprocessing = sys.modules.get("multiprocessing.process")
    if multiprocessing is not None and multiprocessing.parent_process() is not None:
        from multiprocessing.util import Finalize  # such a child ends without `atexit`

        Finalize(None, end, exitpriority=0)
        Finalize(None, _end_rest, exitpriority=-1)


# -- signals --------------------------------------------------------------------------------------


def hear() -> None:
    """Hear the signals, if this is the main thread: what is to be closed then opens in another."""
    if threading.current_thread() is not threading.main_thread():
        return
    for number in _signals:
        if signal.getsignal(number) is signal.SIG_DFL:
            with contextlib.suppress(ValueError):  # of a second interpreter in this process
                signal.signal(number, _end_by)


def hear_no_more() -> None:
    """Hear the signals no more, if this is the main thread and all is closed."""
    if _open or threading.current_thread() is not threading.main_thread():
        return
    for number in _signals:
        if signal.getsignal(number) is _end_by:
            signal.signal(number, signal.SIG_DFL)


def _end_by_console(surely: bool) -> None:
    """Close what is open. A handler of the program's own does that by itself, but for what it has
    not done where the process ends `surely`."""
    number = getattr(signal, "SIGBREAK", signal.SIGTERM)
    if signal.getsignal(number) is not signal.SIG_DFL:
        if not surely:
            return
        signal.raise_signal(number)  # the system would, and end the process at once
        until = time.monotonic() + OWN
        while (_open or _last) and time.monotonic() < until:
            time.sleep(LOOK)
    _end_all()


def _end_by(number: int, frame: FrameType | None) -> None:
    global _suspended
    for each in _signals:
        if signal.getsignal(each) is _end_by:
            signal.signal(each, signal.SIG_DFL)  # a second one does not wait
    if _open or _last:
        _suspended = threading.get_ident()
        thread = threading.Thread(target=_end_all, name="yarpy linger", daemon=True)
        with contextlib.suppress(RuntimeError):  # there can be no more threads
            thread.start()
            thread.join(seconds() + NAMES + MORE)
    os.kill(os.getpid(), number)
