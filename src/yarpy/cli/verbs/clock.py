"""`yarpy clock [--name /clock] [--period MS] [--rtf N] [--system-time]`: send the time.

    yarpy clock --rtf 0.5                     half as fast as the computer's, from 0 on
    YARP_CLOCK=/clock python controller.py    lives by it, as C++ programs do

The port is /clock, or what YARP_CLOCK names. It sends seconds and nanoseconds, two integers.
"""

from __future__ import annotations

import os
import time
from typing import Final

import click

from yarpy.cli.output import print_line
from yarpy.clock import NAME, SETTING, spelled
from yarpy.port.port import Port

LARGEST: Final = 1000.0  # times as fast as the computer's clock


@click.command()
@click.option("--name", metavar="PORT", help="The port that sends it (/clock).")
@click.option("--period", type=click.FloatRange(0.1, 60_000), default=30.0, metavar="MS",
              help="Milliseconds from one message to the next.")  # fmt: skip
@click.option("--rtf", type=click.FloatRange(0, LARGEST, min_open=True), default=1.0, metavar="N",
              help="How many seconds pass in a second.")  # fmt: skip
@click.option("--system-time", "--systemTime", "since_1970", is_flag=True,
              help="Begin at the time of this computer, not at 0.")  # fmt: skip
def command(name: str | None, period: float, rtf: float, since_1970: bool) -> None:
    """Send the time to programs that have YARP_CLOCK, until interrupted."""
    with Port(name or os.environ.get(SETTING) or NAME, callback=_ignore) as port:
        print_line(f"{port.name} sends the time: YARP_CLOCK={port.name} makes programs live by it")
        began, first = time.monotonic(), time.time() if since_1970 else 0.0
        due = began
        while True:
            port.write(spelled(first + (time.monotonic() - began) * rtf))
            due = max(due + period / 1000, time.monotonic())  # what was missed is not sent later
            time.sleep(max(0.0, due - time.monotonic()))


def _ignore(message: object) -> None:
    """Nobody who writes to it by mistake waits."""
