"""`yarpy version`: which yarpy this is, and whether its core is compiled (`make wheel`)."""

from __future__ import annotations

import click

import yarpy


@click.command()
def command() -> None:
    """Print the version, and whether the core is compiled."""
    from yarpy.wire import stream

    compiled = not (stream.__file__ or "").endswith(".py")
    core = "compiled core" if compiled else "pure Python"
    click.echo(f"yarpy version {yarpy.__version__} ({core})")
