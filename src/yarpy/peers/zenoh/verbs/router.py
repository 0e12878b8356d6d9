"""`yarpy router [WHERE]...`: run a router of Zenoh, where programs with names on Zenoh meet.

    router                                   for the programs of this computer
    router tcp/0.0.0.0:7447                  for those of all networks
    router tls/0.0.0.0:7447                  with the certificates of `yarpy cert`
    router tcp/0.0.0.0:7447 --connect tcp/other.lab:7447      joined with another one
    router --config router.json5             with what a file of Zenoh says: access lists, for one

Routers that are connected, one way or the other, are one: a program connects to the nearest.
YARPY_TLS=require allows tls alone, and mutual only programs with a certificate of our authority.

Exit codes: 0 ended by a signal; 1 the address is in use, or a certificate or file is missing.
"""

from __future__ import annotations

import click

from yarpy.cli.output import print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import warn
from yarpy.platform import waiting


@click.command()
@click.argument("where", nargs=-1)
@click.option("--connect", multiple=True, metavar="ROUTER", help="Join it, as soon as it is there.")
@click.option("--config", "file", metavar="FILE", help="A configuration of Zenoh.")
def command(where: tuple[str, ...], connect: tuple[str, ...], file: str | None) -> int:
    """Run a router of Zenoh, at WHERE: `tcp/0.0.0.0:7447`; else for this computer alone."""
    from yarpy.peers.zenoh.place import HERE
    from yarpy.peers.zenoh.router import open_router, unjoined
    from yarpy.peers.zenoh.transport import close

    router = open_router(where, connect, file or "")
    try:
        told = ", ".join(where) or file or f"tcp/{HERE}"
        print_line(f"Zenoh router at {told}" + "".join(f", joins {one}" for one in connect))
        if not where and not file:
            print_line("for programs of this computer; for others: yarpy router tcp/0.0.0.0:7447")
        for line in unjoined(router, connect):
            warn(line)
        _wait()
    except Interrupted:
        return 0
    finally:
        close(router)
    return 0


def _wait() -> None:

    waiting.wait()
