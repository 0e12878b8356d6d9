"""`yarpy conf`: the address file of the name server.

    conf                       print its path
    conf HOST PORT [MODE]      write it
    conf --clean               empty it

Differs from C++: PORT and MODE are checked. Exit codes: 0 done; 1 not.
"""

from __future__ import annotations

import os

import click

from yarpy.cli.output import print_line
from yarpy.errors import AddressError
from yarpy.registry import names


@click.command()
@click.argument("host", required=False)
@click.argument("port", required=False, type=click.IntRange(1, 65535))
@click.argument("mode", default="yarp", type=click.Choice(["yarp", "local", *names.names()]))
@click.option("--clean", is_flag=True, help="Forget the address.")
def command(host: str | None, port: int | None, mode: str, clean: bool) -> int:
    """Print the path of the address file, or write HOST and PORT of a name server to it."""
    from yarpy.config.configuration import (
        Server,
        clear_server,
        namespaces,
        read_server,
        server_file,
        write_server,
    )
    from yarpy.platform.folders import conf_directory

    directory = conf_directory(os.environ)
    namespace = namespaces(os.environ, directory)[0]
    if clean:
        print_line(f"Cleared configuration file:\n  {clear_server(directory, namespace)}")
        return 0
    if host is None:
        print_line(str(server_file(directory, namespace)))
        return 0
    if port is None:
        raise click.UsageError("Command not understood: give both HOST and PORT")
    path = server_file(directory, namespace)
    print_line(f"Configuration file:\n  {path}")
    try:
        stored = read_server(directory, namespace) if path.exists() else None
    except AddressError:  # who is told of it is sent here
        stored = None
    if stored is not None:
        print_line(f"Stored:\n  {described(stored)}")
    write_server(directory, Server(host, port, mode, namespace))
    print_line(f"Now stores:\n  {described(Server(host, port, mode))}")
    return 0


def described(server: object) -> str:
    """`host H port number P (yarp name server)`."""
    from yarpy.config.configuration import Server

    assert isinstance(server, Server)
    return f"host {server.host} port number {server.port} ({server.mode} name server)"
