"""`yarpy detect [--write]`: find a name server, the configured one or any in the network.

With `--ros`: see whether the ROS master of ROS_MASTER_URI answers, and store where it is for the
current namespace; likewise with `--zenoh`. `yarpy namespace /ros` before it stores that in a file
of its own.

Exit codes: 0 found; 1 not.
"""

from __future__ import annotations

import os
from typing import Any

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain, warn
from yarpy.cli.verbs.where import framed, serves
from yarpy.registry import names

TRIES = 3


@click.command()
@click.option("--write", is_flag=True, help="Store the address that was found.")
def command(write: bool, **others: bool) -> int:
    """Find a name server: the configured one, or, by multicast, any that answers.

    With the name of another system, such as --ros: its names; where they are is stored in any case.
    """
    for kind in others:
        if others[kind]:
            return _store(kind)
    from yarpy.config.configuration import Server, configuration, default_port, write_server
    from yarpy.names.default import client_of
    from yarpy.names.discovery import search

    found = configuration(os.environ, on_broken=warn)
    for server in found.servers[:1]:
        print_line(f"Checking for name server at ip {server.host} port {server.port}")
        print_line("If there is a long delay, try:\n  yarpy conf --clean\n")
        if serves(client_of(server)):
            print_line(framed("FOUND", _place(server.namespace, server.host, server.port)))
            return 0
    contact = None
    for number in range(1, TRIES + 1):
        print_line(f"Polling for name server (using multicast), try {number} of max {TRIES}")
        try:
            contact = search(found.namespace, default_port(os.environ), timeout=1.0, tries=1)
        except OSError as error:
            complain(f"this computer has no multicast: {error.strerror}")
            break
        if contact is not None:
            break
        print_line("No response to search for server")
    if contact is None:
        print_line(
            framed(
                "PROBLEM",
                "No valid YARP name server was found.",
                "Start one: yarpy server",
                "A server behind a router is not heard: yarpy conf HOST PORT",
                "Servers are looked for on the multicast port 10000, or YARP_PORT_RANGE.",
            )
        )
        return 1
    print_line(f"Received address {contact.host}:{contact.port}")
    notice = ["FOUND", _place(found.namespace, contact.host, contact.port)]
    if write:
        where = write_server(
            found.directory, Server(contact.host, contact.port, "yarp", found.namespace)
        )
        print_line(f"New configuration stored to {where}")
        print_line(framed(*notice, "", "Address saved."))
    else:
        print_line(
            framed(
                *notice,
                "",
                "WARNING",
                "The address is not stored. To do so:",
                "  yarpy detect --write",
            )
        )
    return 0


for _kind in names.names():
    command.params.append(
        click.Option([f"--{_kind}"], is_flag=True, help=f"Store where the names of {_kind} are.")
    )


def _store(kind: str) -> int:
    """Store where the names of another system are, if they answer."""
    from yarpy.config.configuration import Server, configuration, write_server
    from yarpy.names.default import default_client

    found = configuration(os.environ, on_broken=warn)
    client: Any = default_client(Server("", 0, kind, found.namespace))
    where = client.place()
    print_line(f"Trying {client.title}, {where}")
    if not client.alive():
        print_line("Could not reach it.")
        complain(client.hint)
        return 1
    print_line("Reachable.  Writing.")
    host, port = client.address()
    stored = Server(host, port, kind, found.namespace)
    print_line(f"New configuration stored to {write_server(found.directory, stored)}")
    print_line(framed(f"{found.namespace} is now {client.title}, at {where}"))
    return 0


def _place(namespace: str, host: str, port: int) -> str:
    return f"{namespace} is available at ip {host} port {port}"
