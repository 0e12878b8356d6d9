"""`yarpy topic NAME [STRUCTURE]`, `--list`, `--remove NAME`: topics, which join many ports.

What is connected to `topic://NAME` reaches everything that `topic://NAME` is connected to.

Differs from C++: removing a topic that does not exist is an error.
Exit codes: 0 done; 1 not.
"""

from __future__ import annotations

import click

import yarpy
from yarpy.cli.output import print_json, print_line


@click.command()
@click.argument("name", required=False)
@click.argument("structure", required=False)
@click.option("--list", "listing", is_flag=True, help="List the topics.")
@click.option("--remove", is_flag=True, help="Remove the topic NAME.")
@click.option("--json", "as_json", is_flag=True, help="Print the list as JSON.")
def command(
    name: str | None, structure: str | None, listing: bool, remove: bool, as_json: bool
) -> int:
    """Make the topic NAME, whose messages look like STRUCTURE."""
    from yarpy.network.asking import ask_server

    if listing:
        topics = ask_server(None, ["topic"])
        if as_json:
            print_json(topics)
        else:
            print_line(f"Topics: {topics.to_text()}" if topics else "No topics")
        return 0
    if not name:
        raise click.UsageError("Please supply the topic name (or: --list, --remove NAME)")
    if remove:
        if name not in ask_server(None, ["topic"]):
            raise yarpy.UnknownName(f'no topic "{name}"; `yarpy topic --list` shows all')
        ask_server(None, ["untopic", name])
        print_line(f"Topic {name} deleted")
    else:
        ask_server(None, ["topic", name, structure] if structure else ["topic", name])
        print_line(f"Topic {name} created")
    return 0
