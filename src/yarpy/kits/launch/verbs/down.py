"""`yarpy down [NAME]`: stop a running application, as ^C does.

Programs of a `yarpy up` that was killed are ended, too, and so are those that could not be, since
their server did not answer then. Exit codes: 0 it has stopped; 1 none runs, or something would not
end.
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
    from yarpy.errors import LocalProtocolError
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.chosen import chosen
    from yarpy.kits.launch.supervise.leftover import end_all, end_away, told
    from yarpy.kits.launch.supervise.local import GRACE

    name = chosen(name)
    ran = name in control.running()
    if ran:
        control.ask(name, do="down")
    until = time.monotonic() + timeout
    while True:
        try:
            record = control.Record(name)  # which it holds to its last word
            break
        except LocalProtocolError:
            if not ran:
                raise
        if time.monotonic() > until:
            complain(f'"{name}" has not ended after {timeout:g} s; `yarpy status` says why')
            return 1
        time.sleep(_POLL)
    found, away = record.left(), record.away()
    left = end_all(found, GRACE)
    far, silent = end_away(away, GRACE)
    if left:
        complain(f"these do not end: {told({pid: found[pid] for pid in left})}")
    for tag, why in silent.items():
        complain(f"{tag} may go on at {away[tag]}: {why}; `yarpy down {name}` tries again")
    if left:
        return 1
    record.close({tag: away[tag] for tag in silent})
    if silent:
        return 1
    if ran:
        print_line(f"{name} has stopped")
    elif found or away:
        ended = [*([told(found)] if found else []), *(f"{tag} at {away[tag]}" for tag in far)]
        what = f"ended what was left of {name}: {', '.join(ended)}"
        print_line(what if ended else f"nothing of {name} runs any more")
    else:
        control.ask(name, do="down")  # which says what runs
        return 1
    return 0
