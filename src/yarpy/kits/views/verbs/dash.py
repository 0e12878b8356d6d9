"""`yarpy dash`: see and change the whole network in a browser.

Every port and connection of the name server's network, of yarpy or of C++: rates, latency, drops,
priorities, the newest messages; connect, disconnect and set priorities by hand.

    --name PORT     the port that serves the page (/dash, or /dash/2 beside another one)
    --no-browser    open no browser
    --lan           let other computers of this network see the page, and change things

What may be reached from here may be changed from the page, so this computer alone reaches it.

Exit codes: 1 no name server answers; otherwise it runs until a signal.
"""

from __future__ import annotations

import os

import click

import yarpy
from yarpy.cli.browser import show_page
from yarpy.cli.ports import open_another, open_port
from yarpy.cli.service import server
from yarpy.platform import waiting
from yarpy.transports.bind import SETTING

NAME = "/dash"


@click.command()
@click.option(
    "--name", metavar="PORT",
    help="The port that serves the page (/dash, or /dash/2 beside another one).",
)  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Open no browser.")
@click.option("--lan", is_flag=True, help="Let other computers see and change things too.")
def command(name: str | None, no_browser: bool, lan: bool) -> int:
    """See and change the whole network in a browser."""
    from yarpy.kits.views.dash import Dash

    if not lan:
        os.environ.setdefault(SETTING, "local")
    names = server()
    opening = open_port if name else open_another
    with opening(yarpy.Port, name or NAME, callback=lambda message: None) as port:
        Dash(port, names)
        show_page(port, not no_browser)
        waiting.wait()
    return 0
