"""`yarpy clean [--timeout S]`: take the names of dead ports off the name server.

A name is dead when its host refuses connections there, or when another port has its number. A port
that listens and does not answer is stuck, not dead, and one whose host cannot be reached may come
back: they keep their names.

Differs from C++: ports are tried side by side, with a timeout of 3 seconds where none is given;
numbers that another port has taken over are found. Exit codes: 0 done; 1 no name server.
"""

from __future__ import annotations

import socket
from typing import Final

import click

import yarpy
from yarpy.cli.output import print_line

TIMEOUT: Final = 3.0
AT_ONCE: Final = 16


@click.command()
@click.option("--timeout", type=float, metavar="S", help="Seconds to wait for each port.")
def command(timeout: float | None) -> int:
    """Remove the names of dead ports from the name server."""
    from concurrent.futures import ThreadPoolExecutor

    from yarpy.cli.service import server

    client = server()
    if timeout is None:
        print_line(f"Waiting {TIMEOUT:g} seconds for each port; `--timeout S` changes that")
    else:
        print_line(f"Using a timeout of {timeout:g} seconds")
    print_line("Requesting list of ports from name server...")
    contacts = client.list()
    print_line(f"got {len(contacts)} port(s)")
    own = (client.host, client.port)
    with ThreadPoolExecutor(AT_ONCE) as pool:
        verdicts = [
            None
            if is_kept(contact, own)
            else pool.submit(reason_of_death, contact, timeout or TIMEOUT)
            for contact in contacts
        ]
        for contact, verdict in zip(contacts, verdicts, strict=True):
            if verdict is None:
                print_line(
                    f"Skipping mcast port {contact.name}..."
                    if contact.carrier == "mcast" and contact.name != "fallback"
                    else f"Ignoring {contact.name}"
                )
                continue
            print_line(f"Testing {contact.name} at tcp://{contact.address}/")
            reason = verdict.result()
            if reason:
                print_line(f"* {reason}, removing port {contact.name}")
                client.unregister(contact.name)
    print_line("Giving name server a chance to do garbage collection.")
    print_line(f"Name server says: {' '.join(map(str, client.request(['gc'])))}")
    return 0


def is_kept(contact: yarpy.Contact, own: tuple[str, int]) -> bool:
    """Return whether a registration is left alone: groups, topics, the server itself."""
    return (
        contact.carrier in ("mcast", "topic")
        or contact.name in ("", "fallback")
        or (contact.host, contact.port) == own
    )


def reason_of_death(contact: yarpy.Contact, timeout: float) -> str:
    """Return why nobody can reach this port, "" if somebody can or may."""
    try:
        socket.create_connection((contact.host, contact.port), timeout).close()
    except ConnectionRefusedError:
        return "No response"
    except (OSError, UnicodeError):
        return ""  # a cut cable, a host that is off: nobody knows what runs there
    if contact.carrier != "tcp":
        return ""  # a camera, or another system: it listens, and speaks no YARP
    from yarpy.port.connect import probe

    try:
        lines = probe.describe(contact, timeout=timeout)
    except (yarpy.YarpError, OSError):
        return ""
    words = lines[0].split() if lines else []
    named = words[:2] == ["This", "is"] and len(words) > 2
    return f"{words[2]} is there now" if named and words[2] != contact.name else ""
