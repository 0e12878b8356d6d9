"""`yarpy logs [PROGRAM]`: what programs of a running application have printed.

    yarpy logs                  the newest lines of all
    yarpy logs robot -n 1000    more of one
    yarpy logs -f               and what comes

Exit codes: 0 shown; 1 none runs, or there is no such program.
"""

from __future__ import annotations

import time
from typing import Final

import click

from yarpy.cli.output import print_line
from yarpy.errors import LocalProtocolError
from yarpy.log import readable

_PERIOD: Final = 0.3  # seconds between looks
_MOST: Final = 1000  # lines of one look


@click.command()
@click.argument("program", default="")
@click.option("--of", "name", default="", show_default=False, metavar="NAME",
              help="The application, if several run.")  # fmt: skip
@click.option("-n", "count", default=50, type=click.IntRange(0), metavar="N",
              help="Show so many lines.")  # fmt: skip
@click.option("-f", "--follow", is_flag=True, help="Go on until the application ends.")
def command(program: str, name: str, count: int, follow: bool) -> int:
    """Show the output of PROGRAM, or of all programs."""
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.chosen import chosen

    name, since, most, begun = chosen(name), 0, max(count, 1), False
    while True:
        try:
            told = control.ask(name, do="logs", name=program, since=since, most=most)
        except LocalProtocolError:
            if not begun:
                raise
            return 0  # it has ended
        for number, label, line in told["lines"]:
            since = number
            if begun or count:
                print_line(readable(f"{line}" if program else f"{label} | {line}"))
        if not follow:
            return 0
        begun, most = True, _MOST
        time.sleep(_PERIOD)
