"""`yarpy connect SOURCE TARGET [CARRIER]`: connect two ports.

    connect SOURCE TARGET [CARRIER]              now; a connection that exists is made again
    connect --persist SOURCE TARGET [CARRIER]    now and whenever both are there, until
                                                 `yarpy disconnect --persist`
    connect --persist-from | --persist-to ...    the same, until SOURCE | TARGET is unregistered
    connect [--persist] [PORT]                   list persistent connections (of PORT)
    connect --file FILE                          the connections of a file, with their priorities
    connect --of NAME [SOURCE TARGET]            those of a running application (`yarpy up`)
    connect --list-carriers                      the protocols there are

A carrier may have modifiers (`fast_tcp+recv.priority`); `topic://t` stands for a topic.

Differs from C++: no log prefixes and no stray carriage return; an entry of the list is one line.
Exit codes: 0 connected; 1 not.
"""

from __future__ import annotations

from typing import Any

import click

import yarpy
from yarpy.cli.output import print_line


@click.command()
@click.argument("source", required=False)
@click.argument("target", required=False)
@click.argument("carrier", required=False)
@click.option("--persist", "mode", flag_value="always", help="Connect whenever both are there.")
@click.option("--persist-from", "mode", flag_value="from", help="... until SOURCE goes away.")
@click.option("--persist-to", "mode", flag_value="to", help="... until TARGET goes away.")
@click.option("--file", "path", type=click.Path(exists=True, dir_okay=False), metavar="FILE",
              help="Make the connections of FILE (see `yarpy help connect`).")  # fmt: skip
@click.option("--of", "application", metavar="NAME",
              help="Make the connections of a running application, or this one.")  # fmt: skip
@click.option("--list-carriers", is_flag=True, help="List the carriers that are installed.")
def command(
    source: str | None,
    target: str | None,
    carrier: str | None,
    mode: str | None,
    path: str | None,
    application: str | None,
    list_carriers: bool,
) -> int:
    """Have the port SOURCE send to the port TARGET over CARRIER (tcp)."""
    if path is not None:
        return _wire(path)
    if application is not None:
        return of_application("connect", application, source, target)
    if list_carriers:
        from yarpy.registry import carriers

        for name in carriers.offered():
            print_line(name)
        return 0
    if source is None or target is None:
        return _list(source or "", describe=mode is None)
    if mode is not None:
        return _persist(source, target, carrier or "", "" if mode == "always" else mode)

    existing = _existing(source, target, carrier)
    made = yarpy.connect(source, target, carrier or "")
    if existing:
        print_line(f"Connection found between {source} and {target} using carrier {existing}")
    print_line(f"Success: {made.reply}")
    return 0


def of_application(word: str, name: str, source: str | None, target: str | None) -> int:
    """Connect or disconnect what an application has. Raises UnknownPlugin without that kit."""
    from yarpy.registry import applications

    joining: click.Command = applications.load("join")
    ends = {"source": source or "", "target": target or ""}
    code: int = click.get_current_context().invoke(joining, word=word, name=name, **ends)
    return code


def _wire(path: str) -> int:
    """Make the connections of a file: one that fails does not keep the others from being made."""
    from pathlib import Path

    from yarpy.cli.stderr import complain
    from yarpy.cli.wiring import read
    from yarpy.route import masked

    failed = 0
    for wire in read(Path(path)):
        try:
            wire.make()
            print_line(f"Connected {wire.source} to {wire.target} using {masked(wire.carrier)}")
        except yarpy.YarpError as error:
            complain(str(error))
            failed = 1
    return failed


def _existing(source: str, target: str, carrier: str | None) -> str:
    """The carrier of the connection that is there already, "" if none is.

    Its carrier tells which of the two ends to ask: a camera that takes a single connection must not
    waste it on us.
    """
    from yarpy.network.pairing import Pairing

    try:
        with Pairing(source, target, carrier or "", None) as pairing:
            return "" if pairing.topical else pairing.existing()
    except yarpy.YarpError:
        return ""  # connecting will say it


def _persist(source: str, target: str, carrier: str, mode: str) -> int:
    from yarpy.network.asking import ask_server

    if carrier:
        from yarpy.contact import parse_contact
        from yarpy.link.begin.handshake import asked_carrier
        from yarpy.route import parse_carrier

        asked_carrier(parse_carrier(carrier))  # a wrong one shall not be stored
        target = f"{carrier}:/{parse_contact(target).name}"
    ask_server(None, ["subscribe", source, target, *([mode] if mode else [])])
    return 0


def _list(port: str, describe: bool) -> int:
    from yarpy.network.asking import ask_server

    if port and describe:
        from yarpy.cli.verbs.ping import as_shown

        for line in yarpy.ping(port):
            print_line(as_shown(line))
    entries = ask_server(None, ["subscribe", port] if port else ["subscribe"])[1:]
    for entry in entries:
        print_line(entry_line(entry))
    if not entries:
        print_line("No persistent connections.")
    return 0


def entry_line(entry: Any) -> str:
    """`Persistent connection /a -> udp://b [from]` for an entry of the name server's list."""
    mode = entry.find("mode", "")
    line = f"Persistent connection {entry.find('src', '')} -> {entry.find('dest', '')}"
    return f"{line} [{mode}]" if mode else line
