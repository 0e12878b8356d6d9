"""The program `yarpy` from its first line on: what a signal does before anything else is loaded.

Rules: nothing of ours is open yet, so ^C, SIGTERM and a hangup end the program at once and in
silence, with the exit code that a shell gives for them; `signals.watch` takes over from here. This
file imports nothing that takes time.
"""

import os
import signal
import sys
from types import FrameType
from typing import NoReturn


def main() -> NoReturn:
    """The program `yarpy`."""
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _end)
    from yarpy.cli import signals

    try:
        from yarpy.cli.main import main as run

        run()
    except signals.Interrupted as asked:  # before the command began, or behind its end
        sys.exit(128 + asked.number)


def _end(number: int, frame: FrameType | None) -> None:
    os._exit(128 + number)
