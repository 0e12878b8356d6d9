"""`yarpy env [VARIABLE]`: print `NAME=value` lines of the environment.

Differs from C++: it does not wait two seconds before it ends.
Exit codes: 0; 1 there is no such variable.
"""

from __future__ import annotations

import os

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain


@click.command()
@click.argument("variable", required=False)
def command(variable: str | None) -> int:
    """Print the environment, or one VARIABLE of it."""
    if variable is not None and variable not in os.environ:
        complain(f"Could not find environment variable '{variable}'")
        return 1
    for name in [variable] if variable is not None else sorted(os.environ):
        print_line(f"{name}={os.environ[name]}")
    return 0
