"""Messages of `Network` to a name server, and where it is: `writeToNameServer` and its like;
NameStore, a source of names of your own."""

from __future__ import annotations

import os
from typing import Any

import yarpy
from yarp import _names
from yarp._contact import Contact, ContactStyle
from yarp._log import say
from yarp._numbers import store
from yarpy.config.configuration import (
    Server,
    configuration,
    default_port,
    namespaces,
    write_namespaces,
    write_server,
)
from yarpy.network.asking import ask_server
from yarpy.platform.folders import conf_directory


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


def detect_name_server(
    useDetectedServer: bool = False, scanNeeded: Any = None, serverUsed: Any = None
) -> Contact:
    """Return where a name server is: the configured one if it answers, else one of the local
    network, looked for by multicast as `yarp detect` does; not valid if none answers.

    useDetectedServer: keep its address in a file. scanNeeded, serverUsed: BVectors, for whether the
    network was searched, and whether an address was kept.
    """
    from yarpy.names.discovery import search

    space = configuration(os.environ).namespace
    found, scanned, used = Contact(), False, False
    try:
        found = Contact._of(yarpy.query(space, names=_names.names()))
    except yarpy.YarpError:
        scanned = True
        try:
            contact = search(space, default_port(os.environ))
        except OSError:  # a computer without multicast
            contact = None
        if contact is not None:
            found = Contact(space, contact.carrier, contact.host, contact.port or -1)
            used = useDetectedServer and set_name_server_contact(found)
    for place, value in ((scanNeeded, scanned), (serverUsed, used)):
        if place is not None:
            store(place, [value])
    return found


class NameStore:
    """A source of names: a subclass defines `query`, and is used by `Network.queryBypass`."""

    def query(self, name: str) -> Contact:
        """Return where a port is, a Contact that is not valid if that is not known."""
        raise NotImplementedError(f"{type(self).__name__} has to define query")

    def announce(self, name: str, activity: int) -> bool:
        """Hear that a port was opened (1) or closed (-1); False: nobody wants to know."""
        return False

    def process(self, in_: Any, out: Any, source: Contact) -> bool:
        """Answer a message of a name server's words; False: it is not understood."""
        return False


def query_bypass(store: NameStore | None) -> None:
    """Look names up in a source of yours instead of the name server, where they are registered as
    before; None: no more. As in C++, it is not told what is opened."""
    _names.bypass(None if store is None else lambda name: _native_of(store.query(name)))


def _native_of(contact: Contact) -> yarpy.Contact | None:
    if not contact.isValid():
        return None
    return yarpy.Contact(
        contact.getRegName(), contact.getCarrier(), contact.getHost(), contact.getPort()
    )


def register_carrier(name: str, dll: str) -> bool:
    """Let connections use a carrier of yours. `dll` is where its class is: `package.module:Class`,
    as in the entry point yarpy.carriers, by which packages bring theirs."""
    from importlib import import_module

    from yarpy.carriers.base import Carrier
    from yarpy.registry import carriers

    module, _, attribute = dll.partition(":")
    try:
        found = getattr(import_module(module), attribute or name)
    except (ImportError, AttributeError, ValueError) as error:
        say("ERROR", f"|yarp.os.Network| no carrier {name} in {dll}: {error}")
        return False
    if not (isinstance(found, type) and issubclass(found, Carrier)):
        say("ERROR", f"|yarp.os.Network| {dll} is no carrier: see CONTRIBUTING.md of yarpy")
        return False
    carriers.add(name, found)
    return True
