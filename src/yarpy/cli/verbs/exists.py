"""`yarpy exists PORT [TARGET]`: is this port alive, are these two connected?

Exit codes: 0 yes; 1 no. One name is answered in silence, as in C++.
"""

from __future__ import annotations

import click

import yarpy
from yarpy.cli.output import print_json


@click.command()
@click.argument("port")
@click.argument("target", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print the answer as a JSON object.")
def command(port: str, target: str | None, as_json: bool) -> int:
    """Tell by the exit code whether PORT is alive, or whether PORT sends to TARGET."""

    if target is None:
        found = yarpy.exists(port)
        if as_json:
            print_json({"port": port, "exists": found})
        return 0 if found else 1
    carrier = _carrier(port, target)
    if as_json:
        print_json({"source": port, "target": target, "exists": bool(carrier), "carrier": carrier})
    elif carrier:
        click.echo(f"Connection found between {port} and {target} using carrier {carrier}")
    else:
        click.echo(f"No connection from {port} to {target} found")
    return 0 if carrier else 1


def _carrier(port: str, target: str) -> str:
    """Return the carrier that connects the two, "" if they are not connected."""
    from yarpy.errors import LinkClosed, Timeout, UnknownName
    from yarpy.network.pairing import existing

    try:
        return existing(port, target)
    except (UnknownName, LinkClosed, Timeout):
        return ""
