"""`yarpy plugin [NAME]`: the carriers, transports, name services, types, monitors, middlewares,
findings, devices, types of other systems and commands that are installed.

Without NAME lists them, one per line (`--list`: names only), with what installs what they need:
first the core, then each peer, each kit, and other packages, and says what this system has not got
for one; nothing is loaded. With NAME tells what it is and whether it loads. Exit codes: 0; 1 there
is no such plug-in, or it does not load.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import click

from yarpy.cli.output import print_all_json, print_line
from yarpy.cli.stderr import complain
from yarpy.facts import Row, TransportRow
from yarpy.registry import CarrierRegistry, Registry


@click.command()
@click.argument("name", required=False)
@click.option("--list", "names_only", is_flag=True, help="Print names only.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def command(name: str | None, names_only: bool, as_json: bool) -> int:
    """List the plug-ins that are installed, or tell about one."""

    found = [entry for entry in installed() if name in (None, entry.name)]
    if not found:
        complain(f'no plug-in "{name}"; `yarpy plugin` lists what is installed')
        return 1
    if as_json:
        print_all_json(entry._asdict() for entry in found)
    elif names_only:
        for entry in found:
            print_line(entry.name)
    elif name is None:
        for home in dict.fromkeys(entry.home for entry in found):
            print_line(f"{home}:")
            for entry in found:
                if entry.home == home:
                    more = entry.needs or entry.lacks
                    line = f"  {entry.kind:<12}{entry.name:<30}{more}"
                    print_line(line.rstrip())
    else:
        for entry in found:
            describe(entry.kind, name)
            if entry.lacks:
                print_line(f"  * here:   {entry.lacks}")
    return 0


class Installed(NamedTuple):
    """A plug-in. `home`: `core`, a peer or a kit of yarpy, or the distribution that brings it.
    `needs`: what to type so that it can be loaded, "" where yarpy alone is enough. `lacks`: why it
    is of no use on this system, "" if it is."""

    kind: str
    name: str
    home: str
    needs: str = ""
    lacks: str = ""


def installed() -> list[Installed]:
    """Return every plug-in: the core's first, then those of peers, kits and other packages."""
    from yarpy import registry
    from yarpy.cli.verb_list import VERBS

    found = [
        _installed(kind, name)
        for kind in (
            *(registry.carriers, registry.transports, registry.names, registry.types),
            *(registry.monitors, registry.middlewares, registry.findings, registry.devices),
            *(registry.idls, registry.idl_commands),
        )
        for name in kind.names()
    ]
    for name in sorted({*VERBS, *registry.commands.names()}):
        own = name in VERBS and registry.commands.row(name) is None
        found.append(
            Installed("command", name, "core") if own else _installed(registry.commands, name)
        )
    rings = ("core", "peers", "kits")
    order = {
        home: rings.index(ring)
        for home in {one.home for one in found}
        if (ring := home.partition(".")[0]) in rings
    }
    return sorted(found, key=lambda one: (order.get(one.home, len(rings)), one.home))


def _installed(plugins: Registry[Any], name: str) -> Installed:
    row, kind = plugins.row(name), plugins.kind.removesuffix("s")
    if row is None or not row.home:
        return Installed(kind, name, plugins.owner(name) or "added by hand")
    needs = row.advice if row.extra else ""
    return Installed(kind, name, row.home, needs, _lacks(plugins, name, row))


def _lacks(plugins: Registry[Any], name: str, row: Row) -> str:
    if isinstance(plugins, CarrierRegistry):
        return plugins.lacks(name)
    return row.lacks if isinstance(row, TransportRow) else ""


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
