"""`yarpy disconnect [--persist] SOURCE TARGET`: end a connection of two ports.

    disconnect --of NAME [SOURCE TARGET]    those of a running application, which leaves them so

`--persist` forgets a persistent connection; what is connected now stays so.
Exit codes: 0 done; 1 they were not connected, or cannot be asked.
"""

from __future__ import annotations

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain


@click.command()
@click.argument("source", required=False)
@click.argument("target", required=False)
@click.option("--persist", is_flag=True, help="Forget the persistent connection.")
@click.option("--of", "application", metavar="NAME",
              help="End the connections of a running application, or this one.")  # fmt: skip
def command(source: str | None, target: str | None, persist: bool, application: str | None) -> int:
    """Have the port SOURCE no longer send to the port TARGET."""
    from yarpy.network.asking import ask_server
    from yarpy.network.connection import disconnect

    if application is not None:
        from yarpy.cli.verbs.connect import of_application

        return of_application("disconnect", application, source, target)
    if source is None or target is None:
        raise click.UsageError("name both ports, SOURCE and TARGET")

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
