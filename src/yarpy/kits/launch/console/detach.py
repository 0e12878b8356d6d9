"""An application in the background: `yarpy up` in a session of its own.

Rules: whoever starts it waits until it can be reached, or has ended; what it says goes to a file
beside its socket, which is told if it ends at once. The file is new each time.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from yarpy.errors import LocalProtocolError, Timeout
from yarpy.kits.launch.console import control

_POLL: Final = 0.02  # seconds
_TIMEOUT: Final = 120.0  # seconds until it can be reached
_SAID: Final = 2000  # letters of what it said that are told
#: on Windows: with a console of its own that has no window; in it programs can be asked to end
_ALONE: Final = getattr(subprocess, "CREATE_NO_WINDOW", 0)


def detach(name: str, words: Sequence[str], timeout: float = _TIMEOUT) -> Path:
    """Start `yarpy up` with these words, which runs the application `name`; return the file of
    what it says. Raises LocalProtocolError with what it said if it ends at once, Timeout."""
    if name in control.running():
        raise LocalProtocolError(
            f'"{name}" is running already: `yarpy status {name}` shows it, `yarpy down {name}` '
            "ends it"
        )
    path = control.place(name, "log")
    with open(path, "wb") as file:
        child = subprocess.Popen(
            [sys.executable, "-m", "yarpy", "up", *words],
            stdin=subprocess.DEVNULL,
            stdout=file,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            creationflags=_ALONE,
        )
    until = time.monotonic() + timeout
    while child.poll() is None:
        try:
            control.ask(name, do="status")
            return path
        except LocalProtocolError:
            if time.monotonic() > until:
                raise Timeout(
                    f'"{name}" cannot be reached after {timeout:g} s: see {path}'
                ) from None
            time.sleep(_POLL)
    said = path.read_text("utf-8", "replace").strip()[-_SAID:]
    if child.returncode == 0:
        return path  # all of it has ended well already
    raise LocalProtocolError(f'"{name}" has ended with {child.returncode}: {said}')
