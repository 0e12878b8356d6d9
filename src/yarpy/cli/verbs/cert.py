"""`yarpy cert [NAME]...`: a certificate for TLS, of a laboratory's own authority.

NAME are the names and addresses by which this computer is dialled; without, all that it has.

    --out DIR    for another computer: write its files there, to be copied into its folder `tls`

The first time it makes the authority too. Exit codes: 0 done; 1 not.
"""

from __future__ import annotations

import socket
from pathlib import Path

import click

from yarpy.cli.output import print_line


@click.command()
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option("--out", type=click.Path(file_okay=False), metavar="DIR", help="For another one.")
def command(names: tuple[str, ...], out: str | None) -> int:
    """Make a certificate for TLS."""
    from yarpy.config.authority import make
    from yarpy.names.address import local_addresses
    from yarpy.transports.tls_setting import folder

    if out is not None and not names:
        raise click.UsageError("say which computer it is for: yarpy cert NAME --out DIR")
    if not names:
        names = (*dict.fromkeys([socket.gethostname(), "localhost", *local_addresses()]),)
    where = folder()
    if make(where if out is None else Path(out), names, where):
        print_line(f"Authority made in {where}; keep {where / 'ca-key.pem'} to yourself")
    print_line(f"Certificate for {' '.join(names)} in {out or where}")
    return 0
