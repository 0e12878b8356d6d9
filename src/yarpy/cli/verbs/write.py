"""`yarpy write PORT [REMOTE...] [verbatim]`: send the lines of standard input from a port.

Each line is Bottle text; an empty one is an empty message. `verbatim` sends lines as they are, as
the two elements 0 and the text, and 1 and `<EOF>` at the end: what `yarpy read` prints bare.

Differs from C++: the last line counts also without a line end; what is typed is remembered.
At the end of input it waits for its readers, as long as they take something.

Exit codes: 0 at the end of input; 1 the port or a connection cannot be made, or a reader takes
nothing any more, or after ^C.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable
from typing import Any, Final

import click

import yarpy
from yarpy.cli import prompt, typed
from yarpy.cli.ports import open_port, send_to
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain

EOF = (1, "<EOF>")
STANDSTILL: Final = 10.0  # seconds in which no reader took anything: one of them is stopped


def value_of(line: str, verbatim: bool) -> Any:
    """Return the value that a line is sent as. Raises DecodeError for hundreds of brackets."""

    return yarpy.Bottle([0, line]) if verbatim else typed.bottle(line)


def feed(
    port: yarpy.Port, lines: Iterable[str], verbatim: bool = False, period: float = 0.0
) -> bool:
    """Send `lines`; with `period`, the last one again and again, that many seconds apart. Return
    whether all was taken."""

    repeater = _Repeater(port, period)
    if period:
        repeater.start()
    for line in lines:
        try:
            repeater.value = value_of(line, verbatim)
        except yarpy.DecodeError as error:
            complain(str(error))
            continue
        port.write(repeater.value)
    repeater.stopped.set()
    if verbatim:
        port.write(EOF)
    return taken(port)


def taken(port: yarpy.Port, standstill: float = STANDSTILL) -> bool:
    """Wait until the readers have taken all, as long as they take something; return whether they
    have. One that was stopped would be waited for without end."""
    before: object = None
    begun = time.monotonic()
    while not port.flush(standstill):
        if time.monotonic() < begun + standstill:
            return True  # a connection broke, which is logged
        outputs = port.stats.outputs
        now = [(one.target, one.messages, one.unacknowledged) for one in outputs]
        if now == before:
            names = ", ".join(one.target for one in outputs)
            complain(f"not waiting any longer: nothing was taken for {standstill:g} s by {names}")
            return False
        before, begun = now, time.monotonic()
    return True


class _Repeater(threading.Thread):
    """Sends `value` every `period` seconds, from when there is one."""

    def __init__(self, port: yarpy.Port, period: float) -> None:
        super().__init__(name="yarpy repeat", daemon=True)
        self.value: Any = None
        self.stopped = threading.Event()
        self._port = port
        self._period = period

    def run(self) -> None:

        while not self.stopped.wait(self._period):
            if self.value is not None:
                try:
                    self._port.write(self.value)
                except yarpy.PortClosed:
                    return


@click.command()
@click.argument("port")
@click.argument("words", nargs=-1, metavar="[REMOTE]... [verbatim]")
@click.option("--verbatim", is_flag=True, help="Send lines as they are, not as Bottle text.")
@click.option(
    "--period", type=click.FloatRange(min=0.0, min_open=True), metavar="S",
    help="Send the last line again every S seconds.",
)  # fmt: skip
@click.option("--wait-connect", is_flag=True, help="Wait for a connection before the first line.")
@click.option(
    "--type", "port_type", default="", show_default=False,
    help="The type that the port says it sends.",
)  # fmt: skip
def command(
    port: str,
    words: tuple[str, ...],
    verbatim: bool,
    period: float | None,
    wait_connect: bool,
    port_type: str,
) -> int:
    """Open PORT and send it the lines of standard input, to each REMOTE and whoever connects."""

    verbatim = verbatim or "verbatim" in words
    try:
        with open_port(yarpy.Port, port, "+", port_type=port_type, callback=_ignore) as writer:
            for remote in words:
                if remote != "verbatim":
                    send_to(writer, remote)
            if period:
                click.echo(f"Message will be published with a period of {period:f} s", err=True)
            if wait_connect:
                writer.wait_for_outputs()
            try:
                lines = prompt.lines(history=f"write_{port}")
                all_taken = feed(writer, lines, verbatim, period or 0.0)
            except Interrupted:
                click.echo("Interrupting...", err=True)
                raise
    except Interrupted:
        return 1
    return 0 if all_taken else 1


def _ignore(message: object) -> None:
    """Drop what arrives at a port that only writes."""
