"""Messages of `Network` to a name server, and where it is: `writeToNameServer` and its like."""

from __future__ import annotations

import os
from typing import Any

import yarpy
from yarp import _names
from yarp._contact import Contact, ContactStyle
from yarp._log import say
from yarpy.config.configuration import (
    Server,
    conf_directory,
    configuration,
    namespaces,
    write_namespaces,
    write_server,
)
from yarpy.network.connection import ask_server


def write_to_name_server(cmd: Any, reply: Any, style: ContactStyle | None = None) -> bool:
    """Ask the name server in its own words: a Bottle such as `NAME_SERVER query /port`."""
    words = [*cmd._native]
    if words and str(words[0]) == "NAME_SERVER":
        words = words[1:]
    try:
        found: Any = ask_server(_names.names(), words)
    except yarpy.YarpError as error:
        if style is None or not style.quiet:
            say("ERROR", str(error))
        return False
    reply._native[:] = found
    return True


def set_name_server_name(name: str) -> bool:
    """Use another namespace from now on, as `yarp namespace` does; it is kept in a file."""
    if not name.startswith("/"):
        return False
    directory = conf_directory(os.environ)
    others = [each for each in namespaces({}, directory) if each != name]
    try:
        write_namespaces(directory, [name, *others])
    except OSError as error:
        say("ERROR", f"|yarp.os.Network| {error}")
        return False
    return True


def set_name_server_contact(contact: Contact) -> bool:
    """Say where the name server of this namespace is, as `yarp conf` does; it is kept in a file."""
    if not contact.isValid():
        return False
    try:
        space = configuration(os.environ).namespace
        server = Server(contact.getHost(), contact.getPort(), namespace=space)
        write_server(conf_directory(os.environ), server)
    except (OSError, yarpy.YarpError) as error:
        say("ERROR", f"|yarp.os.Network| {error}")
        return False
    return True
