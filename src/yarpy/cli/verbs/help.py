"""`yarpy help [COMMAND]`: the list of commands, or what one of them does.

`yarpy help --man` prints all of it as a manual page, which `man yarpy` shows where yarpy is
installed.
"""

from __future__ import annotations

import click


@click.command()
@click.argument("verb", required=False, metavar="[COMMAND]")
@click.option("--man", is_flag=True, help="Print the manual page, in the language of man(7).")
@click.pass_context
def command(ctx: click.Context, verb: str | None, man: bool) -> None:
    """List the commands, or explain one."""
    from yarpy.cli import main

    top = ctx.find_root()
    if man:
        from yarpy.cli.manual import manual

        click.echo(manual(main.root), nl=False)
        return
    if verb is None:
        click.echo(main.root.get_help(top))
        return
    name, found, _ = main.root.resolve_command(top, [verb])
    assert found is not None
    with click.Context(found, info_name=name, parent=top) as inner:
        click.echo(found.get_help(inner))
