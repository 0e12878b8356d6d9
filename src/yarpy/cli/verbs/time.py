"""`yarpy time [--ros]`: print the time of this computer ten times a second, until interrupted."""

from __future__ import annotations

import time

import click

from yarpy.cli.output import print_line

PERIOD = 0.1  # seconds


@click.command()
@click.option("--ros", is_flag=True, help="Print seconds and nanoseconds.")
def command(ros: bool) -> None:
    """Print the time, again and again."""
    due = time.monotonic()
    while True:
        print_line(spelled(time.time_ns(), ros))
        due += PERIOD
        time.sleep(max(0.0, due - time.monotonic()))


def spelled(nanoseconds: int, ros: bool) -> str:
    """A time since 1970: `1795224973.141008`, or as ROS counts it, `1795224973 141008000`."""
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return f"{seconds} {rest}" if ros else f"{seconds}.{rest // 1000:06d}"
