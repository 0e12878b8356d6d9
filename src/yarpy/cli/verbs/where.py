"""`yarpy where`: tell where the name server is, and whether it answers.

Exit codes: 0 it answers; 1 it does not, or none is configured.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import click

from yarpy.cli.output import print_json, print_line
from yarpy.cli.stderr import complain
from yarpy.errors import NoNameServer

if TYPE_CHECKING:
    from yarpy.config.configuration import Server
    from yarpy.names.base import Foreign
    from yarpy.names.client import YarpNameClient

FRAME = "=" * 57


def framed(*lines: str) -> str:
    """A notice as C++ frames it."""
    return "\n".join([FRAME, "==", *(f"== {line}" for line in lines), "==", FRAME])


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print the answer as a JSON object.")
def command(as_json: bool) -> int:
    """Tell where the name server is, and whether it answers."""
    from yarpy.config.configuration import configuration, server_file
    from yarpy.names.base import Foreign
    from yarpy.names.default import client_of, default_client

    found = configuration(os.environ)
    path = server_file(found.directory, found.namespace)
    if not found.servers:
        if as_json:
            print_json({"namespace": found.namespace, "available": False})
            return 1
        print_line(
            framed(
                "PROBLEM",
                "No address for a YARP name server is available.",
                f"Configuration file: {path}",
                "Start a server: yarpy server",
                "or find one:    yarpy detect --write",
            )
        )
        return 1
    code = 1
    for server in found.servers:
        names = default_client(server)
        if isinstance(names, Foreign):
            code = 0 if _tell(names, server, as_json) else code
            names.close()
            continue
        if not as_json:
            print_line(f"Looking for name server on {server.host}, port number {server.port}")
            print_line("If there is a long delay, try:\n  yarpy conf --clean")
        alive = serves(client_of(server))
        code = 0 if alive else code
        if as_json:
            print_json(
                {
                    "namespace": server.namespace,
                    "host": server.host,
                    "port": server.port,
                    "configuration": str(server.path or "YARPY_SERVER"),
                    "available": alive,
                }
            )
        elif alive:
            print_line(
                f"Name server {server.namespace} is available at ip {server.host} "
                f"port {server.port}"
            )
        else:
            print_line(
                framed(
                    "PROBLEM",
                    "No valid YARP name server is available.",
                    f"{server.path or 'YARPY_SERVER'} expects it at ip {server.host} "
                    f"port {server.port}",
                    "Start it:          yarpy server",
                    "or find another:   yarpy detect --write",
                    "or correct this:   yarpy conf HOST PORT",
                )
            )
    return code


def _tell(names: Foreign, server: Server, as_json: bool) -> bool:
    """Tell where names of another system are; whether they can be used."""
    try:
        place, alive, problem = names.place(), names.alive(), ""
    except NoNameServer as error:
        place, alive, problem = server.host, False, str(error)
    if as_json:
        said = {"namespace": server.namespace, "mode": server.mode, "place": place}
        print_json({**said, "available": alive})
    elif alive:
        print_line(f"Names of {server.namespace}: {names.title}, at {place}")
        print_line("There is no name server of YARP there.")
    else:
        print_line(framed("PROBLEM", problem or f"Nobody answers for {names.title} at {place}."))
    return alive


def serves(client: YarpNameClient) -> bool:
    """Return whether a name server answers there; print what else does."""
    if not client.alive():
        return False
    try:
        return bool(client.list())
    except NoNameServer as error:
        complain(str(error))
        return False
