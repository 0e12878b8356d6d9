"""`yarpy disconnect [--persist] SOURCE TARGET`: end a connection of two ports.

`--persist` forgets a persistent connection; what is connected now stays so.
Exit codes: 0 done; 1 they were not connected, or cannot be asked.
"""

from __future__ import annotations

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain


@click.command()
@click.argument("source")
@click.argument("target")
@click.option("--persist", is_flag=True, help="Forget the persistent connection.")
def command(source: str, target: str, persist: bool) -> int:
    """Have the port SOURCE no longer send to the port TARGET."""
    from yarpy.network.connection import ask_server, disconnect

    if persist:
        ask_server(None, ["unsubscribe", source, target])
        return 0
    if not disconnect(source, target):
        asked = target if _is_topic(source) else source  # of a port and a topic, the port knows
        complain(f'"{source}" is not connected to "{target}"; `yarpy ping {asked}` shows to what')
        return 1
    print_line(f"Success: Removed connection from {source} to {target}")
    return 0


def _is_topic(name: str) -> bool:
    """Return whether a name is that of another middleware, which cannot be asked."""
    from yarpy.contact import parse_contact

    reaches = parse_contact(name).reaches
    return reaches.broker or reaches.topic
