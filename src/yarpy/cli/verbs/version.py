"""`yarpy version`: which yarpy this is, and whether its core is compiled (`make wheel`)."""

from __future__ import annotations

import click

import yarpy


def text() -> str:
    """The version, and how its core runs."""
    from yarpy.wire import stream

    compiled = not (stream.__file__ or "").endswith(".py")
    return f"yarpy version {yarpy.__version__} ({'compiled core' if compiled else 'pure Python'})"


@click.command()
def command() -> None:
    """Print the version, and whether the core is compiled."""
    click.echo(text())
