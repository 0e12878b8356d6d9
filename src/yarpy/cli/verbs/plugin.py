"""`yarpy plugin [NAME]`: the carriers, types, monitors, findings and commands that are installed.

Without NAME lists them, one per line (`--list`: names only); with NAME tells what it is and whether
it loads. Exit codes: 0; 1 there is no such plug-in, or it does not load.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click

from yarpy.cli.output import print_all_json, print_line
from yarpy.cli.stderr import complain


@click.command()
@click.argument("name", required=False)
@click.option("--list", "names_only", is_flag=True, help="Print names only.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def command(name: str | None, names_only: bool, as_json: bool) -> int:
    """List the plug-ins that are installed, or tell about one."""

    found = [entry for entry in installed() if name in (None, entry[1])]
    if not found:
        complain(f'no plug-in "{name}"; `yarpy plugin` lists what is installed')
        return 1
    if as_json:
        print_all_json({"kind": kind, "name": found_name} for kind, found_name in found)
    elif name is None:
        for kind, found_name in found:
            print_line(found_name if names_only else f"{kind:<10}{found_name}")
    else:
        for kind, _ in found:
            describe(kind, name)
    return 0


def installed() -> Iterator[tuple[str, str]]:
    """Kind and name of every plug-in: ours, and those of other packages."""
    from yarpy import registry
    from yarpy.cli.verb_list import VERBS

    for kind in (registry.carriers, registry.types, registry.monitors, registry.findings):
        for name in kind.names():
            yield kind.kind.removesuffix("s"), name
    for name in sorted({*VERBS, *registry.commands.names()}):
        yield "command", name


def describe(kind: str, name: str) -> None:
    """Print what a plug-in is. Raises UnknownPlugin if it does not load."""
    from yarpy import registry
    from yarpy.cli.main import find_verb

    plugin: Any
    plugin = find_verb(name) if kind == "command" else getattr(registry, f"{kind}s").load(name)
    where = getattr(plugin, "callback", None) or plugin
    print_line(f"Yes, {name} is a {kind}")
    print_line(f"  * module: {getattr(where, '__module__', type(plugin).__module__)}")
    print_line(f"  * object: {getattr(where, '__qualname__', type(plugin).__qualname__)}")
    summary = (getattr(plugin, "help", None) or getattr(plugin, "__doc__", None) or "").strip()
    if summary:
        print_line(f"  * about:  {summary.splitlines()[0]}")
