"""`yarpy version`: which yarpy this is."""

from __future__ import annotations

import click

import yarpy


@click.command()
def command() -> None:
    """Print the version."""
    click.echo(f"yarpy version {yarpy.__version__}")
