"""What went wrong, on standard error: `error: ...`, always one line."""

from __future__ import annotations

import click

from yarpy.log import readable


def complain(text: str) -> None:
    """Say on standard error what went wrong."""
    label = click.style("error:", fg="red", bold=True)
    click.echo(f"{label} {readable(' '.join(text.split()))}", err=True)


def complain_of(error: Exception) -> None:
    """The same of an exception; one of the system names its file."""
    if isinstance(error, OSError) and error.strerror:
        complain(error.strerror + (f": {error.filename}" if error.filename else ""))
    else:
        complain(str(error))


def warn(text: str) -> None:
    """Say on standard error what may surprise."""
    label = click.style("warning:", fg="yellow", bold=True)
    click.echo(f"{label} {readable(' '.join(text.split()))}", err=True)
