"""Scripts: the files that a portmonitor runs - where they are, when they change, what they provide.

Rules: in any language, a script is an object with the methods of `Script`. It raises only
ScriptError, which names file and line.
"""

from __future__ import annotations

import errno
import os
import stat
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, Protocol

from yarpy.data.bottle import Property
from yarpy.errors import LocalProtocolError
from yarpy.limit import SCRIPT_FILE
from yarpy.monitors.base import Place
from yarpy.monitors.script.control import Control
from yarpy.monitors.script.permission import look_for
from yarpy.platform.refusal import reason
from yarpy.wire.message import Message

INTERVAL: Final = 0.5  # seconds between checks of a file
CALLBACK_TIMEOUT: Final = 3.0  # seconds that who closes or sets it up waits for a callback


class ScriptError(LocalProtocolError):
    """A script that cannot be loaded, or whose callback failed."""


class Script(Protocol):
    """A loaded script. A callback that it lacks does nothing."""

    def create(self, options: Property) -> bool:
        """The first call; False: the script refuses the connection."""

    def accept(self, message: Message) -> bool:
        """Return whether the message may pass."""

    def update(self, message: Message) -> object:
        """Return what replaces the message: a value, a Message, DROP; None: the message
        unchanged."""

    def update_reply(self, message: Message) -> object:
        """The same for the reply to a call."""

    def trigger(self) -> None:
        """Another connection of the port has let a message pass, or the timer is due."""

    def configure(self, parameters: Property) -> None:
        """New parameters."""

    def parameters(self) -> Property:
        """Their values now."""

    def close(self) -> None:
        """The last call."""


Load = Callable[[Path, bytes, Control], Script]


def find_script(place: Place, name: str, context: str, endings: Sequence[str]) -> Path:
    """The file of a script, found as configuration files are.

    LocalProtocolError says where it may be put, or that it must not run.
    """
    looked: list[Path] = []
    for ending in endings:
        for path in look_for(place, name + ending, context):
            if path.is_file():
                return path.absolute()
            looked.append(path)
    where = list(dict.fromkeys(str(path.absolute().parent) for path in looked))
    kinds = " or ".join(f'"{name}{ending}"' for ending in endings)
    raise LocalProtocolError(
        f"portmonitor finds no script {kinds}; it looked in {', '.join(where)}"
        + ("" if context else ', but in no context: give one with "+context.NAME"')
    )


def read_script(path: Path) -> bytes:
    """The text of a script. Raises LocalProtocolError, also for what is no file: opening a FIFO
    would wait for somebody to write it."""
    try:
        with open(path, "rb", opener=_opened) as file:
            found = file.read(SCRIPT_FILE + 1)
    except OSError as error:
        raise LocalProtocolError(f'"{path}" cannot be read: {reason(error)}') from error
    if len(found) > SCRIPT_FILE:
        raise LocalProtocolError(f'"{path}" is too large for a script: over {SCRIPT_FILE} bytes')
    return found


def _opened(path: str, flags: int) -> int:
    # Without O_NONBLOCK, opening a FIFO waits for its writer. Windows has neither.
    file = os.open(path, flags | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0))
    if not stat.S_ISREG(os.fstat(file).st_mode):
        os.close(file)
        raise OSError(errno.EINVAL, "it is no regular file")
    return file


class Watch:
    """A check whether a file has changed since the last call; it limits how often the disk is
    read."""

    def __init__(self, path: Path, clock: Callable[[], float] = time.monotonic) -> None:
        self._path = path
        self._clock = clock
        self._state = self._look()
        self._again = clock() + INTERVAL

    def changed(self) -> bool:
        """Return whether the file has changed. A file that is missing counts as unchanged."""
        now = self._clock()
        if now < self._again:
            return False
        self._again = now + INTERVAL
        state = self._look()
        if state is None or state == self._state:
            return False
        self._state = state
        return True

    def _look(self) -> tuple[int, int, int] | None:
        try:
            found = os.stat(self._path)
        except OSError:
            return None
        return found.st_mtime_ns, found.st_size, found.st_ino
