"""`yarpy name COMMAND ARGS...`: any command of the name server, as typed.

    list [PREFIX]   query NAME   register NAME [CARRIER [HOST [PORT]]]   unregister NAME
    set NAME KEY VALUE...   get NAME KEY   check NAME KEY VALUE   route A B   runners   gc   help
    bot ...   topic ...   subscribe ...   and whatever else a server understands

What other systems know is listed too: the nodes, topics and services of a ROS master that is
configured, those of ROS 2. Where there is no name server of YARP's, as with names on Zenoh, `list`,
`query` and `get` ask what there is instead.

Arguments are values of Bottle text. `register` takes any address, a camera's for example; the word
`...` leaves a part to the server.

Differs from C++: commands that are answered with a Bottle (`bot`, `topic`, `subscribe` ...) print
it instead of waiting for ever; no empty line behind a registration; `register` claims nothing more
about the port than its address; no command is `help`.
Exit codes: 0 answered; 1 `query` finds nothing, the server knows no such command, or no server.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import click

import yarpy
from yarpy.cli.output import print_all_json, print_json, print_line
from yarpy.cli.stderr import complain

if TYPE_CHECKING:
    from yarpy.names.base import NameClient

END = "*** end of message"
#: What all servers understand.
COMMANDS = (
    *("list", "query", "register", "unregister", "set", "get", "check", "route", "runners", "gc"),
    *("help", "bot", "topic", "subscribe"),
)
#: What is answered with nothing at all, or may be.
_SILENT = frozenset(
    {"list", "query", "set", "get", "check", "route", "runners", "gc", "unregister"}
)
_BOTTLES = frozenset({"bot", "announce", "subscribe", "unsubscribe", "topic", "untopic", "type"})


@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("words", nargs=-1, metavar="COMMAND [ARGS]...")
@click.option("--json", "as_json", is_flag=True, help="Print list, query, get ... as JSON.")
def command(words: tuple[str, ...], as_json: bool) -> int:
    """Send a command to the name server: `name list`, `name query /port`, `name help` ..."""
    from yarpy.cli.service import server, services
    from yarpy.config.command_line import parse_value
    from yarpy.names.base import Foreign
    from yarpy.network.asking import find

    verb, arguments = (words[0], words[1:]) if words else ("help", ())
    in_use = services()
    if isinstance(in_use[0], Foreign):
        return _answer_for(in_use[0], verb, arguments, as_json)
    client = server()
    if verb == "query" and len(arguments) == 1:
        _print_contact(client.query(arguments[0]) or find(arguments[0], client), as_json)
    elif verb == "list" and as_json:
        _print_list((item for one in in_use for item in one.list(*arguments[:1])), arguments)
    elif verb == "register" and arguments:
        _print_contact(client.register(*parse_address(arguments)), as_json)
    elif verb == "unregister" and len(arguments) == 1:
        client.unregister(arguments[0])
        print_line("Unregistered name.")
    elif verb in _BOTTLES:
        reply = client.request([verb, *map(parse_value, arguments)])
        print_json(reply) if as_json else print_line(reply.to_text())
    elif verb == "get" and as_json and len(arguments) == 2:
        print_json(client.get(*arguments))
    else:
        lines = client.command(verb, *map(parse_value, arguments))
        if not lines and verb not in _SILENT:
            complain(
                f'the name server does not know "{verb}"; `yarpy name help` lists its commands'
            )
            return 1
        if as_json:
            print_json(lines)
        else:
            others = _lines(in_use, arguments) if verb == "list" else []
            for line in (*lines, *others, END):
                print_line(line)
    return 0


def _answer_for(names: Any, verb: str, arguments: tuple[str, ...], as_json: bool) -> int:
    """Answer in the words of a name server where there is none, but `names` of another system."""
    from yarpy.network.asking import find

    if verb == "query" and len(arguments) == 1:
        _print_contact(find(arguments[0], names), as_json)
    elif verb == "list" and as_json:
        _print_list(names.list(*arguments[:1]), arguments)
    elif verb == "list":
        for line in (*_lines([names], arguments), END):
            print_line(line)
    elif verb == "get" and len(arguments) == 2:
        values = names.get(*arguments)
        if as_json:
            print_json(values)
        elif values:
            print_line(f"port {arguments[0]} property {arguments[1]} = {' '.join(values)}")
            print_line(END)
        else:
            print_line(END)
    else:
        complain(
            f'with {names.title} there is no server to ask for "{verb}", only for list, query and '
            f"get: {names.instead}"
        )
        return 1
    return 0


def _lines(services: Iterable[NameClient], arguments: tuple[str, ...]) -> list[str]:
    """Return what name services of other systems list, and what else there is in the network."""
    from yarpy.names.base import Foreign

    named = [
        one.line(item)
        for one in services
        if isinstance(one, Foreign)
        for item in one.list(*arguments[:1])
    ]
    return [*named, *(item["line"] for item in _listed(arguments))]


def _listed(arguments: tuple[str, ...]) -> list[dict[str, str]]:
    """Return what other systems list that have no names of their own for ports, each with the
    `line` that people see."""
    from yarpy.registry import listings

    found: list[dict[str, str]] = []
    for system in listings.names():
        try:
            found += listings.load(system)("".join(arguments[:1]))
        except yarpy.YarpError as error:
            complain(f"{system} is not listed: {error}")
    return found


def _print_list(contacts: Iterable[yarpy.Contact], arguments: tuple[str, ...]) -> None:
    """Print a list for programs: ports, and what there is in other systems."""
    print_all_json(map(as_dict, contacts))
    for item in _listed(arguments):
        place = yarpy.Contact(item["carrier"], item["name"])
        print_json({**as_dict(place), "kind": item["kind"], "type": item["type"]})


def parse_address(words: tuple[str, ...]) -> list[Any]:
    """`NAME [CARRIER [HOST [PORT]]]` as arguments of `register`; `...` is None."""
    if not words[0]:
        raise click.UsageError("the name is empty (an unset variable?): `...` is any free one")
    values: list[Any] = [None if word == "..." else word for word in words[1:4]]
    if len(values) == 3 and values[2] is not None:
        if not values[2].isdigit() or not 0 < int(values[2]) < 65536:
            raise click.UsageError(f'"{values[2]}" is no port number: give 1 to 65535, or ...')
        values[2] = int(values[2])
    return [words[0], *values]


def as_dict(contact: yarpy.Contact) -> dict[str, Any]:
    """A registration for JSON."""
    return {
        "name": contact.name,
        "host": contact.host,
        "port": contact.port,
        "carrier": contact.carrier,
    }


def _print_contact(contact: yarpy.Contact, as_json: bool) -> None:
    from yarpy.names.registration_line import registration_line

    print_json(as_dict(contact)) if as_json else print_line(registration_line(contact))
