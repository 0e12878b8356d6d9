"""Errors on standard error: `error: ...`, always one line."""

from __future__ import annotations

from typing import Final

import click

from yarpy.log import readable
from yarpy.platform.refusal import reason

_FOR_PROGRAMS: Final = ", or use yarpy.LocalNames() inside one program"  # which is no command's way


def complain(text: str) -> None:
    """Say on standard error what went wrong."""
    label = click.style("error:", fg="red", bold=True)
    click.echo(f"{label} {_line(text)}", err=True)


def complain_of(error: Exception) -> None:
    """The same of an exception; one of the system names its file."""
    if isinstance(error, OSError) and error.strerror:
        complain(reason(error) + (f": {error.filename}" if error.filename else ""))
    else:
        complain(str(error))


def warn(text: str) -> None:
    """Say on standard error what may surprise."""
    label = click.style("warning:", fg="yellow", bold=True)
    click.echo(f"{label} {_line(text)}", err=True)


def _line(text: str) -> str:
    """A text of the library as one line for whoever typed a command."""
    return readable(" ".join(text.split()).replace(_FOR_PROGRAMS, ""))
