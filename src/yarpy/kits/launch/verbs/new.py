"""`yarpy new NAME`: a project that runs at once, with a test that passes.

    yarpy new ball_tracker
    cd ball_tracker
    python -m pytest
    yarpy up ball_tracker.toml

Exit codes: 0 it is written; 1 the name is taken, or is none.
"""

from __future__ import annotations

from pathlib import Path

import click

from yarpy.cli.output import print_line


@click.command()
@click.argument("name")
def command(name: str) -> int:
    """Write a project called NAME: a module, its options, a test, an application."""
    from yarpy.kits.launch.project.create import create

    for path in create(name, Path()):
        print_line(str(path))
    print_line("now:")  # a line each, which every shell takes
    for line in (f"cd {name}", "python -m pytest", f"yarpy up {name}.toml"):
        print_line(f"  {line}")
    return 0
