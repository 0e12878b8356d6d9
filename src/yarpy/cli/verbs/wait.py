"""`yarpy wait PORT | SOURCE TARGET`: wait for a port, or for a connection.

A name server that is not there yet is waited for as well.

Differs from C++: 0 on success; `--timeout`. Exit codes: 0 it is there; 1 the time was over.
"""

from __future__ import annotations

import time

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain, warn

REMIND = 3.0  # seconds between reminders that it still waits


@click.command()
@click.argument("port")
@click.argument("target", required=False)
@click.option("--timeout", type=float, metavar="S", help="Give up after S seconds.")
def command(port: str, target: str | None, timeout: float | None) -> int:
    """Wait until PORT is alive, or until PORT sends to TARGET."""

    deadline = None if timeout is None else time.monotonic() + timeout
    reminder = time.monotonic()
    while True:
        if time.monotonic() >= reminder:  # a wait may end a little early
            print_line(f"Waiting for {port}->{target}..." if target else f"Waiting for {port}...")
            reminder = time.monotonic() + REMIND
        until = reminder if deadline is None else min(reminder, deadline)
        left = max(0.0, until - time.monotonic())
        try:
            if yarpy.wait_for(port, target, left):
                return 0
        except yarpy.NoNameServer as error:
            warn(f"{error}; waiting for one")
            time.sleep(left)
        if deadline is not None and time.monotonic() >= deadline:
            missing = _missing(port, target)
            if missing:
                complain(f"the {timeout:g} s are over: {missing}")
            return 1 if missing else 0


def _missing(port: str, target: str | None) -> str:
    """Return what is still missing when the time is over, "" if it came in the last moment."""
    try:
        yarpy.ping(port, timeout=1.0)
    except yarpy.YarpError as error:
        return str(error)
    return f'"{port}" is there, but does not send to "{target}"' if target else ""
