"""`yarpy panel [ROBOT]`: see and move a robot in a browser.

ROBOT is the beginning of its ports' names (/icubSim): every control board, camera and inertial unit
below it is shown, of yarpy or of C++, also when the robot starts later.

    --name PORT     the port that serves the page (any free name)
    --no-browser    open no browser
"""

from __future__ import annotations

import threading

import click

import yarpy
from yarpy.cli.browser import show_page
from yarpy.cli.ports import ANY, open_port
from yarpy.cli.service import server
from yarpy.cli.stderr import warn


@click.command()
@click.argument("robot", default="/icubSim")
@click.option(
    "--name", default=ANY, metavar="PORT", help="The port that serves the page.",
    show_default="a temporary one",
)  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Open no browser.")
def command(robot: str, name: str, no_browser: bool) -> int:
    """See and move a robot in a browser."""
    from yarpy.views.panel import Panel

    names = server()
    with open_port(yarpy.Port, name, callback=lambda message: None) as port:
        missing = Panel(port, robot, names).missing()
        show_page(port, not no_browser)
        if missing:
            warn(missing)
        threading.Event().wait()
    return 0
