"""`yarpy connect --of NAME` and `yarpy disconnect --of NAME`: connections of a running application.

    yarpy connect --of demo                   all of them are made, and kept
    yarpy connect --of demo /cam /view        one of them
    yarpy disconnect --of demo /cam /view     ends one, and leaves it so

NAME is that of the application, or its file. `yarpy up` makes connections by itself; after
`--idle`, or where one was ended, this does. What waits for a port is made when that is there.

Exit codes: 0 done; 1 a connection is not there yet, was refused, or is none of the application.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Final

import click

from yarpy.cli.output import print_line
from yarpy.log import readable

if TYPE_CHECKING:
    from collections.abc import Sequence

_TIMEOUT: Final = 5.0  # seconds for what can be made now
_PERIOD: Final = 0.1


@click.command()
@click.argument("word", type=click.Choice(["connect", "disconnect"]))
@click.argument("name")
@click.argument("source", default="")
@click.argument("target", default="")
def command(word: str, name: str, source: str, target: str) -> int:
    """Make or end the connection SOURCE TARGET of the application NAME, or all of them."""
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.chosen import chosen

    if bool(source) != bool(target):
        raise click.UsageError("name both ports, or none for all connections")
    name = chosen(name)
    wanted = [(source, target)]
    if not source:
        told = control.ask(name, do="status")["connections"]
        wanted = [(one["from"], one["to"]) for one in told]
    for ends in wanted:
        control.ask(name, do=word, **dict(zip(("from", "to"), ends, strict=True)))
    if word == "disconnect":
        return 0
    until = time.monotonic() + _TIMEOUT
    while True:
        told = control.ask(name, do="status")["connections"]
        links = [one for one in told if (one["from"], one["to"]) in wanted]
        if all(one["state"] in ("connected", "refused") for one in links):
            break
        if time.monotonic() > until:
            break
        time.sleep(_PERIOD)
    return _told(links)


def _told(links: Sequence[dict[str, Any]]) -> int:
    """Say how connections are doing; 1 if one is not made."""
    for one in links:
        line = f"{one['from']} -> {one['to']}  {one['state']} {one['detail']}"
        print_line(readable(line).rstrip())
    return 0 if all(one["state"] == "connected" for one in links) else 1
