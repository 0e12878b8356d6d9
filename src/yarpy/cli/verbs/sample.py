"""`yarpy sample --output PORT (--period S | --rate HZ) [--input SOURCE] [--carrier C] [--show]`.

Sends the newest message that arrived at PORT to its outputs, at a constant rate: what comes faster
is dropped, what comes slower is sent again. Messages of any type go through as they came.
Exit codes: 1 wrong options, or a port that cannot be had.
"""

from __future__ import annotations

import time

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.ports import hear_from, open_port
from yarpy.cli.relay import forwardable


@click.command()
@click.option("--output", required=True, metavar="PORT", help="The port to open.")
@click.option("--input", "source", metavar="SOURCE", help="Have the port SOURCE send to it.")
@click.option("--period", type=click.FloatRange(0.0001), metavar="S", help="Seconds between two.")
@click.option("--rate", type=click.FloatRange(0.0001), metavar="HZ", help="Messages per second.")
@click.option("--carrier", default="tcp", help="How SOURCE is connected.")
@click.option("--show", is_flag=True, help="Print what is sent.")
def command(
    output: str,
    source: str | None,
    period: float | None,
    rate: float | None,
    carrier: str,
    show: bool,
) -> None:
    """Send on what arrives at PORT at a constant rate."""

    if (period is None) == (rate is None):
        raise click.UsageError("give either --period or --rate")
    step = period or 1.0 / (rate or 1.0)
    newest = None
    with open_port(yarpy.BufferedPort, output) as port:
        if source is not None:
            hear_from(port, source, carrier)
        due = time.monotonic()
        while True:
            newest = port.poll() or newest
            if newest is not None:
                port.write(forwardable(newest), newest.envelope or None)
                if show:
                    print_line(newest.as_(yarpy.Bottle).to_text())
            due = max(due + step, time.monotonic() - step)
            time.sleep(max(0.0, due - time.monotonic()))
