"""`yarpy server`: run a name server.

    --ip HOST --socket N     the address to tell others; it listens on all of this computer's
    --portdb F --subdb F     files (SQLite) that remember registrations, and persistent connections
    --write                  replace the address that is stored in the address file
    --read                   use the stored address even if it is not one of this computer
    --web DIR                show the files of a directory to browsers, at /web/
    --zenoh [ROUTER]         tell names on Zenoh, and ask there for names: C++ programs take part
    --ros [URI]              tell a ROS master of topics and services, and ask it for names, that of
                             ROS_MASTER_URI; YARP_USE_ROS in the environment means the same

Where it listens: what the options say; else the address that is stored for the namespace (or that
YARPY_SERVER says), because that is where programs look; else an address of this computer and port
10000 (YARP_PORT_RANGE). The address is stored when none was, also over a file that holds no
address. When it differs from what is stored, the server does not start unless `--write` says that
this is meant.

Differs from C++: `--ip 127.0.0.1` and a stored loopback address are obeyed; the stored port number
is used when `--socket` does not say another; SIGINT and SIGTERM end it in good order, with 0.
Exit codes: 0 ended by a signal; 1 the address is in use, or in dispute, or a file is no database.
"""

from __future__ import annotations

import errno
import os
import threading
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

import yarpy
from yarpy.cli import log
from yarpy.cli.browser import url_of
from yarpy.cli.output import print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import warn
from yarpy.errors import AddressError
from yarpy.log import readable
from yarpy.platform import waiting
from yarpy.platform.refusal import reason
from yarpy.registry import delegates

if TYPE_CHECKING:
    from yarpy.config.configuration import Configuration, Server

HAPPY: Final = 600.0  # seconds between signs of life
PAUSE: Final = 0.02  # seconds between two times of printing
BACKLOG: Final = 10_000  # lines that may wait for a slow terminal before some are left out
SILENT: Final = 1000  # names that are remembered as reported not to answer
QUESTIONS: Final = 100  # different ones that are remembered of each
LONGEST: Final = 1000  # characters of what is remembered
MEMORY: Final = ":memory:"
ANY_NAME: Final = '"..."'  # as it is printed: the server chooses


# --- where to listen


@dataclass(frozen=True)
class Decision:
    """The address where to serve, and whether to store it."""

    server: Server
    store: bool
    note: str = ""


def decide(
    found: Configuration,
    *,
    ip: str = "",
    socket: int = 0,
    read: bool = False,
    write: bool = False,
    environment: Mapping[str, str] = os.environ,
) -> Decision:
    """Return where to serve, from the options and what is stored. Raises AddressError when they
    differ."""
    from yarpy.config.configuration import Server, default_port, server_file
    from yarpy.names.address import is_local, outward_address
    from yarpy.transports.bind import listening_host

    stored = next((server for server in found.servers if server.mode == "yarp"), None)
    path = server_file(found.directory, found.namespace)
    if stored is None and read:
        raise AddressError(f"Could not read configuration file {path}; without --read one is made")
    host, port, note = ip, socket, ""
    if stored is not None:
        port = port or stored.port
        if not host and (read or is_local(stored.host)):
            host = stored.host
    host = host or listening_host() or outward_address()
    wanted = Server(host, port or default_port(environment), "yarp", found.namespace)
    if not is_local(host):
        note = f"{host} is no address of this computer; others will look for the server there"
    if stored is None:
        return Decision(wanted, True, note)
    if (stored.host, stored.port) == (wanted.host, wanted.port):
        return Decision(wanted, False, note)
    if stored.path is None:
        says = f"YARPY_SERVER says {stored.host}:{stored.port}"
        says = f"{says}: programs started from here will look there"
        return Decision(wanted, False, f"{note}; {says}" if note else says)
    if write:
        return Decision(wanted, True, note)
    raise AddressError(
        f"need to change settings in {path}: it says {stored.host} {stored.port}, wanted is "
        f"{wanted.host} {wanted.port}; give --write to overwrite it, --read to use what it says, "
        f"or delete {path}"
    )


# --- what it says


class CommandPrinter:
    """Prints a line for each command, in a thread of its own: no client waits for a terminal.

    Questions about a port that is reported not to answer are printed once: the ports that were
    connected to it dial it again and again until it is back.
    """

    def __init__(self) -> None:
        self._silent: dict[str, set[str]] = {}  # name -> what was printed of it since
        self._lines: deque[str] = deque()
        self._skipped = 0
        self._registered = ""
        self._closed = False
        self._leaving = threading.Event()
        self._changed = threading.Condition()  # commands come from threads of connections
        self._thread = threading.Thread(target=self._run, name="yarpy server log", daemon=True)
        self._thread.start()

    def command(self, text: str, peer: str) -> None:
        """A client at `peer` sent this command."""
        with self._changed:
            if self._is_old(text):
                return
            if len(self._lines) >= BACKLOG:
                self._skipped += 1
                return
            # A log, which is also read in a terminal when it went to a file.
            self._lines.append(self._mark(text) + readable(text))
            self._changed.notify()

    def _is_old(self, text: str) -> bool:
        """Return whether this was printed already since the port that it is about was reported not
        to answer."""
        verb, name, rest = _parts(text)
        if verb == "register" or (verb == "announce" and rest != "0"):
            self._silent.pop(name, None)
        if verb not in ("announce", "query", "get") or len(text) > LONGEST:
            return False
        if verb == "announce" and rest == "0" and name not in self._silent:
            if len(self._silent) >= SILENT:
                self._silent.clear()
            self._silent[name] = set()
        printed = self._silent.get(name)
        if printed is None or text in printed:
            return printed is not None
        if len(printed) < QUESTIONS:
            printed.add(text)
        return False

    def _mark(self, text: str) -> str:
        """` * `, or deeper for what is set on the port that was just registered."""
        verb, name, _ = _parts(text)
        if verb == "register":
            self._registered = name
        elif verb == "set" and self._registered in (name, ANY_NAME):
            return "   + "
        return " * "

    def close(self) -> None:
        """Print what is left."""
        self._leaving.set()
        with self._changed:
            self._closed = True
            self._changed.notify()
        self._thread.join(1.0)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._lines or self._closed)
                lines, skipped = list(self._lines), self._skipped
                self._lines.clear()
                self._skipped = 0
                if not lines and self._closed:
                    return
            if skipped:
                lines.append(f"({skipped} commands not shown)")
            try:
                print_line("\n".join(lines))
            except (OSError, ValueError):
                return  # nobody reads any more; the server goes on
            self._leaving.wait(PAUSE)  # to be woken for each command costs as much as the command


def _parts(text: str) -> tuple[str, str, str]:
    """A command's verb, the name it is about, and what follows."""
    words = text.removeprefix("NAME_SERVER ").removeprefix("bot ").split(" ", 2)
    verb, name, rest = (*words, "", "")[:3]
    return verb, name, rest


@click.command()
@click.option(
    "--ip", default="", metavar="HOST", help="The address to tell others.",
    show_default="as stored, else one of this computer",
)  # fmt: skip
@click.option(
    "--socket", "--port", "socket", type=click.IntRange(0, 65535), default=0, metavar="N",
    help="The port number.", show_default="as stored, else 10000",
)  # fmt: skip
@click.option("--portdb", default=MEMORY, metavar="F", help="File that remembers registrations.")
@click.option("--subdb", default=MEMORY, metavar="F", help="File that remembers connections.")
@click.option("--cautious", is_flag=True, help="Answer changes once they are on the disk.")
@click.option("--write", is_flag=True, help="Replace the stored address.")
@click.option("--read", is_flag=True, help="Use the stored address as it is.")
@click.option(
    "--web",
    type=click.Path(exists=True, file_okay=False),
    metavar="DIR",
    help="Show the files of a directory at /web/.",
)
@click.option("--local", is_flag=True, help="Let nobody but this computer reach it.")
@click.option("--silent", is_flag=True, help="Print warnings and errors only.")
@click.option("--verbose", is_flag=True, help="Print all that is logged.")
def command(
    ip: str,
    socket: int,
    portdb: str,
    subdb: str,
    cautious: bool,
    write: bool,
    read: bool,
    web: str | None,
    local: bool,
    silent: bool,
    verbose: bool,
    **others: str | None,
) -> int:
    """Run a name server."""
    import logging

    from yarpy.config.configuration import configuration
    from yarpy.transports.bind import SETTING

    level = logging.WARNING if silent else logging.DEBUG if verbose else logging.INFO
    log.show(level)
    if local:
        os.environ[SETTING] = "local"
    found = configuration(os.environ, on_broken=None if read else _overwritten)
    decision = decide(found, ip=ip, socket=socket, read=read, write=write)
    if decision.note:
        warn(decision.note)
    say = _nothing if silent else print_line
    for system in others:
        if others[system] is None and os.environ.get(f"YARP_USE_{system.upper()}"):
            others[system] = ""  # as C++ has it
    beside = {system: where for system, where in others.items() if where is not None}
    try:
        _serve(found, decision, portdb, subdb, cautious, web, beside, say)
    except Interrupted:
        say("Name server ends.")
    return 0


def _serve(
    found: Configuration,
    decision: Decision,
    portdb: str,
    subdb: str,
    cautious: bool,
    web: str | None,
    beside: dict[str, str],
    say: object,
) -> None:
    """Serve until a signal comes."""
    from yarpy.config.configuration import write_server
    from yarpy.names.address import is_loopback
    from yarpy.transports.bind import listening_host

    assert callable(say)
    say(f"yarpy name server {yarpy.__version__}")
    say(f"Using port database: {portdb}")
    say(f"Using subscription database: {subdb}")
    if {portdb, subdb} != {MEMORY}:
        say("[If you ever need to clear the name server's state, just delete those files.]")
    server = decision.server
    try:
        service = yarpy.NameServer(
            server.port,
            server.host,
            name=server.namespace,
            portdb=None if portdb == MEMORY else Path(portdb),
            subdb=None if subdb == MEMORY else Path(subdb),
            cautious=cautious,
            discoverable=not is_loopback(listening_host()),
            web=web,
            beside=beside,
        )
    except AddressError as error:
        raise _explained(server, found, error) from error
    scribe = None
    try:
        say(f"IP address: {server.host}")
        say(f"Port number: {server.port}")
        if decision.store:
            try:
                say(f"Address stored in {write_server(found.directory, server)}")
            except OSError as error:
                warn(f"the address cannot be stored: {reason(error)}: {error.filename}")
        if say is not _nothing:
            scribe = CommandPrinter()
            service.on_command = scribe.command
        where = url_of(f"{server.host}:{server.port}")
        say(f"Name server can be browsed at {where}")
        for delegate in service.delegates:
            say(f"Using {delegate.about}")
        if web is not None:
            say(f"Files of {web} are shown at {where}web/")
        say("Ok. Ready!")
        while True:
            waiting.wait(HAPPY)
            say("Name server running happily")
    finally:
        service.close()
        if scribe is not None:
            scribe.close()


for _system in delegates.names():
    command.params.append(
        click.Option(
            [f"--{_system}"],
            is_flag=False,
            flag_value="",
            metavar="WHERE",
            help=f"Tell {_system} of what is registered here, and ask it for names.",
        )
    )


def _nothing(text: str) -> None:
    """Print nothing: `--silent`."""


def _overwritten(reason: str) -> None:
    """Say what becomes of an address file that holds none."""
    warn(f"{reason}: the address of this server goes there instead")


def _explained(server: Server, found: Configuration, error: AddressError) -> AddressError:
    """Return what to say of the program that has the port number, if one has."""
    another = "give this one another number with --socket"
    try:
        with yarpy.YarpNameClient("127.0.0.1", server.port, timeout=1.0) as client:
            known = client.query(server.namespace)
    except (yarpy.NoNameServer, OSError):
        known = None
    if known is None:
        if getattr(error.__cause__, "errno", 0) != errno.EADDRINUSE:
            return error
        return AddressError(
            f"cannot listen on TCP port {server.port}, where a program listens that says nothing "
            "of names: a name server that was stopped (`fg`, or kill -CONT, lets it go on) or that "
            f"hangs (end it), or another program; {another}"
        )
    host, number = known.host, known.port
    used = any((one.host, one.port) == (host, number) for one in found.servers)
    use = "programs use it" if used else f"`yarpy conf {host} {number}` lets programs use it"
    return AddressError(
        f"a name server for {known.name} is running here already, at {known.address}: {use}; for "
        f"another one end it, or {another}"
    )
