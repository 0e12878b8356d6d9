"""`yarpy stop PROGRAM`: end one program of a running application, and leave it so.

The others run on; `yarpy start PROGRAM` starts it again. `yarpy down` stops all.

Exit codes: 0 it was told to; 1 there is no such program.
"""

from __future__ import annotations

import click


@click.command()
@click.argument("program")
@click.option("--of", "name", default="", show_default=False, metavar="NAME",
              help="The application, if several run.")  # fmt: skip
def command(program: str, name: str) -> int:
    """End PROGRAM until it is started again, whatever its policy of restarts is."""
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.chosen import chosen

    control.ask(chosen(name), do="stop", name=program)
    return 0
