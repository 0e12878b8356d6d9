"""`yarpy start PROGRAM`: start a program of a running application that has ended or was stopped.

Exit codes: 0 it was told to; 1 there is no such program.
"""

from __future__ import annotations

import click


@click.command()
@click.argument("program")
@click.option("--of", "name", default="", show_default=False, metavar="NAME",
              help="The application, if several run.")  # fmt: skip
def command(program: str, name: str) -> int:
    """Start PROGRAM; nothing happens if it runs."""
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.chosen import chosen

    control.ask(chosen(name), do="start", name=program)
    return 0
