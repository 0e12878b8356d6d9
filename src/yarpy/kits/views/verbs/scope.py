"""`yarpy scope [PORT...] [--index 0,1,...]`: look at numbers as curves, in a browser.

Opens a port that takes numbers, asks each PORT to send to it, and draws what comes in a page that
the port serves itself, whose address is printed. With a display a browser opens.

Differs from C++ yarpscope: all numbers are drawn where nobody chooses, up to twelve; sources are
connected over tcp; there are no XML files, and how it is drawn is chosen in the page.
Exit codes: 1 the port cannot be opened, or a source cannot be one; otherwise it runs until a
signal.
"""

from __future__ import annotations

from functools import partial

import click

import yarpy
from yarpy.cli.browser import show_page
from yarpy.cli.ports import open_another, open_port
from yarpy.cli.source import Source, also_said
from yarpy.platform import waiting

NAME = "/scope"


@click.command()
@click.argument("ports", nargs=-1)
@click.option(
    "--index", "indices", metavar="LIST",
    help="Which elements of the messages, such as 0,2 or 0-3; elements of lists count on.",
)  # fmt: skip
@click.option("--name", metavar="PORT", help=f"The port to open ({NAME}).")
@click.option("--carrier", metavar="C", help="How the ports are connected (tcp).")
@click.option("--min", "low", type=float, metavar="Y", help="The lower end of the axis.")
@click.option("--max", "high", type=float, metavar="Y", help="The upper end of the axis.")
@click.option(
    "--window", type=click.FloatRange(0.01, 3600), default=10.0, metavar="S", show_default=True,
    help="Seconds that are seen at once.",
)  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Open no browser.")
def command(
    ports: tuple[str, ...],
    indices: str | None,
    name: str | None,
    carrier: str | None,
    low: float | None,
    high: float | None,
    window: float,
    no_browser: bool,
) -> int:
    """Draw the numbers that PORTS send, in a browser.

    Without PORTS it waits for whoever connects to /scope.
    """
    from yarpy.contact import parse_contact
    from yarpy.kits.views.scope import Scope
    from yarpy.kits.views.trace import parse_indices

    try:
        chosen = parse_indices(indices or "")
    except ValueError as error:
        raise click.UsageError(f"--index: {error}") from error
    if low is not None and high is not None and not low < high:
        raise click.UsageError(f"--min {low:g} is not below --max {high:g}")
    known = [contact.name for contact in map(parse_contact, ports) if contact.name]
    scope = Scope(known, chosen, {"min": low, "max": high, "window": window})
    # Others connect to the one without PORTS by its name; those with PORTS run side by side.
    opening = open_another if ports and not name else open_port
    with opening(yarpy.Port, name or NAME, callback=scope.take) as port:
        scope.serve(port)
        for source in ports:
            Source(port, source, carrier, also_said(partial(scope.wait_for, source)))
        show_page(port, not no_browser)
        waiting.wait()
    return 0
