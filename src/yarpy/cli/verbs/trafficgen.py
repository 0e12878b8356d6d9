"""`yarpy trafficgen PORT [--bandwidth MBIT | --period S --size MB] [--duration S]`.

Sends strings of zeros from PORT: of 1 MB as often as the bandwidth takes (8 Mb/s), or of a given
size at a given period. Exit codes: 0 the time is over; 1 wrong options.
"""

from __future__ import annotations

import time

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.ports import open_port

_POSITIVE = click.FloatRange(min=0.0, min_open=True)


def plan(
    bandwidth: float | None, period: float | None, size: float | None
) -> tuple[float, float, float]:
    """Bandwidth (Mb/s), period (s) and size (MB) out of what was given. Raises UsageError."""
    if bandwidth is not None and period is not None and size is not None:
        raise click.UsageError("two of --bandwidth, --period and --size say the third")
    if period is not None and bandwidth is not None:
        return bandwidth, period, bandwidth * period / 8
    size = 1.0 if size is None else size
    if period is not None:
        return size * 8 / period, period, size
    bandwidth = 8.0 if bandwidth is None else bandwidth
    return bandwidth, size * 8 / bandwidth, size


@click.command()
@click.argument("port")
@click.option("--bandwidth", type=_POSITIVE, metavar="MBIT", help="Megabits per second.")
@click.option("--period", type=_POSITIVE, metavar="S", help="Seconds between messages.")
@click.option("--size", type=_POSITIVE, metavar="MB", help="Megabytes of one message.")
@click.option("--duration", type=_POSITIVE, metavar="S", help="Seconds until it ends.")
def command(
    port: str,
    bandwidth: float | None,
    period: float | None,
    size: float | None,
    duration: float | None,
) -> int:
    """Send messages of a given size at a given rate from PORT."""

    bandwidth, period, size = plan(bandwidth, period, size)
    shown = f"{duration:.3f}(s)" if duration else "unlimited"
    print_line(
        f"Starting trafficgen with the following options: period:{period:.3f}(s), "
        f"size:{size:.3f}(MB), duration:{shown}, bandwidth:{bandwidth:.3f}(Mb/s)"
    )
    payload = "0" * max(1, round(size * 1e6))
    with open_port(yarpy.Port, port, "+", callback=lambda message: None) as writer:
        due = time.monotonic()
        end = None if duration is None else due + duration
        while end is None or due < end:
            writer.write([payload])
            due = max(due + period, time.monotonic() - period)
            time.sleep(max(0.0, (due if end is None else min(due, end)) - time.monotonic()))
        writer.flush()
    return 0
