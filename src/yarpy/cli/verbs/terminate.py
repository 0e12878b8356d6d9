"""`yarpy terminate NAME`: ask a program to end, by the name of its port.

Programs that can be asked (yarpdev, modules) listen at `NAME/quit`; either name may be given.

Differs from C++: a program that cannot be asked is an error. (C++ says 0 and sends a command that
ports understand in debug builds only.) Exit codes: 0 it was asked; 1 it cannot be.
"""

from __future__ import annotations

import click

import yarpy
from yarpy.cli.output import print_line


@click.command()
@click.argument("name")
def command(name: str) -> int:
    """Ask the program that listens at NAME/quit to end."""
    from yarpy.network.asking import confirmed, find
    from yarpy.port.connect import probe

    wanted = name if "/quit" in name else f"{name.rstrip('/')}/quit"
    if wanted != name and yarpy.query(wanted) is None:
        find(name)
        raise yarpy.UnknownName(
            f'"{name}" has no port "{wanted}", so its program cannot be asked to end'
        )
    contact = confirmed(wanted)
    print_line(f"Asking port {name} to quit gracefully")
    probe.ask(contact, ["quit"], key="d", name="yarpy_terminate")
    return 0
