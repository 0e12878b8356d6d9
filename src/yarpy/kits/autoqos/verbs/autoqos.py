"""`yarpy autoqos RULES.toml`: set priorities while connections run, so that what matters comes in
time.

    [[critical]]
    connections = ["/icub/*/command:i"]    # the name of either port, or "/from -> /to"
    deadline = 0.01                        # seconds a message may take
    rate = 100                             # messages per second, if they have no stamps

    [[best-effort]]
    connections = ["/icub/cam/*"]
    least = 2.0                            # Mbit/s that each keeps in any case
    carrier = "tcp+send.adaptive"          # that it may be moved to

It asks ports and sets them from outside, those of C++ too, until it is interrupted; then everything
is as it was. Each step is one line. An agent that was killed is cleaned up after by the next one.

Exit codes: 1 mistake in the rules, another agent runs; otherwise it runs until a signal.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from yarpy.cli.output import print_json, print_line
from yarpy.cli.stderr import complain
from yarpy.errors import LocalProtocolError
from yarpy.log import readable

if TYPE_CHECKING:
    from yarpy.kits.autoqos.agent import Event


@click.command()
@click.argument("rules", type=click.Path(path_type=Path))
@click.option("--dry-run", is_flag=True, help="Change nothing; say what would be done.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object for each step.")
def command(rules: Path, dry_run: bool, as_json: bool) -> int:
    """Set priorities by what RULES say matters, while connections run."""
    from yarpy.kits.autoqos.agent import Agent
    from yarpy.kits.autoqos.journal import Journal, path
    from yarpy.kits.autoqos.rules import load

    def tell(event: Event) -> None:
        if as_json:
            print_json(
                {
                    "time": event.time,
                    "text": event.text,
                    "dry": dry_run,
                    "changes": [change.as_dict() for change in event.changes],
                    "failed": [{**change.as_dict(), "error": why} for change, why in event.failed],
                }
            )
            return
        for line in lines(event, dry_run):
            print_line(readable(line))

    journal = None
    try:
        read = load(rules)
        journal = None if dry_run else Journal(path())
        Agent(read, tell, journal).run()
    except LocalProtocolError as error:
        complain(str(error))
        return 1
    finally:
        if journal is not None:
            journal.close()
    return 0


def lines(event: Event, dry_run: bool) -> list[str]:
    """A step for people: the line that explains it, and what failed."""
    clock = time.strftime("%H:%M:%S", time.localtime(event.time))
    would = "would: " if dry_run and event.changes else ""
    return [
        f"{clock} {would}{event.text}",
        *(f"         refused: {why}" for _, why in event.failed[:5]),
    ]
