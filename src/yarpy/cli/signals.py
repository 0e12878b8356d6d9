"""The end of a command when somebody asks for it: by ^C, by SIGTERM, by the end of its terminal.

Rules: the first signal is the exception `Interrupted` in the main thread, so `with` blocks close
their ports and names are given back; what comes within two seconds is the same person pressing
twice, and what comes later ends the process at once. A hangup that `nohup` has us ignore stays
ignored; SIGINT is obeyed also where a shell ignores it for its background jobs, as C++ does.
The system may give a signal to any thread, and does where one is just ending; Python runs handlers
in the main thread alone, which sleeps on: so a thread of ours hears of each signal and wakes it.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Final

CLOSING: Final = 2.0  # seconds that closing may take before another signal means: at once
AGAIN: Final = 0.01  # seconds until a signal that was dropped is raised again
_NAMES: Final = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")


class Interrupted(BaseException):
    """A signal asks the command to end; `number` says which. Not an Exception: nobody eats it."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def watch() -> None:
    """Turn signals into `Interrupted` from now on. To be called in the main thread."""
    handler = _Handler()
    for name in _NAMES:
        number = getattr(signal, name, None)
        if number is None or (name == "SIGHUP" and signal.getsignal(number) is signal.SIG_IGN):
            continue
        signal.signal(number, handler)
    sys.unraisablehook = handler.retry
    if sys.platform != "win32":
        reading, writing = os.pipe()
        os.set_blocking(writing, False)
        signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
        handler.writing = writing
        threading.Thread(
            target=handler.relay, args=(reading,), name="yarpy signals", daemon=True
        ).start()


@contextmanager
def held() -> Iterator[None]:
    """Let a signal wait until the block is done: for what must not be left half open."""
    handler = signal.getsignal(signal.SIGTERM)
    if not isinstance(handler, _Handler):
        yield
        return
    handler.holding = True
    try:
        yield
    finally:
        handler.holding = False
        if handler.waiting is not None:  # also where the block fails, after which one may go on
            raise Interrupted(handler.waiting)


class _Handler:
    """The handler of a signal, which knows whether it is the first."""

    def __init__(self) -> None:
        self.holding = False
        self.waiting: int | None = None
        self.writing: int | None = None  # the pipe to the thread that hears of each signal
        self._dropped = False  # by Python, since that thread heard of a signal
        self._first: float | None = None
        self._calls = 0

    def __call__(self, number: int, frame: FrameType | None) -> None:
        self._calls += 1
        now = time.monotonic()
        if self._first is None:
            self._first = now
            if not self.holding:
                raise Interrupted(number)
            self.waiting = number
        elif now - self._first > CLOSING:
            os._exit(128 + number)

    def relay(self, reading: int) -> None:
        """Wake the main thread for each signal that another thread got."""
        while True:
            before = self._calls
            for number in os.read(reading, 64):
                time.sleep(AGAIN)
                dropped, self._dropped = self._dropped, False
                if (dropped or self._calls == before) and signal.getsignal(number) is self:
                    _wake_main_thread(number)

    def retry(self, lost: sys.UnraisableHookArgs) -> None:
        """Raise the signal again if Python dropped it: it had come while a finaliser or a callback
        of the interpreter ran, whose exceptions go nowhere. No thread may be started here: what a
        finaliser has interrupted may be the start of another one, which holds the lock for that."""
        if not isinstance(lost.exc_value, Interrupted):
            sys.__unraisablehook__(lost)
            return
        self._first = None
        # By another thread: here it would be dropped once more.
        if self.writing is not None:
            self._dropped = True
            with suppress(BlockingIOError):  # it has other news, and looks then
                os.write(self.writing, bytes([lost.exc_value.number]))
        else:
            threading.Timer(AGAIN, _wake_main_thread, (lost.exc_value.number,)).start()


def _wake_main_thread(number: int) -> None:
    """Send the signal to the thread that handles it, also where that one sleeps."""
    if hasattr(signal, "pthread_kill"):
        ident = threading.main_thread().ident
        assert ident is not None
        signal.pthread_kill(ident, number)
    else:
        signal.raise_signal(number)
