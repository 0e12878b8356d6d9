"""The terminal of a program that was started with --stdio: what `yarprun --readwrite` is.

    terminal.attach("/nodeA/4711/sh-1")

Rules: the ports are `UUID/stdio:i` and `UUID/stdio:o`, connected to those of the program. A signal
and the end of the program end it; the end of input does not, for the program answers yet.
"""

from __future__ import annotations

import sys
import threading
from contextlib import suppress

import yarpy
from yarpy.data.text import plain_text
from yarpy.errors import YarpError
from yarpy.log import readable


def attach(uuid: str) -> int:
    """Print what the program says and send it what is typed; return 0. Raises YarpError when there
    is no such program."""
    with (
        yarpy.BufferedPort(f"{uuid}/stdio:i", strict=True) as heard,
        yarpy.Port(f"{uuid}/stdio:o") as typed,
    ):
        yarpy.connect(f"{uuid}/stdout", heard.name)
        yarpy.connect(typed.name, f"{uuid}/stdin")
        threading.Thread(target=_type, args=(typed,), name="terminal", daemon=True).start()
        heard.on_connection(lambda event: None if event.created else heard.interrupt())
        with suppress(YarpError):
            for message in heard:
                value = message.value
                single = isinstance(value, list) and len(value) == 1
                text = plain_text(value[0]) if single else f"{plain_text(value)}\n"
                _print(text)
    return 0


def _print(text: str) -> None:
    out = sys.stdout
    if out is not None:
        out.write(readable(text, keep="\n\t\r") if out.isatty() else text)
        out.flush()


def _type(port: yarpy.Port) -> None:
    if sys.stdin is None:
        return
    for line in sys.stdin:
        try:
            port.write(yarpy.Bottle([line]))
        except YarpError:
            return
