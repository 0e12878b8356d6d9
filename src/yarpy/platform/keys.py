"""Keys that are pressed on the terminal of this program, one by one.

    Linux, macOS    the terminal gives letters at once, and shows none
    Windows         the console is looked at 50 times a second; arrows come as terminals send them

Rules: none come where standard input is no terminal. Afterwards the terminal is as before, and what
is typed is somebody else's.
"""

from __future__ import annotations

import os
import queue
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

#: of Windows, behind one of the beginnings, and what terminals send
ARROWS: Final = {"H": "\x1b[A", "P": "\x1b[B", "M": "\x1b[C", "K": "\x1b[D"}
_BEGINNINGS: Final = ("\x00", "\xe0")  # of keys that stand for no letter
_LOOK: Final = 0.02  # seconds

if sys.platform == "win32":

    @contextmanager
    def keys() -> Iterator[queue.Queue[str]]:
        """Give the keys that are pressed, letter by letter."""
        pressed: queue.Queue[str] = queue.Queue()
        if not sys.stdin.isatty():
            yield pressed
            return
        over = threading.Event()
        reader = threading.Thread(
            target=_read, args=(pressed, over), name="yarpy keys", daemon=True
        )
        reader.start()
        try:
            yield pressed
        finally:
            over.set()
            reader.join()

    def _read(pressed: queue.Queue[str], over: threading.Event) -> None:
        from msvcrt import getwch, kbhit

        while not over.wait(_LOOK):
            while kbhit() and not over.is_set():
                key = getwch()
                if key in _BEGINNINGS and kbhit():  # alone it is an à
                    key = ARROWS.get(getwch(), "")
                for letter in key:
                    pressed.put(letter)

else:

    @contextmanager
    def keys() -> Iterator[queue.Queue[str]]:
        """Give the keys that are pressed, letter by letter."""
        pressed: queue.Queue[str] = queue.Queue()
        try:
            import termios
            import tty
        except ImportError:  # a Python that was built without
            yield pressed
            return
        if not sys.stdin.isatty():
            yield pressed
            return
        descriptor = sys.stdin.fileno()
        before = termios.tcgetattr(descriptor)
        tty.setcbreak(descriptor)
        threading.Thread(
            target=_read, args=(descriptor, pressed), name="yarpy keys", daemon=True
        ).start()
        try:
            yield pressed
        finally:
            termios.tcsetattr(descriptor, termios.TCSADRAIN, before)

    def _read(descriptor: int, pressed: queue.Queue[str]) -> None:
        while True:
            try:
                data = os.read(descriptor, 64)
            except OSError:
                return
            if not data:
                return
            for letter in data.decode("utf-8", "ignore"):
                pressed.put(letter)
