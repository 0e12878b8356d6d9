"""`yarpy namespace [NAME...]`: show or set the namespaces in use.

Differs from C++: a namespace begins with "/", so `yarpy namespace list` is an error and changes
nothing. Exit codes: 0 done; 1 not.
"""

from __future__ import annotations

import os

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.stderr import warn


@click.command()
@click.argument("names", nargs=-1)
def command(names: tuple[str, ...]) -> int:
    """Show the namespaces in use, or set them: the first one is where ports are registered."""
    from yarpy.config.configuration import ROOT, namespaces, write_namespaces
    from yarpy.platform.folders import conf_directory

    directory = conf_directory(os.environ)
    if names:
        for name in names:
            if not name.startswith("/"):
                raise yarpy.AddressError(f'a namespace begins with "/" (given: "{name}")')
        print_line(f"Setting namespace in: {write_namespaces(directory, names)}")
        print_line(f"Remove this file to revert to the default namespace ({ROOT})")
        if os.environ.get("YARP_NAMESPACE"):
            warn("YARP_NAMESPACE is set here, and wins over the file")
    found = namespaces(os.environ, directory)
    if len(found) == 1:
        print_line(f"YARP namespace: {found[0]}")
    else:
        print_line(f"YARP namespaces: {yarpy.Bottle(found).to_text()}")
    return 0
