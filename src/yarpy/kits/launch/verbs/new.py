"""`yarpy new NAME`: a project that runs at once, with a test that passes.

    yarpy new ball_tracker
    cd ball_tracker && python -m pytest && yarpy up ball_tracker.toml

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
    print_line(f"now: cd {name}; python -m pytest; yarpy up {name}.toml")
    return 0
