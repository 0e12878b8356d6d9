"""`yarpy admin rpc PORT [NAME]` and `yarpy admin write PORT REMOTE...`: the administrative side.

The same as `yarpy rpc` and `yarpy write`, but what is sent are commands to the port itself
(`[list] [in]`, `[add] /other` ...), not data for its owner. `write` throws the replies away; PORT
is the name of the asking side; no such port is opened.
"""

from __future__ import annotations

import click

from yarpy.cli import prompt, typed
from yarpy.cli.verbs import rpc


@click.group(invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> None:
    """Send commands to the administrative side of a port."""
    if ctx.invoked_subcommand is None:
        raise click.UsageError("Please supply a command: rpc or write", ctx)


@command.command("rpc", short_help="Send commands to PORT, print the replies.")
@click.argument("port")
@click.argument("name", default="")
def admin_rpc(port: str, name: str) -> int:
    """Send administrative commands from standard input to PORT, print the replies.

    `[help]` lists them.
    """
    return rpc.talk(port, name, admin=True)


@command.command("write", short_help="Send commands to each REMOTE.")
@click.argument("port")
@click.argument("remotes", nargs=-1, metavar="REMOTE...", required=True)
def admin_write(port: str, remotes: tuple[str, ...]) -> int:
    """Send administrative commands from standard input, in the name of PORT, to each REMOTE."""

    targets = [rpc.Target(remote, port, admin=True) for remote in remotes]
    for line in prompt.lines(history=f"admin_{port}"):
        for target in targets:
            target.ask(typed.bottle(line))
    for target in targets:
        target.close()
    return 0
