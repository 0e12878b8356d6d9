"""`yarpy version`: which yarpy this is."""

from __future__ import annotations

import click

from yarpy import __version__


@click.command()
def command() -> None:
    """Print the version."""
    click.echo(f"yarpy version {__version__}")
