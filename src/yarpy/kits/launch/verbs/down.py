"""`yarpy down [NAME]`: stop a running application, as ^C does.

Programs of a `yarpy up` that was killed are ended, too. Exit codes: 0 it has stopped; 1 none runs,
or something would not end.
"""

from __future__ import annotations

import time
from typing import Final

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain

_POLL: Final = 0.05  # seconds


@click.command()
@click.argument("name", default="")
@click.option("--timeout", default=120.0, type=click.FloatRange(0), metavar="S",
              help="How long to wait for its end.")  # fmt: skip
def command(name: str, timeout: float) -> int:
    """Stop the application NAME (or that of the file NAME, or the only one) in reverse order."""
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.chosen import chosen
    from yarpy.kits.launch.supervise.leftover import end_all, told
    from yarpy.kits.launch.supervise.local import GRACE

    name = chosen(name)
    if name in control.running():
        control.ask(name, do="down")
        until = time.monotonic() + timeout
        while name in control.running():
            if time.monotonic() > until:
                complain(f'"{name}" has not ended after {timeout:g} s; `yarpy status` says why')
                return 1
            time.sleep(_POLL)
        print_line(f"{name} has stopped")
        return 0
    record = control.Record(name)
    found = record.left()
    left = end_all(found, GRACE)
    if left:
        complain(f"these do not end: {told({pid: found[pid] for pid in left})}")
        return 1
    record.close()
    if not found:
        control.ask(name, do="down")  # which says what runs
        return 1
    print_line(f"ended what was left of {name}: {told(found)}")
    return 0
