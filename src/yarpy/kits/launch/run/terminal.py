"""The terminal of a program that was started with --stdio: what `yarprun --readwrite` is.

    terminal.attach("/nodeA/4711/sh-1")

Rules: the ports are `UUID/stdio:i` and `UUID/stdio:o`, connected to those of the program. A signal
and the end of the program end it; the end of input does not, for the program answers yet.
"""

from __future__ import annotations

import queue
import sys
import threading
from contextlib import suppress
from typing import Final

import yarpy
from yarpy.data.text import plain_text
from yarpy.errors import YarpError
from yarpy.log import readable

_AHEAD: Final = 10_000  # lines that the program may be ahead of what is shown


def attach(uuid: str) -> int:
    """Print what the program says and send it what is typed; return 0. Raises YarpError when there
    is no such program."""
    # What it said and the end of it in one line: the end may come at any time, also at once.
    said: queue.Queue[str | None] = queue.Queue(_AHEAD)
    over = threading.Event()

    def hear(message: yarpy.Message) -> None:
        if over.is_set():
            return
        with suppress(YarpError):
            value = message.value
            single = isinstance(value, list) and len(value) == 1
            said.put(plain_text(value[0]) if single else f"{plain_text(value)}\n")

    def see(event: yarpy.ConnectionEvent) -> None:
        if event.incoming and not event.created and not over.is_set():
            said.put(None)

    with (
        yarpy.BufferedPort(f"{uuid}/stdio:i", callback=hear, on_connection=see) as heard,
        yarpy.Port(f"{uuid}/stdio:o") as typed,
    ):
        yarpy.connect(typed.name, f"{uuid}/stdin")
        yarpy.connect(f"{uuid}/stdout", heard.name)  # for which one that has ended has waited
        threading.Thread(target=_type, args=(typed,), name="terminal", daemon=True).start()
        try:
            while (text := said.get()) is not None:
                _print(text)
        finally:
            over.set()
            while not said.empty():  # somebody may wait for room
                said.get()
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
