"""`yarpy panel [ROBOT]`: see and move a robot in a browser.

ROBOT is the beginning of its ports' names (/icubSim): every control board, camera and inertial unit
below it is shown, of yarpy or of C++, also when the robot starts later.

    --name PORT     the port that serves the page (/panel, or /panel/2 beside another one)
    --no-browser    open no browser
"""

from __future__ import annotations

import click

import yarpy
from yarpy.cli.browser import show_page
from yarpy.cli.ports import open_another, open_port
from yarpy.cli.service import server
from yarpy.cli.stderr import warn
from yarpy.contact import parse_contact
from yarpy.platform import waiting

NAME = "/panel"


@click.command()
@click.argument("robot", default="/icubSim")
@click.option(
    "--name", metavar="PORT",
    help="The port that serves the page (/panel, or /panel/2 beside another one).",
)  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Open no browser.")
def command(robot: str, name: str | None, no_browser: bool) -> int:
    """See and move a robot in a browser."""
    from yarpy.kits.views.panel import Panel

    parse_contact(robot)
    names = server()
    opening = open_port if name else open_another
    with opening(yarpy.Port, name or NAME, callback=lambda message: None) as port:
        missing = Panel(port, robot, names).missing()
        show_page(port, not no_browser)
        if missing:
            warn(missing)
        waiting.wait()
    return 0
