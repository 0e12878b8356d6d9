"""`yarpy help [COMMAND]`: the list of commands, or what one of them does."""

from __future__ import annotations

import click


@click.command()
@click.argument("verb", required=False, metavar="[COMMAND]")
@click.pass_context
def command(ctx: click.Context, verb: str | None) -> None:
    """List the commands, or explain one."""
    from yarpy.cli import main

    top = ctx.find_root()
    if verb is None:
        click.echo(main.root.get_help(top))
        return
    name, found, _ = main.root.resolve_command(top, [verb])
    assert found is not None
    with click.Context(found, info_name=name, parent=top) as inner:
        click.echo(found.get_help(inner))
