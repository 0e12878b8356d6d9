"""`yarpy view [PORT...] [--connect SOURCE]...`: look at images, in a browser.

Opens ports that take images and shows them side by side in a page that the ports serve themselves,
whose address is printed. With a display a browser opens.

Differs from C++ yarpview: the window is a web page, so its place, size and title are the browser's;
pictures of 16 bits and of floating point numbers are stretched to what can be seen.
Exit codes: 1 a port cannot be opened, or a source cannot be one; otherwise it runs until a signal.
"""

from __future__ import annotations

import threading
from contextlib import ExitStack

import click

import yarpy
from yarpy.cli.browser import show_page
from yarpy.cli.ports import open_port
from yarpy.cli.source import Source

NAME = "/view"


@click.command()
@click.argument("ports", nargs=-1)
@click.option(
    "--connect", "sources", multiple=True, metavar="SOURCE",
    help="Ask SOURCE for its images; again for the next port.",
)  # fmt: skip
@click.option("--carrier", metavar="C", help="How the sources are connected (tcp).")
@click.option(
    "--quality", type=click.IntRange(1, 100), default=75, show_default=True, metavar="N",
    help="Quality of the JPEG files that browsers get, 1 to 100.",
)  # fmt: skip
@click.option(
    "--rate", type=click.FloatRange(0.01, 1000), default=30.0, show_default=True, metavar="HZ",
    help="Pictures per second that a browser gets at most.",
)  # fmt: skip
@click.option(
    "--out", "outs", multiple=True, metavar="PORT",
    help="Open PORT, which sends where people click: x y, or x0 y0 x1 y1 for a drag; again for the "
    "next picture.",
)  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Open no browser.")
def command(
    ports: tuple[str, ...],
    sources: tuple[str, ...],
    carrier: str | None,
    quality: int,
    rate: float,
    outs: tuple[str, ...],
    no_browser: bool,
) -> int:
    """Show the images that arrive at PORTS (/view) in a browser."""
    from yarpy.views.picture import Picture
    from yarpy.views.viewer import Viewer

    names = names_of(ports, max(len(sources), len(outs)))
    with ExitStack() as stack:
        opened = [stack.enter_context(open_port(yarpy.BufferedPort, name, "-")) for name in names]
        clicks = [stack.enter_context(open_port(yarpy.BufferedPort, out)) for out in outs]
        pictures = [Picture(port) for port in opened]
        Viewer(pictures, quality, rate, clicks)
        for picture, source in zip(pictures, sources, strict=False):
            Source(picture.port, source, carrier, picture.wait_for)
        show_page(opened[0], not no_browser)
        threading.Event().wait()
    return 0


def names_of(ports: tuple[str, ...], count: int) -> list[str]:
    """The ports to open: those that are named, and for `count` pictures more of their kind.

    >>> names_of((), 0)
    ['/view']
    >>> names_of(("/left",), 3)
    ['/left', '/view/2', '/view/3']
    """
    named = ports or (NAME,)
    return [*named, *(f"{NAME}/{number}" for number in range(len(named) + 1, count + 1))]
